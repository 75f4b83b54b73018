/* draw_bare.js FOLDER - refusals of a scene whose scale, ceiling and points are unknown, in the page of room.js bare. Prints
 * "ok NAME" or "not ok NAME: WHY". */
'use strict';
const {check, runTests} = require('./hand.js');
const {project} = require('./room.js');
const WALLS = 'remodel-script 1\nset ceiling 2.5\nset thickness 0.1\nwall south from 4 0 to 0 0\nwall west from 0 0 to 0 3\n' +
    'wall north from 0 3 to 4 3\nwall east from 4 3 to 4 0\njoin south west north east south\n';
const at = project;
const remedy = (hand) => hand.page.run("document.getElementById('remedy-button').hidden ? '' : document.getElementById('remedy-button').textContent");

runTests({
    async a_wall_by_a_rectangle_wants_points(hand) {
        await hand.begin('remodel-script 1\nset thickness 0.1\nset ceiling 2.5\n');
        await hand.drag('wall', 'p0', [[200, 120], [440, 300]]);
        check(/model\.txt:4: a wall by a rectangle needs the scene's points/.test(await hand.refusal()), await hand.refusal());
    },

    async a_wall_wants_a_ceiling_and_a_thickness(hand) {
        await hand.begin('remodel-script 1\nset thickness 0.1\n');
        await hand.clicks('foot', 'p0', [at('p0', [3.5, 0, 0]), at('p0', [0.5, 0, 0])]);
        check(/model\.txt:3: no ceiling was found; write "set ceiling NUMBER" before/.test(await hand.refusal()), await hand.refusal());
        await hand.begin('remodel-script 1\nset ceiling 2.5\n');
        await hand.clicks('foot', 'p0', [at('p0', [3.5, 0, 0]), at('p0', [0.5, 0, 0])]);
        check(/model\.txt:3: the thickness of walls is unknown without a scale; write "set thickness NUMBER" before/.test(await hand.refusal()), await hand.refusal());
        check(/^Write "set thickness 0\.15" before it/.test(await remedy(hand)), await remedy(hand));
        await hand.press('remedy-button');
        check(await hand.refusal() === '' && (await hand.model()).walls.length === 1, await hand.refusal());
    },

    async a_window_wants_its_glass_and_a_door_its_leaf(hand) {
        await hand.begin(WALLS);
        await hand.form('Room', {name: 'main', walls: 'south west north east', ceiling: ''});
        await hand.drag('window', 'p0', [at('p0', [3, 0, 2]), at('p0', [2, 0, 1])]);
        check(/the thickness of glass is unknown without a scale; write "set glass NUMBER" before/.test(await hand.refusal()), await hand.refusal());
        await hand.press('remedy-button');
        await hand.drag('door', 'p0', [at('p0', [1.5, 0, 2]), at('p0', [0.8, 0, 0.1])]);
        check(await hand.refusal() === '', await hand.refusal());
        await hand.form('Fill opening', {name: 'door1', with: 'leaf'});
        check(/the thickness of a door's leaf is unknown without a scale; write "set leaf NUMBER" before/.test(await hand.refusal()), await hand.refusal());
    },

    async a_box_wants_its_top(hand) {
        await hand.begin(WALLS.replace('set ceiling 2.5\n', '').replace(/wall (\w+) (.*)/g, 'wall $1 $2 top 2.5'));
        await hand.drag('box', 'p0', [at('p0', [3, 0.2, 0]), at('p0', [2, 0.6, 0])]);
        check(/box box1 has no top, because no ceiling was found; add "top NUMBER" to the line/.test(await hand.refusal()), await hand.refusal());
    },

    /* 2 units are 5 m: the page counts in metres at once, scripts follow, and undo restores their bytes. */
    async a_length_makes_the_page_count_in_metres(hand) {
        const edit = 'remodel-script 1\n# by 0.4\nmove west by 0.4\nbox chest from 1 1 to 2 1.5 top 0.8 turn 30\ncolour box/chest 0.1 0.2 0.3\n';
        const text = WALLS.replace('set ceiling 2.5', '# 2.5 high\nset  ceiling 2.5') + 'room main south west north east\n';
        const lights = 'remodel-lamps 1\narea off in p0 1 1 2 1 2 2 1 2 off 0.04 # 0.04\nlit off in p0 3 3 4 4\n', tour = 'remodel-tour 1\nspeed 0.4\nroom main\n';
        await hand.begin(text, {'edits/e.txt': edit, 'lights.txt': lights, 'tour.txt': tour});
        await hand.page.run("app.openFile('scale.txt')");
        await hand.clicks('mark', 'p0', [at('p0', [1, 0.5, 0]), at('p0', [3, 0.5, 0])]);
        const before = JSON.stringify(await hand.page.run('app.texts.now')), east = (m) => m.walls.find((w) => w.name === 'east').at;
        check(Math.abs(east(await hand.model()) + 4) < 1e-9, 'the model is not in units');
        await hand.form('Length', {from: 'mark1', to: 'mark2', length: '5'});
        const said = await hand.page.run("document.getElementById('meant').textContent"), notes = await hand.page.run("document.getElementById('notes').textContent");
        check(/mark1 to mark2: 5 m given; the model here has 5\.000 m/.test(said), said);
        check(/in metres now: 1 unit was 2\.(49|50)\d+ m\. Lengths in edits\/e\.txt, lights\.txt, model\.txt, tour\.txt were multiplied by 2\.(49|50)/.test(notes), notes);
        const unit = await hand.page.run('app.unit'), n = (v) => String(+(unit * v).toFixed(5));
        check(Math.abs(unit - 2.5) < 0.01 && Math.abs(east(await hand.model()) + 4 * unit) < 1e-4, `a unit is ${unit}, east is at ${east(await hand.model())}`);
        check((await hand.text()).includes(`# 2.5 high\nset  ceiling ${n(2.5)}\nset thickness ${n(0.1)}\nwall south from ${n(4)} 0 to 0 0\n`), await hand.text());
        check(await hand.text('edits/e.txt') === `remodel-script 1\n# by 0.4\nmove west by ${n(0.4)}\nbox chest from ${n(1)} ${n(1)} to ${n(2)} ${n(1.5)} top ${n(0.8)} turn 30\ncolour box/chest 0.1 0.2 0.3\n`,
            await hand.text('edits/e.txt'));
        check(await hand.text('lights.txt') === lights.replace('off 0.04 ', `off ${n(0.04)} `), await hand.text('lights.txt'));
        check(await hand.text('tour.txt') === tour.replace('0.4', n(0.4)), await hand.text('tour.txt'));
        const after = JSON.stringify(await hand.page.run('app.texts.now'));
        await hand.page.run('app.undo()');
        check(JSON.stringify(await hand.page.run('app.texts.now')) === before && await hand.page.run('app.unit') === 1, 'undo did not restore the texts');
        check(Math.abs(east(await hand.model()) + 4) < 1e-9, 'undo did not restore the model');
        await hand.page.run('app.redo()');
        check(JSON.stringify(await hand.page.run('app.texts.now')) === after && Math.abs(east(await hand.model()) + 4 * unit) < 1e-4, 'redo did not bring it back');
    },

    /* What a suggestion says of a statement goes when the statement was accepted. */
    async a_doubtful_suggestion_takes_its_remark_along(hand) {
        await hand.begin(WALLS, {});
        await hand.page.run("app.suggested = [new SuggestedPanel(document.getElementById('suggested'), app, 'model.txt', 'remodel-script 1\\nset ceiling 2.5\\n# nobody saw the sky\\n\\n# bright and without depth: a window\\n# window window1 on east from -1 1 to -2 2\\n')]; app.openFile('model.txt')");
        const shown = () => hand.page.run("document.getElementById('suggested').textContent");
        check(/nobody saw the sky.*bright and without depth/.test(await shown()), await shown());
        await hand.page.run("[...document.querySelectorAll('#suggested li')].find((e) => e.querySelector('input') && /^window/.test(e.querySelector('input').value)).querySelector('button').click()");
        check(/nobody saw the sky/.test(await shown()) && !/bright/.test(await shown()), await shown());
        check(/^window window1 on east/m.test(await hand.text()), await hand.text());
    },

    /* What a model lacks is said, each part until it is there. */
    async the_page_says_what_is_missing(hand) {
        const next = () => hand.page.run("document.getElementById('next').textContent");
        await hand.begin('remodel-script 1\n', {});
        await hand.page.run("app.texts.set('scale.txt', ''); app.texts.set('lights.txt', ''); app.openFile('model.txt')");
        check(/Walls: .*Scale: .*Lamps: /.test(await next()), await next());
        await hand.begin(WALLS);
        check(/Rooms: Join walls, then Room/.test(await next()), await next());
        await hand.page.run("[...document.querySelectorAll('#next button')].find((b) => b.textContent === 'Scale').click()");
        check(await hand.page.run('app.file') === 'scale.txt' && await hand.page.run('document.activeElement.name') === 'height', 'Scale does not lead to its form');
        await hand.page.run("app.texts.set('lights.txt', 'remodel-lamps 1\\ndisk a in p0 1 1 rim 2 2\\n')");
        check(!/Lamps/.test(await next()), await next());
    },
}, process.argv[2], []);
