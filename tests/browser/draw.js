/* draw.js FOLDER [TEST...] - tests of the page that `draw` wrote for the room of room.js, by pointer events and keys; prints "ok NAME"
 * or "not ok NAME: WHY" for each. FOLDER/profile gets the browser's files. */
'use strict';
const {check, runTests} = require('./hand.js');
const {project} = require('./room.js');
const n = (v) => String(+v.toFixed(2));
const folder = process.argv[2], chosen = process.argv.slice(3);

const WALLS = [['p0', [200, 120, 440, 300]], ['p1', [200, 120, 440, 300]], ['p2', [200, 120, 440, 300]],
    ['p3', [200, 120, 440, 300]]];
const ROOM = 'remodel-script 1\n' + WALLS.map(([p, a], i) => `wall wall${i + 1} in ${p} ${a.join(' ')}\n`).join('') +
    'join wall1 wall2 wall3 wall4 wall1\nroom room1 wall1 wall2 wall3 wall4\n';
/* on the south wall: x from 2.4 to 3.2, seen from the north; upper left is the larger x */
const DOOR = [project('p0', [3.0, 0, 2.0]), project('p0', [2.2, 0, 0.05])];
const WINDOW = [project('p2', [1.2, 3, 2.1]), project('p2', [2.8, 3, 0.9])];

const tests = {
    async the_room_is_drawn_from_nothing(hand) {
        await hand.begin();
        for (const [photo, a] of WALLS) await hand.drag('wall', photo, [a.slice(0, 2), a.slice(2)]);
        await hand.form('Join walls', {walls: 'wall1 wall2 wall3 wall4 wall1'});
        await hand.form('Room', {name: 'room1', walls: 'wall1 wall2 wall3 wall4', ceiling: ''});
        check(await hand.text() === ROOM, `the script is\n${await hand.text()}`);
        await hand.drag('door', 'p0', DOOR);
        await hand.drag('window', 'p2', WINDOW);
        check(await hand.refusal() === '', await hand.refusal());
        const rectangle = ([a, b]) => [a, b].flat().map(n).join(' ');
        const wanted = ROOM +
            `door door1 on wall1 in p0 ${rectangle(DOOR)}\nwindow window1 on wall3 in p2 ${rectangle(WINDOW)}\n`;
        check(await hand.text() === wanted, `the script is\n${await hand.text()}, wanted\n${wanted}`);
        const model = await hand.model(), at = Object.fromEntries(model.walls.map((w) => [w.name, w.at]));
        for (const [name, c] of [['wall1', 0], ['wall2', -4], ['wall3', -3], ['wall4', 0]])
            check(Math.abs(at[name] - c) < 0.01, `${name} is at ${at[name]}, wanted ${c}`);
        const [door, window] = model.openings, near = (v, w) => v.every((x, i) => Math.abs(x - w[i]) < 0.02);
        check(near(door.s, [2.2, 3.0]) && near(door.z, [0, 2.0]), `the door is at ${JSON.stringify(door)}`);
        check(near(window.s, [1.2, 2.8]) && near(window.z, [0.9, 2.1]), `the window is at ${JSON.stringify(window)}`);
    },

    async walls_by_feet_and_by_corners(hand) {
        await hand.begin();
        await hand.clicks('foot', 'p0', [project('p0', [3.5, 0, 0]), project('p0', [0.5, 0, 0])]);
        check(/^wall wall1 foot in p0 /.test(await hand.last()), await hand.last());
        check(await hand.refusal() === '' && Math.abs((await hand.model()).walls[0].at) < 0.01, await hand.refusal());
        await hand.begin();
        const corner = [[4, 0], [4, 3]].map(([x, y]) => project('p1', [x, y, 0])),
            back = [[0, 3], [0, 0]].map(([x, y]) => project('p3', [x, y, 0]));
        await hand.clicks('corners', 'p1', corner);
        await hand.photo('p3');
        for (const p of [...back, back[1]]) await hand.page.click(await hand.screen(p));
        check(/^walls wall1 wall2 wall3 corner in p1 .* corner in p1 .* corner in p3 .* corner in p3 /.test(await hand.last()), await hand.last());
        check(await hand.refusal() === '', await hand.refusal());
        check(Math.abs((await hand.model()).walls[1].at + 3) < 0.01,
            'the wall between the second and the third corner is not at y = 3');
    },

    async keys_draw_as_the_pointer_does(hand) {
        await hand.begin();
        await hand.photo('p0');
        await hand.page.run("document.getElementById('canvas').focus(); app.cursor = [200, 120]");
        await hand.page.key('w');
        await hand.page.key('Enter');
        for (let i = 0; i < 12; i++) await hand.page.key('ArrowRight', 8);
        for (let i = 0; i < 9; i++) await hand.page.key('ArrowDown', 8);
        await hand.page.key('Enter');
        check(await hand.last() === 'wall wall1 in p0 200 120 440 300', await hand.last());
        await hand.page.key('z', 2);
        check(await hand.text() === '', `undo left ${await hand.text()}`);
        await hand.page.key('y', 2);
        check(await hand.last() === 'wall wall1 in p0 200 120 440 300', 'redo did not bring it back');
    },

    /* Curtains hide where a window ends: a little beyond the edge of the wall is at the edge. */
    async an_opening_a_little_beyond_its_wall_ends_at_it(hand) {
        await hand.begin(ROOM);
        await hand.drag('window', 'p2', [project('p2', [1.2, 3, 2.54]), project('p2', [2.8, 3, 0.9])]);
        check(await hand.refusal() === '', await hand.refusal());
        const z = (await hand.model()).openings[0].z;
        check(z[1] < 2.5 && z[1] > 2.48, `the window reaches up to ${z[1]}`);
    },

    async edits_are_gestures_on_the_model(hand) {
        const text = ROOM + 'window sunny on wall3 from 1.2 0.9 to 2.8 2.1\nbox chest from 1.5 0.2 to 2.5 0.7 top 0.8\n', edit = 'edits/wide.txt';
        const start = async () => hand.begin(text, {[edit]: 'remodel-script 1\n'});
        const said = async () => (await hand.text(edit)).trim().split('\n').pop();
        await start();
        await hand.drag('resize', 'p2', [project('p2', [2.78, 3, 1.5]), project('p2', [3.28, 3, 1.5])]);
        check(/^resize sunny right 0\.48$/.test(await said()), await said());
        check(await hand.refusal() === '' && Math.abs((await hand.model()).openings[0].s[1] - 3.28) < 0.02,
            `${await said()}: ${await hand.refusal()}`);
        await start();
        await hand.drag('move', 'p2', [project('p2', [2, 3, 1.5]), project('p2', [1.7, 3, 1.5])]);
        check(await hand.refusal() === '' && Math.abs((await hand.model()).openings[0].s[0] - 0.9) < 0.02,
            `${await said()}: ${await hand.refusal()}`);
        await start();
        await hand.drag('move', 'p1', [project('p1', [4, 1.5, 0.3]), project('p1', [3.5, 1.5, 0.3])]);
        check(await hand.refusal() === '' && Math.abs((await hand.model()).walls.find((w) => w.name === 'wall2').at +
            3.5) < 0.05, `${await said()}: ${await hand.refusal()}`);
        await start();
        await hand.clicks('paint', 'p0', [project('p0', [2, 0.7, 0.4])]);
        check(/^colour box\/chest\/back 0\.033 0\.091 0\.402$/.test(await said()) && await hand.refusal() === '',
            `${await said()}: ${await hand.refusal()}`);
        await start();
        await hand.form('Remove', {name: 'chest'});
        check(await said() === 'remove chest' && !(await hand.model()).boxes.length, 'the box is still there');
        await hand.form('Remove', {name: 'chest'});
        check(/edits\/wide\.txt:3: .*chest/.test(await hand.refusal()), await hand.refusal());
    },

    async undo_of_100_gestures_restores_the_bytes(hand) {
        await hand.begin(ROOM);
        const before = JSON.stringify(await hand.page.run('app.texts.now')),
            undone = await hand.page.run('app.texts.done.length');
        let seed = 7;
        const random = (below) => (seed = (seed * 1103515245 + 12345) % 2147483648) / 2147483648 * below;
        await hand.page.run("document.getElementById('snap').checked = true");
        const tools = ['wall', 'foot', 'top', 'door', 'passage', 'window', 'box', 'slot', 'adjust', 'move', 'resize'];
        for (let i = 0; i < 100; i++) {
            const tool = tools[Math.floor(random(tools.length))], photo = 'p' + Math.floor(random(4));
            const ends = [0, 1].map(() => [20 + random(600), 20 + random(440)]);
            await hand.page.run(`app.chooseTool(TOOLS.find((t) => t.id === '${tool}'))`);
            await hand.photo(photo);
            await hand.page.drag(await hand.screen(ends[0]), await hand.screen(ends[1]));
            /* half of what is refused is left: it refuses all that follows */
            if (i % 2 && await hand.page.run('app.refused !== null')) await hand.page.key('z', 2);
        }
        check(await hand.page.run('app.texts.done.length') > undone + 20, 'hardly any gesture wrote a statement');
        while (await hand.page.run('app.texts.done.length') > undone) await hand.page.key('z', 2);
        check(JSON.stringify(await hand.page.run('app.texts.now')) === before, 'the texts differ');
    },

    async nothing_typed_is_lost_when_the_page_closes(hand, browser) {
        await hand.begin(ROOM + '# typed\n');
        check((await hand.page.run("document.getElementById('saved').textContent")).includes('model.txt'),
            'the page does not say what is not saved');
        const again = await browser.page(`file://${folder}/index.html`);
        await again.until('app.ready', 60);
        check((await again.run("app.texts.get('model.txt')")).endsWith('# typed\n'), 'the text is gone');
        check(again.errors.length === 0, again.errors.join('; '));
        await again.close();
    },
};

runTests(tests, folder, chosen);
