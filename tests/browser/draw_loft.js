/* draw_loft.js FOLDER MODEL SCENE - draws the statements of loft's MODEL by pointer events on five of its photographs, in the
 * page in FOLDER; compares the text with MODEL, and walls and openings with the described SCENE. Prints "ok NAME" or
 * "not ok NAME: WHY". */
'use strict';
const fs = require('fs');
const {Chromium} = require('./chromium.js');
const {Hand, check} = require('./hand.js');
const [folder, script, scene] = process.argv.slice(2);

/* Words of the statements, one space apart, comments left out. */
const words = (text) => text.split('\n').map((l) => l.replace(/#.*/, '').trim().split(/\s+/)).filter((w) => w[0]);
const texts = (text) => words(text).map((w) => w.join(' '));

/* The page names new things itself; `names` maps those to the names of the script. */
async function draw(hand) {
    const names = new Map(), wanted = words(fs.readFileSync(script, 'utf8')).slice(1), photos = new Set(),
        now = (w) => w.map((x) => names.get(x) || x);
    await hand.begin();
    for (const w of wanted) {
        if (w[0] === 'set') await hand.form('Heights and thickness', {what: w[1], value: w[2]});
        else if (w[0] === 'join') await hand.form('Join walls', {walls: now(w.slice(1)).join(' ')});
        else if (w[0] === 'extend') await hand.form('Extend wall',
            {wall: now([w[1]])[0], end: w[2], to: now([w[4]])[0]});
        else if (w[0] === 'room') await hand.form('Room', {name: w[1], walls: now(w.slice(2)).join(' '), ceiling: ''});
        else {
            const at = w.indexOf('in'), [u0, v0, u1, v1] = w.slice(at + 2, at + 6).map(Number);
            photos.add(w[at + 1]);
            await hand.drag(w[0], w[at + 1], [[u0, v0], [u1, v1]]);
            const made = (await hand.last()).split(' ');
            names.set(w[1], made[1]);
            /* options are typed at the end of the line */
            if (w.length > at + 6) {
                const text = await hand.text();
                await hand.page.run(`document.getElementById('text').focus(); document.getElementById('text').setSelectionRange(${text.length - 1}, ${text.length - 1})`);
                await hand.page.send('Input.insertText', {text: ' ' + w.slice(at + 6).join(' ')});
            }
        }
        check(await hand.refusal() === '', `${w.join(' ')}: ${await hand.refusal()}`);
    }
    return {names, photos};
}

/* Where walls and openings are in a described scene, relative to each other: the model's frame has another origin. */
function truth() {
    const walls = {}, openings = {};
    for (const w of words(fs.readFileSync(scene, 'utf8'))) {
        const v = w.map(Number);
        if (w[0] === 'wall') walls[w[1]] = {from: [v[2], v[3]], to: [v[4], v[5]], thickness: v[8]};
        if (w[0] === 'opening') openings[w[1]] = {wall: w[2], s: [v[3], v[4]], z: [v[5], v[6]]};
    }
    return {walls, openings};
}

(async () => {
    const browser = await Chromium.open(folder + '/profile');
    let test = 'the_model_of_loft_is_drawn_from_nothing';
    try {
        const page = await browser.page(`file://${folder}/index.html`), hand = new Hand(page);
        await page.until('app.ready', 120);
        await page.run('localStorage.clear()');
        const {names, photos} = await draw(hand), back = new Map([...names].map(([a, b]) => [b, a]));
        check(photos.size === 5, `${photos.size} photos were drawn on, wanted 5`);
        const drawn = texts((await hand.text()).split('\n').map((l) =>
            l.split(' ').map((x) => back.get(x) || x).join(' ')).join('\n'));
        const byHand = texts(fs.readFileSync(script, 'utf8'));
        check(JSON.stringify(drawn) === JSON.stringify(byHand), `the script is\n${drawn.join('\n')}`);
        console.log(`ok ${test}`);

        test = 'walls_are_within_1_cm_and_openings_within_2_cm';
        const model = await hand.model(), t = truth(), wall = (name) =>
            model.walls.find((w) => w.name === names.get(name));
        /* inner faces of the truth: the walls' lines less half their thickness */
        const inside = (a, b) => Math.abs(a) - (t.walls[b[0]].thickness + t.walls[b[1]].thickness) / 2;
        const across = {south_north: [inside(4.2, ['south', 'north']), ['south', 'north']],
            west_east: [inside(8.8, ['west', 'east']), ['west', 'east']],
            west_partition: [inside(5.4, ['west', 'partition']), ['west', 'partition']]};
        let worst = 0, worstOpening = 0;
        for (const [, [wanted, [a, b]]] of Object.entries(across)) {
            const found = Math.abs(wall(a).at + wall(b).at);
            worst = Math.max(worst, Math.abs(found - wanted));
        }
        for (const [name, o] of Object.entries(t.openings)) {
            const found = model.openings.find((m) => m.name === names.get(name));
            const off = [found.s[1] - found.s[0] - (o.s[1] - o.s[0]), found.z[1] - o.z[1],
                found.z[0] - o.z[0]].map(Math.abs);
            worstOpening = Math.max(worstOpening, ...off);
        }
        console.log(`# walls: at most ${(100 * worst).toFixed(2)} cm off; openings: ${(100 * worstOpening).toFixed(2)} cm`);
        check(worst < 0.01, `a distance between walls is off by ${worst} m`);
        check(worstOpening < 0.02, `an opening is off by ${worstOpening} m`);
        console.log(`ok ${test}`);

        test = 'the_console_has_no_error';
        check(page.errors.length === 0, page.errors.join('; '));
        console.log(`ok ${test}`);
    } catch (e) {
        console.log(`not ok ${test}: ${e.message}`);
    } finally {
        await browser.close();
    }
})();
