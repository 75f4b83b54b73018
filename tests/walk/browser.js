// browser.js - drives Chromium without a window over its DevTools protocol, through a pipe: no port, no package.
//
//   const browser = await require('./browser.js').open(url, {width, height});
//   await browser.evaluate('1 + 1');  browser.errors;  await browser.screenshot('a.png');  await browser.close();
'use strict';
const {spawn, execFileSync} = require('child_process');
const fs = require('fs');
const os = require('os');
const path = require('path');

const find = () => {
    for (const name of [process.env.CHROMIUM, 'chromium', 'chromium-browser', 'google-chrome']) {
        if (!name) continue;
        try {
            return execFileSync('sh', ['-c', `command -v "${name}"`]).toString().trim();
        } catch (e) { /* the next one */
        }
    }
    return null;
};

const open = async (url, {width = 1280, height = 720, mobile = false} = {}) => {
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'walk-browser-'));
    const child = spawn(
        find(),
        [
            '--headless', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
            '--disable-dev-shm-usage', '--no-first-run', '--disable-extensions', '--hide-scrollbars',
            '--remote-debugging-pipe', `--user-data-dir=${folder}`, `--window-size=${width},${height}`, 'about:blank'
        ],
        {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'], detached: true});
    const waiting = new Map(), errors = [];
    let number = 0, rest = '', session, loaded;
    const isLoaded = new Promise((take) => {
        loaded = take;
    });
    child.stdio[4].on('data', (data) => {
        rest += data;
        for (let end; (end = rest.indexOf('\0')) >= 0; rest = rest.slice(end + 1)) {
            const m = JSON.parse(rest.slice(0, end));
            if (m.id) {
                const w = waiting.get(m.id);
                waiting.delete(m.id);
                if (m.error)
                    w.fail(new Error(`${w.method}: ${m.error.message}`));
                else
                    w.take(m.result);
            } else if (m.method === 'Page.loadEventFired')
                loaded();
            else if (m.method === 'Runtime.exceptionThrown')
                errors.push(m.params.exceptionDetails.exception?.description || m.params.exceptionDetails.text);
            else if (m.method === 'Runtime.consoleAPICalled' && m.params.type === 'error')
                errors.push(m.params.args.map((a) => a.value || a.description).join(' '));
            else if (m.method === 'Log.entryAdded' && m.params.entry.level === 'error')
                errors.push(`${m.params.entry.text} ${m.params.entry.url || ''}`);
        }
    });
    const send = (method, params = {}) => new Promise((take, fail) => {
        waiting.set(++number, {take, fail, method});
        child.stdio[3].write(`${JSON.stringify({id: number, method, params, sessionId: session})}\0`);
    });
    const close = async () => {
        const ended = new Promise((take) => child.on('exit', take));
        try {
            session = undefined;
            await Promise.race([send('Browser.close'), new Promise((take) => setTimeout(take, 2000))]);
            await Promise.race([ended, new Promise((take) => setTimeout(take, 3000))]);
            if (child.exitCode === null) process.kill(-child.pid, 'SIGKILL');
        } catch (e) { /* it ended before */
        }
        fs.rmSync(folder, {recursive: true, force: true});
    };
    const {targetId} = await send('Target.createTarget', {url: 'about:blank'});
    session = (await send('Target.attachToTarget', {targetId, flatten: true})).sessionId;
    await send('Runtime.enable');
    await send('Log.enable');
    await send('Page.enable');
    await send('Emulation.setDeviceMetricsOverride', {width, height, deviceScaleFactor: 1, mobile});
    if (mobile) await send('Emulation.setTouchEmulationEnabled', {enabled: true});
    const begin = Date.now();
    await send('Page.navigate', {url});
    await isLoaded;
    const evaluate = async (expression) => {
        const r = await send('Runtime.evaluate', {expression, awaitPromise: true, returnByValue: true});
        if (r.exceptionDetails) throw new Error(r.exceptionDetails.exception?.description || r.exceptionDetails.text);
        return r.result.value;
    };
    const screenshot = async (file) =>
        fs.writeFileSync(file, Buffer.from((await send('Page.captureScreenshot', {format: 'png'})).data, 'base64'));
    const key = async (name, code) => {
        await send('Input.dispatchKeyEvent', {type: 'keyDown', key: name, code: code || name});
        await send('Input.dispatchKeyEvent', {type: 'keyUp', key: name, code: code || name});
    };
    const mouse = (type, x, y, buttons = 0) => send(
        'Input.dispatchMouseEvent',
        {type, x, y, button: type === 'mouseMoved' ? 'none' : 'left', buttons, clickCount: 1});
    const click = async (x, y) => {
        await mouse('mousePressed', x, y, 1);
        await mouse('mouseReleased', x, y);
    };
    // CPU seconds of all its processes until now
    const cpu = () => {
        let ticks = 0;
        for (const pid of fs.readdirSync('/proc')) {
            if (!/^\d+$/.test(pid)) continue;
            try {
                const w = fs.readFileSync(`/proc/${pid}/stat`, 'utf8').replace(/^.*\) /, '').split(' ');
                if (+w[2] === child.pid) ticks += +w[11] + +w[12];
            } catch (e) { /* it ended */
            }
        }
        return ticks / 100;
    };
    return {cpu, send, evaluate, screenshot, key, mouse, click, close, errors, begin};
};
module.exports = {
    open,
    find
};
