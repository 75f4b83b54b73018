// node walk_page.js FOLDER [--at EDIT PICTURES DB] [--between EDIT CAMERAS PICTURES DB] [--moved EDIT DX PICTURES DB] -
// opens a walk in Chromium.
//
// Alone: the page starts, keys and clicks do what they say. --at: what the walk shows in viewpoints after an edit is
// what render_model draws there, PICTURES/VIEW.jpg. --between: the same of given cameras, a COLMAP text model in the
// model's frame, and PICTURES/NAME.jpg; EDIT "": the unedited rooms. DB: the least PSNR. The console stays empty in
// each case. --moved: the same of the views' cameras, moved to the left by DX model units.
'use strict';
const fs = require('fs');
const os = require('os');
const path = require('path');
const {Chromium} = require('./chromium.js');
const folder = process.argv[2];
const words = (option, count) => {
    const at = process.argv.indexOf(option);
    return at < 0 ? null : process.argv.slice(at + 1, at + 1 + count);
};
const at = words('--at', 3), between = words('--between', 4), moved = words('--moved', 4);
let failed = 0;
const check = (name, fine, why) => {
    console.log(`${fine ? 'ok' : 'not ok'} ${name}${fine ? '' : `: ${why}`}`);
    failed += !fine;
};

const readCameras = (cameras) => {
    const lenses = {}, list = [];
    for (const line of fs.readFileSync(path.join(cameras, 'cameras.txt'), 'utf8').split('\n')) {
        const w = line.split(' ');
        if (w[1] === 'PINHOLE') lenses[w[0]] = {width: +w[2], height: +w[3], lens: w.slice(4, 8).map(Number)};
    }
    for (const line of fs.readFileSync(path.join(cameras, 'images.txt'), 'utf8').split('\n')) {
        const w = line.split(' ');
        if (line[0] === '#' || w.length < 10) continue;
        const [a, x, y, z] = w.slice(1, 5).map(Number), t = w.slice(5, 8).map(Number);
        const turn = [
            1 - 2 * (y * y + z * z), 2 * (x * y - a * z), 2 * (x * z + a * y), 2 * (x * y + a * z),
            1 - 2 * (x * x + z * z), 2 * (y * z - a * x), 2 * (x * z - a * y), 2 * (y * z + a * x),
            1 - 2 * (x * x + y * y)
        ];
        const centre = [0, 1, 2].map((k) => -(turn[k] * t[0] + turn[3 + k] * t[1] + turn[6 + k] * t[2]));
        list.push({name: w[9].replace(/\.[a-z]+$/, ''), camera: {...lenses[w[8]], turn, centre}});
    }
    return list;
};

// The mean squared difference of two pictures, computed in the page, which has the decoders. sources: what the second
// one's pixels come from; where that is nothing they do not count.
const compare = (browser, url, file, sources) => {
    const text = (f) => JSON.stringify(f && fs.existsSync(f) ? `,${fs.readFileSync(f).toString('base64')}` : '');
    return browser.run(`(async () => {
        const pixels = async (url) => {
            const b = await createImageBitmap(new Blob([Uint8Array.from(atob(url.split(',')[1]), (c) => c.charCodeAt(0))]));
            const c = new OffscreenCanvas(b.width, b.height).getContext('2d');
            c.drawImage(b, 0, 0);
            return c.getImageData(0, 0, b.width, b.height).data;
        };
        const a = await pixels(${JSON.stringify(url)}), b = await pixels(${text(file)}), made = ${
        text(sources)} && await pixels(${text(sources)});
        if (a.length !== b.length) return -1;
        let sum = 0, count = 0;
        for (let i = 0; i < a.length; i += 4) {
            if (made && made[i] + made[i + 1] + made[i + 2] === 0) continue;
            count += 3;
            for (let c = i; c < i + 3; c++) sum += (a[c] - b[c]) ** 2;
        }
        return sum / count;
    })()`);
};

const main = async () => {
    const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'walk-browser-'));
    const chromium = await Chromium.open(profile);
    const browser = await chromium.page(`file://${path.resolve(folder)}/index.html`, 1280, 720);
    try {
        const first = await browser.run('walk.ready()');
        console.log(`# first picture after ${Math.round(first)} ms`);
        const size = fs.readdirSync(folder).reduce((s, f) => s + fs.statSync(path.join(folder, f)).size, 0);
        console.log(`# ${(size / 1e6).toFixed(1)} MB on disk`);
        check('the_walk_is_smaller_than_40_MB', size < 40e6, `${size} bytes`);
        // the share of a picture's pixels that show something
        const filled = (spec) => browser.run(`(async () => {
            const r = await walk.picture(${spec}), p = await createImageBitmap(await (await fetch(r.url)).blob());
            const c = new OffscreenCanvas(p.width, p.height).getContext('2d');
            c.drawImage(p, 0, 0);
            const d = c.getImageData(0, 0, p.width, p.height).data;
            let n = 0;
            for (let i = 0; i < d.length; i += 4) n += d[i] + d[i + 1] + d[i + 2] > 30;
            return n / (p.width * p.height);
        })()`);
        const lit = await filled('{camera: walk.scene().views[0]}');
        check('a_viewpoint_is_filled', lit > 0.95, `${(100 * lit).toFixed(1)} % of its pixels show something`);
        // relit pictures of a photo that fills a part of its views leave the rest to the rooms
        const relit = fs.readdirSync(folder).map((f) => f.match(/^light-(.*)-([^-]*)\.js$/)).find((m) => m);
        if (relit) {
            const names = await browser.run('walk.scene().views.map((v) => v.name)');
            for (const [k, name] of names.entries()) {
                if (!name.startsWith(`${relit[2]}@`)) continue;
                const part = await filled(`{camera: walk.scene().views[${k}], edit: '${relit[1]}', light: true}`);
                check(`${name}_is_filled_in_new_light`, part > 0.95, `${(100 * part).toFixed(1)} % of its pixels`);
            }
        }
        const look = async (name, spec, file, least) => {
            const picture = await browser.run(`walk.picture(${JSON.stringify(spec)})`);
            const e = await compare(browser, picture.url, file, file.replace(/\.jpg$/, '-sources.png')),
                  dB = 10 * Math.log10(255 ** 2 / e);
            console.log(`# ${name}: ${dB.toFixed(1)} dB; ${picture.counts.calls} draw calls, ${
                (picture.bytes / 1e6).toFixed(1)} MB of textures`);
            check(`${name}_is_what_render_model_draws`, e >= 0 && dB >= +least, `${dB.toFixed(1)} dB, wanted ${least}`);
        };
        if (at) {
            const views = await browser.run('walk.scene().views'), [edit, pictures, least] = at;
            for (const v of views) {
                const file = path.join(pictures, `${v.name}.jpg`);
                if (fs.existsSync(file)) await look(v.name, {camera: v, edit}, file, least);
            }
        }
        if (between) {
            const [edit, cameras, pictures, least] = between;  // given cameras are drawn without the photo itself
            for (const {name, camera} of readCameras(cameras))
                await look(name, {camera, edit: edit || 0, photos: false}, path.join(pictures, `${name}.jpg`), least);
        }
        if (moved) {
            const [edit, dx, pictures, least] = moved;
            for (const v of await browser.run('walk.scene().views')) {
                const camera = {...v, centre: v.centre.map((c, k) => c - dx * v.turn[k])};
                const file = path.join(pictures, `${v.name}.jpg`);
                await look(v.name, {camera, edit: edit || 0, photos: false}, file, least);
            }
        }
        if (!at && !between && !moved) {
            const state = (key) =>
                browser.run(`JSON.stringify(walk.state.${key})`).then((t) => t && JSON.parse(t));
            const wait = (ms) => new Promise((take) => setTimeout(take, ms));
            await browser.run('document.getElementById("rooms").focus()');
            const was = await state('eye');
            await browser.send('Input.dispatchKeyEvent', {type: 'keyDown', key: 'ArrowLeft', code: 'ArrowLeft'});
            await wait(700);
            await browser.send('Input.dispatchKeyEvent', {type: 'keyUp', key: 'ArrowLeft', code: 'ArrowLeft'});
            check('the_left_arrow_turns_left', (await state('eye')).heading > was.heading, 'the heading is the same');
            await browser.mouse('mousePressed', [600, 400]);
            await browser.mouse('mouseMoved', [700, 420], {down: true});
            await browser.mouse('mouseReleased', [700, 420]);
            await wait(100);
            check(
                'dragging_to_the_right_turns_left', (await state('eye')).heading > was.heading,
                'the heading is the same');
            const count = await browser.run('walk.scene().models.length');
            const last = Math.min(9, count - 1);
            await browser.key(`${last}`);
            check('a_digit_chooses_an_edit', (await state('edit')) === last, await state('edit'));
            await browser.key('b');
            check('b_compares', await state('compare'), 'no comparison');
            const split = await state('split');
            await browser.key(']');
            check('a_bracket_moves_the_border', (await state('split')) > split, await state('split'));
            await browser.key('Escape');
            await browser.key('c');
            check(
                'c_shows_the_origin_with_its_legend',
                await browser.run(
                    '!document.getElementById("legend").hidden && /another photograph/.test(document.getElementById("legend").textContent)'),
                'no legend');
            check(
                'colours_of_origin_have_patterns_of_their_own',
                await browser.run(`(() => {
                    const all = [...document.querySelectorAll('#legend i')].map((i) => getComputedStyle(i).backgroundImage);
                    return all.length > 3 && new Set(all).size === all.length; })()`),
                'two look alike without their colours');
            // the contrast of text with what is behind it, as WCAG 2.1, 1.4.3 defines it
            const contrast = await browser.run(`(() => {
                const rgb = (c) => c.match(/[0-9.]+/g).map(Number);
                const light = (c) => c.slice(0, 3).map((x) => x / 255).map((x) => x <= 0.04045 ? x / 12.92 :
                    ((x + 0.055) / 1.055) ** 2.4).reduce((s, x, k) => s + x * [0.2126, 0.7152, 0.0722][k], 0);
                const behind = (e) => { for (; e; e = e.parentElement) { const c = rgb(getComputedStyle(e).backgroundColor);
                    if (c.length < 4 || c[3] > 0.5) return c; } return [0, 0, 0]; };
                let least = 99, which = '';
                for (const e of document.querySelectorAll('button, select, h1, label, #told, #legend div, .tag')) {
                    if (e.getAttribute('aria-disabled') === 'true') continue;
                    const [a, b] = [light(rgb(getComputedStyle(e).color)), light(behind(e))].sort((x, y) => y - x);
                    const c = (a + 0.05) / (b + 0.05);
                    if (c < least) [least, which] = [c, e.id || e.textContent];
                }
                return [least, which]; })()`);
            check('text_has_a_contrast_of_4_5_at_least', contrast[0] >= 4.5, contrast.join(' '));
            await browser.key('c');
            await browser.key('m');
            await browser.key('Enter');
            check(
                'enter_measures_a_surface',
                /(m²|square units)/.test(await browser.run('document.getElementById("told").textContent')),
                await browser.run('document.getElementById("told").textContent'));
            await browser.key('m');
            await browser.key('o');
            check('o_looks_from_above', await state('above'), 'not from above');
            await browser.key('o');
            const before = (await state('eye')).centre;
            await browser.key('n');
            await wait(200);
            await browser.run('walk.ready()');
            check(
                'n_goes_to_a_photograph', (await state('move')) || (await state('eye')).centre.join() !== before.join(),
                'nothing moves');
            // fingers, as they come from a screen that is touched
            const fingers = (type, points) => browser.send('Input.dispatchTouchEvent', {
                type,
                touchPoints: points.map(([x, y], id) => ({x, y, id}))
            });
            const drag = async (from, by, steps = 10) => {
                await fingers('touchStart', from);
                for (let k = 1; k <= steps; k++)
                    await fingers('touchMove', from.map((p, i) => p.map((x, c) => x + (by[i][c] * k) / steps)));
                await fingers('touchEnd', []);
                await wait(50);
            };
            const close = (a, b, e) => Math.abs(a - b) < e;
            const begin = (centre, heading) => browser.run(`{ const s = walk.state; s.move = s.tour = s.above = null; s.field = 1.31;
                s.eye = {centre: ${JSON.stringify(centre)}, heading: ${heading}, up: 0}; }`);
            const place = await browser.run('walk.scene().places[0].centre');
            await begin(place, 0.5);
            await drag([[600, 300]], [[100, 0]]);
            let eye = await state('eye');
            check(
                'one_finger_turns_by_what_it_moves',
                close(eye.heading, 0.5 + (1.31 * 100) / 1280, 1e-6) && eye.centre.join() === place.join(),
                JSON.stringify(eye));
            await begin(place, 0.5);
            await drag([[500, 300], [700, 300]], [[-100, 0], [100, 0]]);
            eye = await state('eye');
            check(
                'two_fingers_spread_to_twice_their_distance_halve_the_field',
                close(await state('field'), 1.31 / 2, 1e-6) && close(eye.heading, 0.5, 1e-9), await state('field'));
            const free = await browser.run(`(() => { for (let h = 0; h < 6.28; h += 0.2) {
                const to = ${JSON.stringify(place)}.map((x, k) => x + [Math.cos(h), Math.sin(h), 0][k] * 0.11 * walk.state.size);
                if (!W.hit(walk.scene().models[walk.state.edit], ${JSON.stringify(place)}, [Math.cos(h), Math.sin(h), 0], 0.2 * walk.state.size)) return h; }
                return 0; })()`);
            const size = await state('size');
            await begin(place, free);
            await drag([[500, 400], [700, 400]], [[0, -100], [0, -100]]);
            eye = await state('eye');
            const gone = [0, 1].map((k) => eye.centre[k] - place[k]);
            check(
                'two_fingers_moved_up_by_100_px_walk_a_tenth_of_the_rooms',
                close(gone[0], 0.1 * size * Math.cos(free), 1e-3 * size) &&
                    close(gone[1], 0.1 * size * Math.sin(free), 1e-3 * size),
                `${gone} of ${size}, heading ${free}`);
            check('two_fingers_moved_together_do_not_zoom', close(await state('field'), 1.31, 1e-6), await state('field'));
            await begin(place, 0.5);
            await fingers('touchStart', [[600, 420]]);
            await fingers('touchEnd', []);
            await wait(50);
            check('a_short_touch_goes_there', await state('move'), 'nothing moves');
            await fingers('touchStart', [[500, 300], [700, 300]]);
            await browser.run('{ walk.state.move = null; }');
            await fingers('touchEnd', []);
            await wait(50);
            check('a_touch_of_two_fingers_goes_nowhere', !(await state('move')), 'it moves');
            await browser.key('o');
            const away = (await state('above')).away;
            await drag([[500, 300], [700, 300]], [[50, 0], [-50, 0]]);
            check(
                'from_above_two_fingers_closed_to_half_go_twice_as_far',
                close((await state('above')).away, Math.min(3 * size, 2 * away), 1e-6), (await state('above')).away);
            await browser.key('o');
            const names = await browser.run(
                '[...document.querySelectorAll("button")].every((b) => b.textContent.trim() || b.getAttribute("aria-label"))');
            check('every_button_has_a_name', names, 'a button has none');
        }
        check('the_console_is_empty', !browser.errors.length, browser.errors.join(' | '));
        if (process.env.WALK_SPEED) {
            await browser.run('walk.speed(12, 1280, 720)');
            const begin = chromium.cpu(), r = await browser.run('walk.speed(24, 1280, 720)'),
                  cpu = (chromium.cpu() - begin) / 48;
            const area = 1280 * 720;
            console.log(`# 1280 x 720 without a GPU: ${r.fps.toFixed(1)} frames a second as measured, ${
                cpu.toFixed(3)} core-seconds a frame, so ${(2 / cpu).toFixed(1)} a second on 2 free cores`);
            console.log(`# a frame: ${r.calls.toFixed(0)} draw calls, ${r.triangles.toFixed(0)} triangles, ${
                (r.bytes / 1e6).toFixed(1)} MB of textures, about ${(9 * area / 1e6).toFixed(0)} million texels and ${
                (area * 8 * 10 / 1e6).toFixed(0)} MB of pixels read and written`);
        }
    } finally {
        await chromium.close(profile);
    }
    process.exit(failed ? 1 : 0);
};
main().catch((e) => {
    console.log(`not ok the_page: ${e.message}`);
    process.exit(1);
});
