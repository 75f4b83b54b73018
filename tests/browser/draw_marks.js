/* draw_marks.js FOLDER [TEST...] - marks, masks, the draft of an edit and saving, in the page of the room of room.js. Prints
 * "ok NAME" or "not ok NAME: WHY". */
'use strict';
const fs = require('fs');
const {check, runTests} = require('./hand.js');
const {project} = require('./room.js');
const folder = process.argv[2], chosen = process.argv.slice(3);
const ROOM = 'remodel-script 1\nwall south from 4 0 to 0 0\nwall west from 0 0 to 0 3\nwall north from 0 3 to 4 3\n' +
    'wall east from 4 3 to 4 0\njoin south west north east south\nroom main south west north east\n';
const n = (v) => String(+v.toFixed(2)), px = (list) => list.map((p) => p.map(n).join(' ')).join(' ');
const meant = (hand) => hand.page.run("[...document.querySelectorAll('#meant li')].map((e) => e.textContent).join('\\n')");
const shapes = (hand) => hand.page.run('app.marks.shapes');
const near = (a, b, by) => a.every((v, i) => Math.abs(v - b[i]) <= by);
const open = async (hand, file, texts = {}) => {
    await hand.begin(ROOM, texts);
    await hand.page.run(`app.texts.set('${file}', ''); app.openFile('${file}'); app.forms.name = ''; app.forms.show()`);
};
const name = (hand, value) => hand.page.run(`(() => { const i = document.querySelector('#forms input[name=name]'); i.value = '${value}'; i.dispatchEvent(new Event('input')); })()`);
const last = async (hand, file) => (await hand.text(file)).trim().split('\n').pop();
const drawn = (hand) => hand.page.run("[...document.querySelectorAll('#plan .marks text')].map((e) => e.textContent)");

const tests = {
    async a_length_is_marked_and_compared(hand) {
        await open(hand, 'scale.txt');
        const a = [1, 0.5, 0], b = [3, 0.5, 0];
        await hand.clicks('mark', 'p0', [project('p0', a), project('p0', b)]);
        check(await hand.text('scale.txt') === `mark mark1 p0 ${px([project('p0', a)])} floor\nmark mark2 p0 ${px([project('p0', b)])} floor\n`,
            await hand.text('scale.txt'));
        await hand.form('Length', {from: 'mark1', to: 'mark2', length: '2.5'});
        check(/mark1 to mark2: 2.5 m given; the model as it was made has (1\.99|2\.00)\d m\./.test(await meant(hand)), await meant(hand));
        const line = (await shapes(hand)).find((s) => s.form === 'line');
        check(line.label === '2.5 m' && near(line.at[0], a, 0.02) && near(line.at[1], b, 0.02), JSON.stringify(line));
        check((await drawn(hand)).includes('2.5 m'), 'the plan does not show the length');
        await hand.form('Height', {what: 'ceiling', height: '2.5'});
        check(/the ceiling: 2.5 m given; the model as it was made has 2.500 m/.test(await meant(hand)), await meant(hand));
    },

    async a_corner_and_its_edge_are_marked(hand) {
        await open(hand, 'axes_fix.txt');
        await hand.clicks('corner', 'p0', [project('p0', [4, 0, 0])]);
        check(/^corner corner1 p0 /.test(await last(hand, 'axes_fix.txt')), await last(hand, 'axes_fix.txt'));
        check(/corner1 needs a mark in a second photo, or an edge/.test(await meant(hand)), await meant(hand));
        await name(hand, 'corner1');
        await hand.clicks('edge', 'p0', [project('p0', [1, 0, 0])]);
        check(/^edge corner1 p0 /.test(await last(hand, 'axes_fix.txt')), await last(hand, 'axes_fix.txt'));
        check(/edge of corner1: 0\.\d\d degrees off the nearest axis/.test(await meant(hand)), await meant(hand));
        const corner = (await shapes(hand)).find((s) => s.form === 'corner');
        check(near(corner.at[0], [4, 0, 0], 0.02), JSON.stringify(corner));
        await name(hand, 'a');
        await hand.clicks('mark', 'p0', [project('p0', [1, 0.2, 0])]);
        await name(hand, 'b');
        await hand.clicks('mark', 'p0', [project('p0', [1.2, 0.2, 0])]);
        await hand.form('Thickness', {a: 'a', b: 'b'});
        check((await last(hand, 'axes_fix.txt')) === 'thickness a b', await last(hand, 'axes_fix.txt'));
    },

    async lamps_and_what_they_light_are_marked(hand) {
        await open(hand, 'lights.txt');
        const floor = (x, y) => project('p0', [x, y, 0]);
        await hand.drag('lit', 'p0', [floor(2.8, 0.3), floor(2.2, 0.6)]);
        check(/Mark a lamp first/.test(await hand.refusal()), await hand.refusal());
        const p = (x, y, z) => project('p0', [x, y, z]), area = [[1, 0.05], [1.4, 0.05], [1.4, 0.2], [1, 0.2]].map(([x, y]) => p(x, y, 2.5));
        await hand.clicks('disk', 'p0', [p(2.5, 0.3, 2.5), p(2.6, 0.3, 2.5)]);
        check(await last(hand, 'lights.txt') === `disk lamp1 in p0 ${px([p(2.5, 0.3, 2.5)])} rim ${px([p(2.6, 0.3, 2.5)])} beta fit`, await last(hand, 'lights.txt'));
        await hand.clicks('area', 'p0', area);
        check(await last(hand, 'lights.txt') === `area lamp2 in p0 ${px(area)}`, await last(hand, 'lights.txt'));
        check(/lamp1: .*dark beside its cone: drag a Lit rectangle.*\nlamp2: .*its own pixels tell its radiance/.test(await meant(hand)), await meant(hand));
        /* the lamp that was marked last, unless another one is named */
        await hand.drag('lit', 'p0', [p(2.8, 0, 1.5), p(2.2, 0, 1)]);
        check(/^lit lamp2 in p0 /.test(await last(hand, 'lights.txt')), await last(hand, 'lights.txt'));
        await hand.page.key('z', 2);
        const lamps = "document.querySelector('#forms select[name=lamp]')";
        check(await hand.page.run(`[...${lamps}.options].map((o) => o.value).join() + ' ' + ${lamps}.value`) === 'lamp1,lamp2 lamp2', 'the lamps are not there to choose from');
        await hand.page.run(`${lamps}.value = 'lamp1'; ${lamps}.dispatchEvent(new Event('change'))`);
        await hand.drag('lit', 'p0', [p(2.8, 0, 1.5), p(2.2, 0, 1)]);
        check(await last(hand, 'lights.txt') === `lit lamp1 in p0 ${px([p(2.8, 0, 1.5), p(2.2, 0, 1)])}`, await last(hand, 'lights.txt'));
        await hand.drag('unlit', 'p0', [p(3.8, 0, 2.2), p(3.5, 0, 2)]);
        await hand.clicks('cone', 'p0', [p(3.2, 0, 1), p(3.2, 0, 2)]);
        check(await last(hand, 'lights.txt') === `line lamp1 in p0 ${px([p(3.2, 0, 1), p(3.2, 0, 2)])}`, await last(hand, 'lights.txt'));
        check((await hand.text('lights.txt')).startsWith('remodel-lamps 1\n'), 'the file has no head');
        check(/lamp1: make lights will fit its radiance; 1 lit, 1 unlit, 1 cone lines/.test(await meant(hand)), await meant(hand));
        const of = (kind) => shapes(hand).then((l) => l.filter((s) => s.kind === kind));
        check(near((await of('lamp'))[0].at[0], [2.5, 0.3, 2.5], 0.03), JSON.stringify(await of('lamp')));
        check(near((await of('lit'))[0].at[0], [2.5, 0, 1.25], 0.05), JSON.stringify(await of('lit')));
        for (const word of ['lamp1', 'lamp2', 'lit', 'unlit']) check((await drawn(hand)).includes(word), `the plan does not show ${word}`);
        /* what make lights fitted is shown beside it: a cone of 45 degrees from 2.5 m meets the floor 2.5 m away */
        await hand.page.run("app.scene.files['out/lights/lights.txt'] = 'remodel-lights 1\\ndisk lamp1 2.5 0.3 2.5 0 0 -1 0.1 20 19 18 45 1\\n'; app.showMarks()");
        check(/lamp1: radiance 20 19 18, cone of 45.0 degrees, as make lights fitted it/.test(await meant(hand)), await meant(hand));
        const ring = (await of('cone'))[0].at;
        check(ring.every((q) => Math.abs(Math.hypot(q[0] - 2.5, q[1] - 0.3) - 2.5) < 1e-9), 'the cone is not where it meets the floor');
        await hand.page.run("delete app.scene.files['out/lights/lights.txt']");
    },

    async materials_subjects_and_things_are_marked(hand) {
        const p = (x, z) => project('p0', [x, 0, z]), region = [p(2.5, 1.5), p(2, 1.5), p(2, 1), p(2.5, 1)];
        await open(hand, 'materials.txt');
        await name(hand, 'plaster');
        await hand.clicks('material', 'p0', [...region, region[3]]);
        check(await last(hand, 'materials.txt') === `material plaster in p0 ${px(region)}`, await last(hand, 'materials.txt'));
        await open(hand, 'subjects.txt');
        await hand.drag('subject', 'p0', [p(2.5, 1.5), p(2, 1)]);
        check(await last(hand, 'subjects.txt') === `subject p0 ${px([p(2.5, 1.5), p(2, 1)])}`, await last(hand, 'subjects.txt'));
        check((await drawn(hand)).includes('subject 1'), 'the plan does not show the subject');
        await open(hand, 'things.txt');
        await hand.clicks('thing', 'p0', [p(2, 1)]);
        check(await last(hand, 'things.txt') === `thing thing1 in p0 ${px([p(2, 1)])}`, await last(hand, 'things.txt'));
        await hand.clicks('flat', 'p0', [...region, region[3]]);
        check(await last(hand, 'things.txt') === `flat flat1 in p0 ${px(region)}`, await last(hand, 'things.txt'));
    },

    async corners_of_reference_images_are_marked(hand) {
        await open(hand, 'lri.txt');
        await hand.page.run("app.texts.set('model.txt', app.texts.get('model.txt') + 'window sunny on south from 1 1 to 2 2\\n'); app.openFile('lri.txt')");
        const id = await hand.page.run('app.photoId()');
        check(id === 'sky', `photo ${id} is shown`);
        await hand.page.run("(() => { const i = document.querySelector('#forms input[name=opening]'); i.value = 'sunny'; i.dispatchEvent(new Event('input')); })()");
        await hand.clicks('lri-corner', 'sky', [[40, 100], [90, 100], [90, 20], [40, 20]]);
        check(await hand.text('lri.txt') === 'corner sky sunny left bottom 40 100\ncorner sky sunny right bottom 90 100\n' +
            'corner sky sunny right top 90 20\ncorner sky sunny left top 40 20\n', await hand.text('lri.txt'));
        check(/sky: 4 marks\./.test(await meant(hand)), await meant(hand));
        await hand.clicks('lri-in', 'sky', [[60, 60]]);
        check(await last(hand, 'lri.txt') === 'in sky sunny looking out', await last(hand, 'lri.txt'));
        await hand.clicks('horizon', 'sky', [[10, 60], [150, 61]]);
        check(await last(hand, 'lri.txt') === 'horizon sky 10 60 150 61', await last(hand, 'lri.txt'));
        await hand.clicks('lri-corner', 'p0', [[40, 100]]);
        check(/Choose a reference image first/.test(await hand.refusal()), await hand.refusal());
    },

    /* Half of the photo is hidden, a quarter shown again. */
    async masks_are_drawn_and_become_pictures(hand) {
        await open(hand, 'masks.txt');
        await hand.drag('hide-box', 'p0', [[0, 0], [320, 480]]);
        await hand.clicks('show', 'p0', [[0, 0], [160, 0], [160, 480], [0, 480], [0, 480]]);
        check(await hand.text('masks.txt') === 'hide in p0 0 0 320 0 320 480 0 480\nshow in p0 0 0 160 0 160 480 0 480\n', await hand.text('masks.txt'));
        check(/p0: 25\.0 % of its pixels are hidden/.test(await meant(hand)), await meant(hand));
        const counts = await hand.page.run(`(async () => {
            const picture = await createImageBitmap(await app.masks.png('p0')), c = new OffscreenCanvas(640, 480).getContext('2d');
            c.drawImage(picture, 0, 0);
            const d = c.getImageData(0, 0, 640, 480).data, at = (x, y) => d[4 * (640 * y + x)];
            let black = 0, other = 0;
            for (let i = 0; i < d.length; i += 4) { black += d[i] === 0; other += d[i] !== 0 && d[i] !== 255; }
            return [picture.width, picture.height, black, other, at(159, 100), at(160, 100), at(319, 479), at(320, 479)]; })()`);
        check(JSON.stringify(counts) === JSON.stringify([640, 480, 160 * 480, 0, 255, 0, 0, 255]), JSON.stringify(counts));
        await hand.page.key('z', 2);
        check(/p0: 50\.0 %/.test(await meant(hand)), await meant(hand));
    },

    /* The folder that somebody chooses is replaced by one in memory. */
    async what_is_saved_is_in_the_folder(hand) {
        await open(hand, 'masks.txt', {'edits/wide.txt': 'remodel-script 1\nmove east by 0.5\n'});
        await hand.drag('hide-box', 'p1', [[100, 100], [200, 200]]);
        await hand.page.run(`window.kept = {}; window.ended = [];
            const folderAt = (path) => ({name: 'room', kind: 'directory',
                getDirectoryHandle: async (name) => folderAt(path + name + '/'),
                getFileHandle: async (name) => ({createWritable: async () => ({
                    write: async (what) => { kept[path + name] = typeof what === 'string' ? what : [what.type, what.size]; },
                    close: async () => { ended.push(path + name); }})})});
            window.showDirectoryPicker = async () => { window.asked = (window.asked || 0) + 1; return folderAt(''); }`);
        await hand.press('save');
        await hand.page.until("document.getElementById('saved').textContent === 'saved'");
        const kept = await hand.page.run('kept'), closed = await hand.page.run('ended');
        check(kept['model.txt'] === ROOM && kept['edits/wide.txt'] === 'remodel-script 1\nmove east by 0.5\n', JSON.stringify(kept));
        check(kept['masks/p1.png'][0] === 'image/png' && kept['masks/p1.png'][1] > 50 && !('masks.txt' in kept), JSON.stringify(kept));
        check(Object.keys(kept).every((k) => closed.includes(k)), 'a file was not closed');
        check(/^Saved .*model\.txt.* in the folder room\.$/.test(await hand.page.run("document.getElementById('notes').textContent")), 'the page does not say what was saved');
        /* a later save asks for no folder, and writes what changed alone */
        await hand.page.run("kept = {}; app.texts.add('scale.txt', '# later')");
        await hand.page.key('s', 2);
        await hand.page.until("document.getElementById('saved').textContent === 'saved'");
        check(JSON.stringify(await hand.page.run('Object.keys(kept)')) === '["scale.txt"]' && await hand.page.run('asked') === 1, JSON.stringify(await hand.page.run('Object.keys(kept)')));
    },

    async a_folder_that_is_refused_loses_nothing(hand) {
        await hand.begin(ROOM + '# more\n');
        await hand.page.run(`app.store.folder = null; window.showDirectoryPicker = async () => { throw new DOMException('no', 'AbortError'); }`);
        await hand.press('save');
        await hand.page.until("/Not saved: no folder was chosen/.test(document.getElementById('notes').textContent)");
        check(/model\.txt/.test(await hand.page.run("document.getElementById('saved').textContent")), 'it counts as saved');
        /* a write that fails: the same */
        await hand.page.run(`window.showDirectoryPicker = async () => ({name: 'room', getFileHandle: async () => { throw new Error('the disk is full'); }})`);
        await hand.press('save');
        await hand.page.until("/Not saved: the disk is full/.test(document.getElementById('notes').textContent)");
        check(/model\.txt/.test(await hand.page.run("document.getElementById('saved').textContent")), 'it counts as saved');
        await hand.page.run('app.store.folder = null');
    },

    async where_no_folder_can_be_chosen_files_are_downloaded(hand) {
        await hand.begin(ROOM + '# again\n', {'edits/wide.txt': 'remodel-script 1\nmove east by 0.4\n'});
        await hand.page.run(`window.downloads = []; window.showDirectoryPicker = undefined; app.store.folder = null;
            HTMLAnchorElement.prototype.click = function () { const name = this.download; downloads.push(fetch(this.href).then((r) => r.text()).then((text) => [name, text])); }`);
        await hand.press('save');
        await hand.page.until("document.getElementById('saved').textContent === 'saved'");
        const files = Object.fromEntries(await hand.page.run('Promise.all(downloads)'));
        check(files['model.txt'] === ROOM + '# again\n' && files['wide.txt'] === 'remodel-script 1\nmove east by 0.4\n', JSON.stringify(files));
        check(/Downloaded .*: put them into scenes\/room\/, those of edits into its folder edits/.test(await hand.page.run("document.getElementById('notes').textContent")),
            await hand.page.run("document.getElementById('notes').textContent"));
    },

    /* The north wall moves away: the draft shows its pattern smaller, which the picture of the moved wall has too. */
    async the_draft_shows_the_edited_room(hand) {
        await hand.begin(ROOM, {'edits/deep.txt': 'remodel-script 1\nmove north by 0.5\n'});
        await hand.photo('p2');
        await hand.page.until('app.draft.picture && app.draft.picture.width > 200', 60);
        check(/^Right of the border: a draft of what make remodel draws\. \d+ % of the picture changes/.test(await hand.page.run("document.getElementById('draft-note').textContent")),
            await hand.page.run("document.getElementById('draft-note').textContent"));
        const pixel = ([u, v]) => hand.page.run(`(() => { const c = new OffscreenCanvas(1, 1).getContext('2d'), d = app.draft.picture;
            c.drawImage(d, -Math.floor(${u} * d.width / 640), -Math.floor(${v} * d.height / 480)); return [...c.getImageData(0, 0, 1, 1).data]; })()`);
        /* the middles of two fields of the pattern, dark 180 and light 205, on the wall that moved */
        for (const [x, z] of [[1.125, 1.125], [1.375, 1.125], [2.125, 0.625], [2.625, 1.875]]) {
            const light = (Math.floor(4 * x) + Math.floor(4 * z)) & 1, got = await pixel(project('p2', [x, 3.5, z]));
            check(got[3] === 255 && Math.abs(got[0] - (light ? 205 : 180)) < 10, `the wall at ${x} ${z} is ${got}`);
        }
        const still = await pixel(project('p2', [1, 2, 0]));
        check(still[3] === 0, `the floor, which stays, is drawn: ${still}`);
        /* the new floor before it lies beside what the photos show: its nearest texels are repeated, or it is striped */
        /* left of the border is the photo: the whole picture is that of the canvas without a draft */
        const shown = () => hand.page.run(`(() => { const c = document.getElementById('canvas'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let sum = 0; for (let i = 0; i < d.length; i += 4) sum = (sum * 31 + d[i] + 256 * d[i + 1]) % 1e9; return sum; })()`);
        await hand.page.run("document.getElementById('show-edges').checked = false; document.getElementById('split').value = 100; app.cursor = [-900, 0]; app.draw()");
        const without = await shown();
        await hand.page.run("document.getElementById('canvas').focus()");
        for (let i = 0; i < 20; i++) await hand.page.key('[');
        await hand.page.run('app.cursor = [-900, 0]; app.draw()');
        check(await hand.page.run("document.getElementById('split').value") === '0' && await shown() !== without, 'the border has no effect');
        await hand.page.run("document.getElementById('show-edges').checked = true; document.getElementById('split').value = 50");
    },

    async the_border_is_dragged_by_its_grip(hand) {
        await hand.begin(ROOM, {'edits/deep.txt': 'remodel-script 1\nmove north by 0.5\n'});
        await hand.photo('p2');
        await hand.page.until('app.draft.picture', 60);
        await hand.page.run("document.getElementById('split').value = 50; app.draw()");
        const [x, y] = await hand.page.run(`(() => { const r = app.view.canvas.getBoundingClientRect(), g = app.picture.grip(0.5); return [r.left + g[0], r.top + g[1]]; })()`);
        const text = await hand.text('edits/deep.txt');
        await hand.page.drag([x, y], [x + 100, y]);
        check(+await hand.page.run("document.getElementById('split').value") > 55 && await hand.text('edits/deep.txt') === text, 'the border did not follow');
    },

    async places_to_clear_are_on_the_plan(hand) {
        await hand.begin(ROOM, {'edits/e.txt': 'remodel-script 1\n'});
        await hand.drag('clear', 'p0', [project('p0', [3, 0.3, 0]), project('p0', [2, 0.8, 0])]);
        check(await hand.refusal() === '', await hand.refusal());
        const area = (await shapes(hand)).find((s) => s.kind === 'clear');
        check(near([Math.min(...area.at.map((p) => p[0])), Math.max(...area.at.map((p) => p[1]))], [2, 0.8], 0.03), JSON.stringify(area));
        check((await drawn(hand)).includes('clear'), 'the plan has no name for it');
    },

    /* Faces of one panorama are listed under its name. */
    async faces_of_a_panorama_are_listed_as_one_place(hand) {
        await hand.begin(ROOM);
        await hand.page.run("window.ids = app.photos.map((p) => p.id); ['hall_yaw060', 'hall_yaw300', 'p2', 'p3'].forEach((id, i) => { app.photos[i].id = id; }); app.listPhotos()");
        const listed = await hand.page.run("[...document.querySelectorAll('#photos > *')].map((e) => e.textContent)"), name = await hand.page.run("document.querySelector('#photos button').getAttribute('aria-label')");
        await hand.page.run('ids.forEach((id, i) => { app.photos[i].id = id; }); app.listPhotos(); app.openPhoto(0)');
        check(JSON.stringify(listed.slice(0, 6)) === JSON.stringify(['hall', '60° right', '60° left', 'Photos', 'p2', 'p3']), JSON.stringify(listed));
        check(name === 'hall_yaw060: panorama hall, 60° right', name);
        /* two that were taken from one place, by their cameras, and two that only have such names */
        await hand.page.run("app.placeOf = (i) => [[0, 0, 1], [0, 0, 1], [1, 0, 1], [2, 0, 1]][i]; ['pano_1_p000', 'pano_1_p060', 'img_2', 'img_3'].forEach((id, i) => { app.photos[i].id = id; }); app.listPhotos()");
        const placed = await hand.page.run("[...document.querySelectorAll('#photos > *')].map((e) => e.textContent)");
        await hand.page.run('delete app.placeOf; ids.forEach((id, i) => { app.photos[i].id = id; }); app.listPhotos(); app.openPhoto(0)');
        check(JSON.stringify(placed.slice(0, 6)) === JSON.stringify(['pano_1', 'p000', 'p060', 'Photos', 'img_2', 'img_3']), JSON.stringify(placed));
    },

    async everything_has_a_name_and_contrast(hand) {
        await hand.begin(ROOM, {'edits/e.txt': 'remodel-script 1\n'});
        const nameless = await hand.page.run("[...document.querySelectorAll('button, input, select, textarea, canvas')].filter((e) => !(e.textContent.trim() || e.getAttribute('aria-label') || e.closest('label') || e.title)).map((e) => e.id || e.outerHTML)");
        check(!nameless.length, `without a name: ${nameless.join(', ')}`);
        /* WCAG: 4.5 to 1 for text */
        const weak = await hand.page.run(`(() => {
            const parse = (c) => (c.match(/[\\d.]+/g) || []).map(Number), light = (c) => { const l = c.slice(0, 3).map((v) => { v /= 255; return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; }); return 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2]; };
            const behind = (e) => { for (; e; e = e.parentElement) { const c = parse(getComputedStyle(e).backgroundColor); if (c.length === 3 || c[3] > 0.99) return c; } return [255, 255, 255]; };
            return [...document.querySelectorAll('header *, #tools *, #hint, #shown *, #forms *, #notes, #meant *, #text, #numbers, #refusal, #draft-note, #photos *')].filter((e) => e.offsetParent && [...e.childNodes].some((t) => t.nodeType === 3 && t.textContent.trim()) && !e.disabled)
                .map((e) => { const a = light(parse(getComputedStyle(e).color)), b = light(behind(e)); return [(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), e.id || e.textContent.slice(0, 20)]; }).filter(([c]) => c < 4.5);
        })()`);
        check(!weak.length, JSON.stringify(weak));
    },
};

/* A reference image: a photo of the page under another name. */
const list = fs.readFileSync(`${folder}/photos.js`, 'utf8');
if (/remodel\.references = \{\};/.test(list)) {
    const small = /"p0": (\[[^\]]*\])/.exec(list)[1].replace(/^\[\d+, \d+/, '[640, 480');
    fs.writeFileSync(`${folder}/photos.js`, list.replace('remodel.references = {};', `remodel.references = {"sky": ${small}};`));
    fs.writeFileSync(`${folder}/photos/sky.js`, fs.readFileSync(`${folder}/photos/p0.js`, 'utf8').replace('"p0"', '"sky"'));
}
runTests(tests, folder, chosen);
