/* chromium.js - a headless Chromium for tests of pages, driven over pipes by the DevTools protocol; no package is needed.
 * WebGL is drawn by software.
 *
 *   const browser = await Chromium.open(folder);     its profile goes into that folder
 *   const page = await browser.page('file:///.../index.html');
 *   await page.run('1 + 1');  await page.drag([10, 10], [50, 60]);  await page.close();  await browser.close(); */
'use strict';
const {spawn, spawnSync} = require('child_process');
const fs = require('fs');

class Chromium {
    static find() {
        for (const name of ['chromium', 'chromium-browser', 'google-chrome'])
            if (!spawnSync('sh', ['-c', `command -v ${name}`]).status) return name;
        return null;
    }

    static async open(profile) {
        const b = new Chromium();
        b.waiting = new Map();
        b.events = [];
        b.next = 1;
        b.process = spawn(Chromium.find(), ['--headless', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader',
            '--enable-unsafe-swiftshader', '--disable-dev-shm-usage', '--no-first-run',
            '--remote-debugging-pipe', `--user-data-dir=${profile}`, '--window-size=1400,900', 'about:blank'],
        {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'], detached: true});
        let rest = '';
        b.process.stdio[4].on('data', (data) => {
            const parts = (rest + data).split('\0');
            rest = parts.pop();
            for (const part of parts) b.receive(JSON.parse(part));
        });
        return b;
    }

    receive(message) {
        if (!message.id) return this.events.forEach((e) => e(message));
        const {done, failed} = this.waiting.get(message.id);
        this.waiting.delete(message.id);
        if (message.error) failed(new Error(message.error.message));
        else done(message.result);
    }

    send(method, params = {}, sessionId = undefined) {
        const id = this.next++;
        this.process.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + '\0');
        return new Promise((done, failed) => this.waiting.set(id, {done, failed}));
    }

    async page(url, width = 1400, height = 900) {
        const {targetId} = await this.send('Target.createTarget', {url: 'about:blank'});
        const {sessionId} = await this.send('Target.attachToTarget', {targetId, flatten: true});
        const page = new Page(this, sessionId, targetId);
        await page.begin(url, width, height);
        return page;
    }

    /* CPU seconds of all its processes until now. */
    cpu() {
        let ticks = 0;
        for (const pid of fs.readdirSync('/proc')) {
            if (!/^\d+$/.test(pid)) continue;
            try {
                const w = fs.readFileSync(`/proc/${pid}/stat`, 'utf8').replace(/^.*\) /, '').split(' ');
                if (+w[2] === this.process.pid) ticks += +w[11] + +w[12];
            } catch (e) { /* it ended */ }
        }
        return ticks / 100;
    }

    /* All its processes write to the profile until they have ended; only then it can be removed. */
    async close(profile = null) {
        const ended = new Promise((done) => this.process.on('exit', done));
        this.process.stdio[3].on('error', () => {});
        this.send('Browser.close').catch(() => {});
        await Promise.race([ended, new Promise((done) => setTimeout(done, 5000))]);
        try {
            process.kill(-this.process.pid, 'SIGKILL');
        } catch (e) { /* none is left */ }
        if (profile) fs.rmSync(profile, {recursive: true, force: true, maxRetries: 20, retryDelay: 100});
    }
}

class Page {
    constructor(browser, session, target) {
        Object.assign(this, {browser, session, target, errors: [], dialogs: 0});
        browser.events.push((m) => {
            if (m.sessionId !== session) return;
            if (m.method === 'Runtime.exceptionThrown') this.errors.push(m.params.exceptionDetails.exception
                ? m.params.exceptionDetails.exception.description : m.params.exceptionDetails.text);
            if (m.method === 'Runtime.consoleAPICalled' &&
                m.params.type === 'error') this.errors.push(m.params.args.map((a) => a.value).join(' '));
            if (m.method === 'Log.entryAdded' &&
                m.params.entry.level === 'error') this.errors.push(m.params.entry.text);
            if (m.method === 'Page.javascriptDialogOpening') {
                this.dialogs++;
                this.send('Page.handleJavaScriptDialog', {accept: true});
            }
        });
    }

    send(method, params) { return this.browser.send(method, params, this.session); }

    async begin(url, width, height) {
        for (const domain of ['Page', 'Runtime', 'Log']) await this.send(domain + '.enable');
        await this.send('Emulation.setDeviceMetricsOverride', {width, height, deviceScaleFactor: 1, mobile: false});
        await this.send('Page.navigate', {url});
        await this.until("document.readyState === 'complete'", 60);
    }

    async run(expression) {
        const {result, exceptionDetails} = await this.send('Runtime.evaluate',
            {expression, returnByValue: true, awaitPromise: true});
        if (exceptionDetails) throw new Error((exceptionDetails.exception &&
            exceptionDetails.exception.description) || exceptionDetails.text);
        return result.value;
    }

    /* Waits until an expression is true, at most `seconds`. */
    async until(expression, seconds = 30) {
        const end = Date.now() + 1000 * seconds;
        for (;;) {
            try {
                if (await this.run(`!!(${expression})`)) return;
            } catch (e) { /* the page is being loaded */ }
            if (Date.now() > end) throw new Error(`after ${seconds} s not true: ${expression}`);
            await new Promise((done) => setTimeout(done, 50));
        }
    }

    mouse(type, [x, y], more = {}) {
        return this.send('Input.dispatchMouseEvent', {type, x, y, button: 'left', buttons: type === 'mouseMoved' &&
            !more.down ? 0 : 1,
            clickCount: 1, pointerType: 'mouse', modifiers: more.modifiers || 0});
    }

    async click(at, modifiers = 0) {
        await this.mouse('mouseMoved', at);
        await this.mouse('mousePressed', at, {modifiers});
        await this.mouse('mouseReleased', at, {modifiers});
    }

    async drag(from, to) {
        await this.mouse('mouseMoved', from);
        await this.mouse('mousePressed', from);
        await this.mouse('mouseMoved', [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2], {down: true});
        await this.mouse('mouseMoved', to, {down: true});
        await this.mouse('mouseReleased', to);
    }

    /* key: as KeyboardEvent.key has it; modifiers: 1 Alt, 2 Ctrl, 8 Shift */
    async key(key, modifiers = 0) {
        const text = key.length === 1 && !(modifiers & 3) ? key : key === 'Enter' ? '\r' : undefined;
        const code = {Enter: 13, Escape: 27, ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40,
            Tab: 9}[key] || key.toUpperCase().charCodeAt(0);
        await this.send('Input.dispatchKeyEvent', {type: text ? 'keyDown' : 'rawKeyDown', key, text, modifiers,
            windowsVirtualKeyCode: code});
        await this.send('Input.dispatchKeyEvent', {type: 'keyUp', key, modifiers, windowsVirtualKeyCode: code});
    }

    async screenshot(path) {
        const {data} = await this.send('Page.captureScreenshot', {format: 'png'});
        fs.writeFileSync(path, Buffer.from(data, 'base64'));
    }

    close() { return this.browser.send('Target.closeTarget', {targetId: this.target}); }
}

module.exports = {Chromium};
