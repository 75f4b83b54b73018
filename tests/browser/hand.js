/* hand.js - what a person does with the page of `draw`, for tests: gestures by pointer events, and what the page says. */
'use strict';

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

    screen([u, v]) {
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

module.exports = {Hand, check};
