/* draw_refusals.js FOLDER [TEST...] - what the model script refuses, reached by gestures in the page of the room of
 * room.js: each refusal is said in the words of the C code, marked at its line, and the last model stays. Prints "ok NAME"
 * or "not ok NAME: WHY".
 *
 * A case: what it is; the script before; the gesture; what is said. Refusals of other statements, of units, of files and
 * of numbers that no gesture can write are tests of the C code (tests/unit/build_model). */
'use strict';
const {check, runTests} = require('./hand.js');
const {project} = require('./room.js');
const folder = process.argv[2], chosen = process.argv.slice(3);

const ROOM = 'remodel-script 1\nwall wall1 in p0 200 120 440 300\nwall wall2 in p1 200 120 440 300\n' +
    'wall wall3 in p2 200 120 440 300\nwall wall4 in p3 200 120 440 300\njoin wall1 wall2 wall3 wall4 wall1\n' +
    'room room1 wall1 wall2 wall3 wall4\n';
const WALLS = ROOM.split('join')[0];
const FURNISHED = ROOM + 'window sunny on wall3 from 1.2 0.9 to 2.8 2.1\nbox chest from 1.5 0.2 to 2.5 0.7 top 0.8\n';
const at = project, south = (x, z) => at('p0', [x, 0, z]), north = (x, z) => at('p2', [x, 3, z]),
    floor = (photo, x, y) => at(photo, [x, y, 0]);

/* Clicks on parts of the model, the first alone, the others with Shift. */
const select = async (hand, list) => {
    await hand.press('tool-select');
    for (const [i, [photo, p]] of list.entries()) {
        await hand.photo(photo);
        await hand.page.click(await hand.screen(p), i ? 8 : 0);
    }
};
/* A form that takes what is selected: its button, then Write it. */
const write = (hand, label, values = {}) => hand.form(label, values);
const S = ['p0', south(2, 1.2)], E = ['p1', at('p1', [4, 1.5, 1.2])], N = ['p2', north(2, 0.5)],
    W = ['p3', at('p3', [0, 1.5, 1.2])];

const MODEL = [
    ['a wall with few points', ROOM, (h) => h.drag('wall', 'p0', [[100, 100], [104, 103]]), /contains \d+ visible points/],
    ['a wall on the floor', ROOM, (h) => h.drag('wall', 'p0', [[250, 440], [400, 478]]), /contains \d+ visible points with the normal of a wall/],
    ['a foot above the horizon', ROOM, (h) => h.clicks('foot', 'p0', [[100, 50], [500, 50]]), /there can be no floor: it is at the horizon or above it/],
    ['a top below the horizon', ROOM, (h) => h.clicks('top', 'p0', [[100, 450], [500, 450]]), /there can be no ceiling: it is at the horizon or below it/],
    ['a foot of no length', ROOM, (h) => h.keys('foot', 'p0', [floor('p0', 3, 0.1), floor('p0', 3, 0.1)]), /found the pixel [\d.]+ [\d.]+ of p0 twice, wanted two pixels of a line/],
    ['a foot across the room', ROOM, (h) => h.clicks('foot', 'p0', [floor('p0', 3, 0.1), floor('p0', 1, 0.6)]), /the line runs [\d.]+ degrees off/],
    ['three corners on a line', ROOM, (h) => h.clicks('corners', 'p0', [floor('p0', 3.5, 0.05), floor('p0', 2, 0.05),
        floor('p0', 0.5, 0.05), floor('p0', 0.5, 0.05)]), /the walls before and after it run in one direction/],
    ['corners askew', ROOM, (h) => h.clicks('corners', 'p0', [floor('p0', 3.2, 0.1), floor('p0', 1.5, 0.6),
        floor('p0', 1.5, 0.6)]), /degrees off/],
    ['corners twice at one place', ROOM, (h) => h.keys('corners', 'p0', [floor('p0', 3.5, 0.05), floor('p0', 3.5, 0.05),
        floor('p0', 3.5, 0.05)]), /are at one place; mark two ends of the wall/],
    ['a door beside its wall', ROOM, (h) => h.drag('door', 'p0', [south(4.1, 2), south(3.2, 0.1)]), /door1, from [-\d.]+ to [-\d.]+, is outside its wall/],
    ['a window above its wall', ROOM, (h) => h.drag('window', 'p0', [south(3, 2.8), south(2, 1.5)]), /window1, from [\d.]+ up to [\d.]+, is outside its wall/],
    ['a window of no size', ROOM, (h) => h.keys('window', 'p2', [north(1, 1), north(1, 1)]), /wanted X0 Y0 its upper left corner and X1 Y1 its lower right one/],
    ['two windows at one place', FURNISHED, (h) => h.drag('window', 'p2', [north(2, 1.5), north(3.4, 1)]), /window sunny and window window1, on wall wall3, overlap/],
    ['a skylight beyond its room', ROOM, (h) => h.drag('slot', 'p0', [at('p0', [3, 0.3, 2.5]), at('p0', [2, -0.4, 2.5])]), /skylight1, from .* does not lie between the walls of room room1/],
    ['a skylight of no size', ROOM, (h) => h.keys('slot', 'p0', [at('p0', [3, 0.3, 2.5]), at('p0', [3, 0.3, 2.5])]), /wanted X0 Y0 its upper left corner and X1 Y1 its lower right one/],
    ['two skylights at one place', ROOM + 'skylight top on room1 from 2 0.1 to 3 0.8\n', (h) =>
        h.drag('slot', 'p0', [at('p0', [3.2, 0.4, 2.5]), at('p0', [2.5, 0.2, 2.5])]), /skylight.*, in room room1, overlap/],
    ['a hatch beyond its room', ROOM, (h) => h.drag('slot', 'p0', [floor('p0', 3, 0.3), floor('p0', 2, -0.3)]), /hatch1, from .* does not lie between the walls of room room1/],
    ['a box of no size', ROOM, (h) => h.keys('box', 'p0', [floor('p0', 3, 0.5), floor('p0', 3, 0.5)]), /wanted X0 Y0 its upper left corner and X1 Y1 its lower right one/],
    ['a box above the horizon', ROOM, (h) => h.drag('box', 'p0', [[100, 50], [300, 100]]), /does not hit the plane: it/],
    ['a window adjusted in a photo that looks away', FURNISHED, async (h) => {
        await select(h, [['p2', north(2, 1.5)]]);
        await h.drag('adjust', 'p0', [south(2, 2), south(1, 1)]);
    }, /does not hit the plane: it/],
    ['a room adjusted', ROOM, async (h) => {
        await select(h, [['p0', floor('p0', 2, 0.4)]]);
        await h.drag('adjust', 'p0', [floor('p0', 3, 0.3), floor('p0', 2, 0.6)]);
    }, /room1 is a room; wanted/],
    ['a join of parallel walls', WALLS, async (h) => {
        await select(h, [S, N]);
        await write(h, 'Join walls');
    }, /walls wall1 and wall3 cannot be joined: they are parallel/],
    ['a join of a wall with itself', WALLS, async (h) => {
        await select(h, [S, S]);
        await write(h, 'Join walls');
    }, /wall wall1 cannot be joined to itself/],
    ['a join of ends that are joined', ROOM + 'wall part from 3 0 to 3 3\n', async (h) => {
        await select(h, [S, ['p1', at('p1', [3, 1.5, 1])]]);
        await write(h, 'Join walls');
    }, /cannot be joined: both ends of wall1 are joined already, to wall\d and wall\d/],
    ['a room of walls that do not meet', WALLS, async (h) => {
        await select(h, [S, E, N, W]);
        await write(h, 'Room');
    }, /do not meet: join them, or extend one to the other/],
    ['a room of parallel walls', WALLS, async (h) => {
        await select(h, [S, N]);
        await write(h, 'Room');
    }, /found the end of the line, wanted more words, in a line "room NAME WALL WALL WALL/],
    ['a room of three of four walls', ROOM, async (h) => {
        await select(h, [S, E, N]);
        await write(h, 'Room');
    }, /walls wall3 and wall1, which follow each other round room room2, are parallel and never meet/],
    ['a room that names a wall twice', WALLS, async (h) => {
        await select(h, [S, E, S]);
        await write(h, 'Room');
    }, /room room1 names wall wall1 twice/],
    ['a name that is taken', ROOM, async (h) => {
        await select(h, [S, E, N, W]);
        await write(h, 'Room', {name: 'room1'});
    }, /the name room1 is used already/],
    ['a wall extended to a parallel one', WALLS, async (h) => {
        await select(h, [S, N]);
        await write(h, 'Extend wall');
    }, /walls wall1 and wall3 cannot be joined: they are parallel/],
    ['a split outside of its wall', ROOM, async (h) => {
        await select(h, [S]);
        await write(h, 'Split wall', {from: '5', to: '6'});
    }, /the gap from 5 to 6 does not lie in wall wall1/],
    ['a split through a window', FURNISHED, async (h) => {
        await select(h, [N]);
        await write(h, 'Split wall', {from: '1', to: '2'});
    }, /the gap from 1 to 2 cuts window sunny/],
    ['a wall without thickness', ROOM, (h) => write(h, 'Heights and thickness', {what: 'thickness', value: '0'}), /found thickness 0, wanted 0.001 to 1000/],
    ['a ceiling below the floor', ROOM, async (h) => {
        await select(h, [['p0', floor('p0', 2, 0.4)]]);
        await write(h, 'Change', {how: 'ceiling -1'});
    }, /room room1 would go from 0 up to -1, wanted a ceiling above the floor/],
    ['a wall below its foot', ROOM, async (h) => {
        await select(h, [S]);
        await write(h, 'Change', {how: 'top -1'});
    }, /wall wall1 would go from 0 up to -1, wanted a top above its foot/],
    ['a part that it does not have', FURNISHED, async (h) => {
        await select(h, [['p2', north(2, 1.5)]]);
        await write(h, 'Change', {how: 'ceiling 3'});
    }, /sunny is an opening; wanted a wall, a box or a room/],
    ['a window filled as it is', FURNISHED, async (h) => {
        await select(h, [['p2', north(2, 1.5)]]);
        await write(h, 'Fill opening', {with: 'glass'});
    }, /window sunny is filled with glass already/],
    ['a wall that is filled', FURNISHED, async (h) => {
        await select(h, [S]);
        await write(h, 'Fill opening', {with: 'glass'});
    }, /wall1 is a wall; wanted/],
    ['a name that is unknown', ROOM, (h) => write(h, 'Remove', {name: 'nothing'}), /nothing is named nothing yet/],
    ['a statement that is unknown', ROOM, (h) => write(h, 'Any statement', {line: 'dor a on wall1 from 1 0 to 2 2'}), /did you mean door/],
    ['a photo that is unknown', ROOM, (h) => write(h, 'Any statement', {line: 'window a on wall3 in p9 1 1 2 2'}), /found "p9", wanted a photo's id/],
    ['what is for edits', ROOM, (h) => write(h, 'Any statement', {line: 'clear all'}), /"clear" is for edits/],
];

const EDIT = [
    ['a wall moved by nothing', (h) => h.keys('move', 'p1', [at('p1', [4, 1.5, 0.3]), at('p1', [4, 1.5, 0.3])]), /changes nothing/],
    ['a window moved off its wall', (h) => h.drag('move', 'p2', [north(2, 1.5), north(0.6, 1.5)]), /sunny, from [-\d.]+ to [-\d.]+, is outside its wall/],
    ['a window moved above its wall', (h) => h.drag('move', 'p2', [north(2, 1.5), north(2, 2.3)]), /sunny, from [\d.]+ up to [\d.]+, is outside its wall/],
    ['a window turned inside out', (h) => h.drag('resize', 'p2', [north(2.78, 1.5), north(1.0, 1.5)]), /window sunny would be -[\d.]+ wide and/],
    ['a box moved far out', (h) => h.drag('move', 'p0', [at('p0', [2, 0.7, 0.7]), [320, 191.82]]), /chest reaches to [-\d.]+; a model lies within 1000 units/],
    ['a place to clear above the horizon', (h) => h.drag('clear', 'p0', [[100, 50], [300, 100]]), /does not hit the plane: it/],
    ['a place to keep of no size', (h) => h.keys('keep', 'p0', [floor('p0', 3, 0.5), floor('p0', 3, 0.5)]), /wanted X0 Y0 its upper left corner and X1 Y1 its lower right one/],
    ['what was removed', async (h) => {
        await write(h, 'Remove', {name: 'chest'});
        await write(h, 'Remove', {name: 'chest'});
    }, /chest was removed and can no longer be changed/],
    ['a room that is unknown', (h) => write(h, 'Clear a room', {what: 'hall'}), /nothing is named hall yet/],
    ['a thing that is unknown', (h) => write(h, 'Move a thing', {name: 'sofa', by: '1 0', turn: ''}), /nothing is named sofa yet/],
    ['a lamp without a change', (h) => write(h, 'Lamp', {name: 'spot', how: 'dim'}), /found "dim", wanted something else, in a line "lamp NAME off/],
];

async function refused(hand, what, file, lines, wanted) {
    const said = await hand.refusal(), marked = await hand.page.run("(document.querySelector('#numbers b') || {}).textContent");
    check(wanted.test(said), `${what}: said "${said}", wanted ${wanted}; the text is\n${await hand.text(file)}`);
    const line = new RegExp(file.replace('.', '\\.') + ':(\\d+)').exec(said);
    check(line && marked && marked.includes(line[1]), `${what}: line ${marked} is marked, after "${said}"`);
}

const tests = {
    async refusals_of_the_model(hand) {
        for (const [what, text, gesture, wanted] of MODEL) {
            await hand.begin(text);
            await gesture(hand);
            await refused(hand, what, 'model.txt', text, wanted);
            check((await hand.model()).walls.length > 0, `${what}: the last model is gone`);
        }
        console.log(`# ${MODEL.length} kinds`);
    },

    async refusals_of_an_edit(hand) {
        for (const [what, gesture, wanted] of EDIT) {
            await hand.begin(FURNISHED, {'edits/e.txt': 'remodel-script 1\n'});
            await gesture(hand);
            await refused(hand, what, 'edits/e.txt', '', wanted);
            check((await hand.model()).walls.length > 0, `${what}: the last model is gone`);
        }
        console.log(`# ${EDIT.length} kinds`);
    },
};

runTests(tests, folder, chosen);
