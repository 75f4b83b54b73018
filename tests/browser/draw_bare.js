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

    async a_length_says_what_a_unit_is(hand) {
        await hand.begin(WALLS);
        await hand.page.run("app.openFile('scale.txt')");
        await hand.clicks('mark', 'p0', [at('p0', [1, 0.5, 0]), at('p0', [3, 0.5, 0])]);
        await hand.form('Length', {from: 'mark1', to: 'mark2', length: '5'});
        const said = await hand.page.run("document.getElementById('meant').textContent");
        check(/mark1 to mark2: 5 m given, (1\.99|2\.00)\d+ units here: 1 unit is 2\.[45]\d+ m/.test(said), said);
    },
}, process.argv[2], []);
