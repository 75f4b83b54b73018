/* hand.js - what a person does with the page of `draw`, for tests: gestures by pointer events, and what the page says. */
'use strict';
const {Chromium} = require('./chromium.js');

function check(right, why) { if (!right) throw new Error(why); }

/* What a person does with the page. */
class Hand {
    constructor(page) { this.page = page; }
    text(name = 'model.txt') { return this.page.run(`app.texts.get('${name}')`); }
    last() { return this.text().then((t) => t.trim().split('\n').pop()); }
    refusal() { return this.page.run("document.getElementById('refusal').hidden ? '' : document.getElementById('refusal').textContent"); }
    model() { return this.page.run('app.model'); }
    async begin(text = '', edits = {}) {
        await this.page.run(`app.texts.set('model.txt', ${JSON.stringify(text)}); app.openFile('model.txt'); document.getElementById('snap').checked = false`);
        for (const [name, t] of Object.entries(edits)) await this.page.run(`app.texts.set('${name}', ${JSON.stringify(t)}); app.openFile('${name}')`);
    }

    /* Where a pixel of the photo is on the screen, once the page was laid out. */
    async screen([u, v]) {
        await this.page.run('new Promise((done) => setTimeout(done, 0))');
        return this.page.run(`(() => { const r = app.view.canvas.getBoundingClientRect(), q = app.view.toScreen(${u}, ${v}); return [r.left + q[0], r.top + q[1]]; })()`);
    }

    async press(id) {
        const at = await this.page.run(`(() => { const e = document.getElementById('${id}'); e.scrollIntoView({block: 'nearest'}); const r = e.getBoundingClientRect(); return [r.left + r.width / 2, r.top + r.height / 2]; })()`);
        await this.page.click(at);
    }

    photo(id) { return this.page.run(`app.openPhoto(app.photos.findIndex((p) => p.id === '${id}'))`); }
    async drag(tool, photo, [a, b]) {
        await this.press('tool-' + tool);
        await this.photo(photo);
        await this.page.drag(await this.screen(a), await this.screen(b));
    }

    /* Sets two pixels by keys: the drag of one who has no pointer. */
    async keys(tool, photo, list) {
        await this.press('tool-' + tool);
        await this.photo(photo);
        await this.page.run("document.getElementById('canvas').focus()");
        for (const p of list) {
            await this.page.run(`app.cursor = ${JSON.stringify(p)}`);
            await this.page.key('Enter');
        }
    }

    async clicks(tool, photo, list) {
        await this.press('tool-' + tool);
        await this.photo(photo);
        for (const p of list) await this.page.click(await this.screen(p));
    }

    /* A row of fields, by its button. */
    async form(label, values) {
        await this.page.run(`[...document.querySelectorAll('#forms button')].find((b) => b.textContent === '${label}').click()`);
        for (const [name, value] of Object.entries(values))
            await this.page.run(`document.querySelector('#forms form [name=${name}]').value = ${JSON.stringify(value)}`);
        await this.page.run("document.querySelector('#forms form button').click()");
    }
}

/* Runs tests by name, each with a Hand on the page in `folder`, and prints "ok NAME" or "not ok NAME: WHY". chosen: those
 * to run; none: all. FOLDER/profile gets the browser's files. */
async function runTests(tests, folder, chosen) {
    const browser = await Chromium.open(folder + '/profile');
    try {
        const page = await browser.page(`file://${folder}/index.html`), hand = new Hand(page);
        await page.until('app.ready', 60);
        await page.run('localStorage.clear()');
        for (const [name, test] of Object.entries(tests)) {
            if (chosen.length && !chosen.includes(name)) continue;
            try {
                await test(hand, browser);
                console.log(`ok ${name}`);
            } catch (e) {
                console.log(`not ok ${name}: ${e.message}`);
                await page.screenshot(`${folder}/${name}.png`);
            }
        }
        if (page.errors.length) console.log(`not ok the_console_has_no_error: ${page.errors.join('; ')}`);
        else console.log('ok the_console_has_no_error');
    } catch (e) {
        console.log(`not ok the_page_opens: ${e.message}`);
    } finally {
        await browser.close();
    }
}

module.exports = {Hand, check, runTests};
