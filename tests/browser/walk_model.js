// node walk_model.js FOLDER - the page's scripts without a browser: rays, weights of viewpoints, pieces of textures,
// furniture, against values that follow from geometry.
'use strict';
const fs = require('fs');
const path = require('path');
const assert = require('assert');
const code = ['space.js', 'model.js'].map((f) => fs.readFileSync(path.join(process.argv[2], f), 'utf8')).join('\n');
const W = new Function(`${code}; return W;`)();
const near = (a, b, e = 1e-6) => assert(Math.abs(a - b) <= e, `${a} is not ${b}`);

// a room of 4 x 3 x 2.5 seen from inside: 6 faces whose normals point into it
const room = () => {
    const v = [], faces = [];
    for (const z of [0, 2.5])
        for (const y of [0, 3])
            for (const x of [0, 4]) v.push(x, y, z);
    const quads = [
        [[0, 1, 3, 2], [0, 0, 1], 0, 'floor'], [[4, 6, 7, 5], [0, 0, -1], -2.5, 'ceiling'],
        [[0, 4, 5, 1], [0, 1, 0], 0, 'south/in'], [[2, 3, 7, 6], [0, -1, 0], -3, 'north/in'],
        [[0, 2, 6, 4], [1, 0, 0], 0, 'west/in'], [[1, 5, 7, 3], [-1, 0, 0], -4, 'east/in']
    ];
    quads.forEach(([q, n, d, name], i) => faces.push({
        id: i + 1,
        name,
        n,
        d,
        pane: 0,
        shown: 1,
        area: 1,
        tris: [q[0], q[1], q[2], q[0], q[2], q[3]],
        rules: [{kind: 'place', from: i + 1, m: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]}]
    }));
    const model = {
        vertices: v,
        faces,
        rooms: [{name: 'hall', floor: 0, corners: [[0, 0], [4, 0], [4, 3], [0, 3]]}],
        things: [],
        zones: [],
        placed: []
    };
    W.prepareModel(model);
    return model;
};
const lookAt = (centre, heading) => W.camera(centre, heading, 0, 100, 100, Math.PI / 2);
const sceneOf = (model, centres) => {
    const views = [], places = [];
    centres.forEach((centre, i) => {
        places.push({photo: `p${i}`, centre, first: views.length, count: 4});
        for (let k = 0; k < 4; k++) views.push({...lookAt(centre, (k * Math.PI) / 2), name: `p${i}@${k}`});
    });
    return {views, places, models: [model]};
};
const tests = {
    a_ray_meets_the_wall_where_it_stands() {
        const hit = W.hit(room(), [1, 1, 1], [1, 0, 0]);
        near(hit.t, 3);
        assert.strictEqual(hit.face.name, 'east/in');
        near(W.hit(room(), [1, 1, 1], W.unit([0, -1, 1])).t, Math.SQRT2);
        assert(!W.blocked(room(), [1, 1, 1], [1, 0, 0], 2.999) && W.blocked(room(), [1, 1, 1], [1, 0, 0], 3.001));
    },
    a_point_is_drawn_where_its_pixel_is() {
        const c = {centre: [1, 2, 1.5], turn: W.turnOf(0.7, -0.2), lens: [90, 80, 47, 33], width: 100, height: 70};
        const p = W.add(c.centre, W.rayOf(c, 20, 60), 2.5), m = W.clipMatrix(c, 0.1, 10), q = [...p, 1];
        near(W.project(c, p)[0], 20);
        near(W.project(c, p)[1], 60);
        const clip = [0, 1, 2, 3].map((r) => [0, 1, 2, 3].reduce((s, k) => s + m[4 * k + r] * q[k], 0));
        near((clip[0] / clip[3] + 1) / 2, 0.2, 1e-5);
        near((1 - clip[1] / clip[3]) / 2, 60 / 70, 1e-5);
        near(clip[3], 2.5, 1e-5);
    },
    a_room_is_open_where_a_wall_is_missing_but_not_where_a_pane_is() {
        const model = room();
        assert(!W.isOpen(model, [[2, 1.5, 1.25]]));
        assert(!W.choosePair(sceneOf(model, [[1, 1, 1.5], [3, 1, 1.5]]), model, lookAt([2, 1, 1], 0), true).open);
        model.faces[5].pane = 1;
        model.faces[5].shown = 0;
        assert(!W.isOpen(model, [[2, 1.5, 1.25]]));
        const p = W.paneMesh(model, 0.01);  // the east wall, 1 cm larger on all sides
        assert.strictEqual(p.length, 18);
        for (let k = 0; k < 18; k += 3) {
            near(p[k], 4);
            near(Math.abs(p[k + 1] - 1.5), 1.51);
            near(Math.abs(p[k + 2] - 1.25), 1.26);
        }
        model.faces.splice(5, 1);
        assert(W.isOpen(model, [[2, 1.5, 1.25]]));
        assert(W.choosePair(sceneOf(model, [[1, 1, 1.5], [3, 1, 1.5]]), model, lookAt([2, 1, 1], 0), true).open);
        assert(!W.choosePair(sceneOf(model, [[1, 1, 1.5], [3, 1, 1.5]]), model, lookAt([2, 1, 1], Math.PI), true).open);
    },
    in_a_viewpoint_it_has_all_the_weight() {
        const model = room(), scene = sceneOf(model, [[1, 1, 1.5], [3, 1, 1.5], [2, 2.5, 1.5]]);
        const pair = W.choosePair(scene, model, lookAt([3, 1, 1.5], Math.PI / 2), true);
        assert.strictEqual(pair.places[0], 1);
        near(pair.t, 0);
    },
    halfway_between_two_they_share() {
        const model = room(), scene = sceneOf(model, [[1, 1.5, 1.25], [3, 1.5, 1.25], [0.2, 0.2, 0.3]]);
        const pair =
            W.choosePair(scene, model, lookAt([2, 1.5, 1.25], Math.PI / 2), true);  // both see the same, mirrored
        assert.deepStrictEqual([...pair.places].sort(), [0, 1]);
        near(pair.t, 0.5, 1e-9);
    },
    weights_change_without_a_jump() {
        const model = room(), scene = sceneOf(model, [[1, 1, 1.5], [3, 1, 1.5], [2, 2.5, 1.5], [0.5, 2.5, 1.5]]);
        let last = null;
        for (let x = 0.6; x < 3.6; x += 0.01) {
            const pair = W.choosePair(scene, model, lookAt([x, 1.3, 1.5], 1), true), shares = scene.places.map(() => 0);
            pair.places.forEach((i, k) => {
                if (i >= 0) shares[i] += k ? pair.t : 1 - pair.t;
            });
            if (last)
                shares.forEach(
                    (s, i) =>
                        assert(Math.abs(s - last[i]) < 0.12, `the share of ${i} jumps at ${x}: ${last[i]} to ${s}`));
            last = shares;
        }
    },
    a_view_behind_a_wall_draws_no_furniture() {
        const model = room(), scene = sceneOf(model, [[1, 1.5, 1.25], [6, 1.5, 1.25]]);
        const camera = lookAt([2, 1.5, 1.25], Math.PI),
              chosen = W.chooseClutter(scene, camera, W.clutterPlaces(model, camera, true), 12);
        assert(chosen.length > 0 && chosen.every(([i]) => i < 4));
        assert(chosen.every(([, fade]) => fade > 0 && fade <= 1));
    },
    pieces_cover_a_face_once() {
        const model = room();  // the floor in two tiles of 2 x 3 m, 100 texels a metre, cut at x = 2
        const atlas = {
            pages: [[512, 512]],
            tiles: [
                [1, 0, 0, 0, 200, 300, [100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 0, 1]],
                [1, 0, 200, 0, 200, 300, [100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 0, 1]]
            ]
        };
        const {data, draws} = W.atlasMesh(model, atlas, true);
        let area = 0;
        for (let k = 0; k < data.length; k += 30) {
            const p = [0, 10, 20].map((c) => [...data.subarray(k + c, k + c + 3)]);
            area += W.length(W.cross(W.add(p[1], p[0], -1), W.add(p[2], p[0], -1))) / 2;
            for (const c of [0, 10, 20])
                near(data[k + c + 3], 100 * data[k + c], 1e-3);  // the place in the page is that of the point
        }
        near(area, 12, 1e-4);
        assert.strictEqual(draws.length, 1);
    },
    limits_of_a_rule_cut_it() {
        const model = room();
        model.faces[0].rules[0].within = [1, 1, 0, 3, 1, 0, 3, 2, 0, 1, 2, 0];
        const area = W.limited(model.faces[0], model.faces[0].rules[0]).reduce((s, p) => {
            for (let k = 1; k + 1 < p.length; k++)
                s += W.length(W.cross(W.add(p[k], p[0], -1), W.add(p[k + 1], p[0], -1))) / 2;
            return s;
        }, 0);
        near(area, 2, 1e-4);
    },
    furniture_stands_at_its_depth_and_goes_with_its_edit() {
        const model = room(), scene = {...sceneOf(model, [[0.5, 1.5, 1.25]]), grid: 50}, view = scene.views[0];
        const bytes = new Uint8Array(36);  // 3 x 3 points at 1 / z = 0.5, thing 1, slack 0.03
        for (let k = 0; k < 9; k++) {
            bytes[k] = bytes[9 + k] = 255;
            bytes[18 + k] = 1;
            bytes[27 + k] = 255;
        }
        const grid = W.clutterGrid(scene, view, {columns: 3, rows: 3, most: 0.5}, bytes);
        for (let k = 0; k < 9; k++) near(grid.points[6 * k], 2.5, 1e-5);
        near(grid.points[5], 1.03, 1e-5);
        assert.strictEqual(grid.cells.length, 1);  // one square of two cells each way: it is flat
        model.things = ['stays'];
        assert.strictEqual(W.clutterCells(model, grid, 0).length, 6);
        model.things = ['gone'];
        assert.strictEqual(W.clutterCells(model, grid, 0).length, 0);
        assert.strictEqual(W.clutterCells(model, grid, 1).length, 6);
        model.things = ['stays'];
        model.zones = [{keep: 0, low: -9, high: 2.5, corners: [2, -9, 4, -9, 4, 9, 2, 9]}];
        assert.strictEqual(W.clutterCells(model, grid, 0).length, 12);  // its upper half is above the zone
        model.zones[0] = {keep: 0, low: -9, high: 9, corners: [2, -9, 4, -9, 4, 2, 2, 2]};  // the right half
        assert.strictEqual(W.clutterCells(model, grid, 0).length, 18);  // one of four cells is cleared: what is near the ceiling stays
        model.things = ['kept'];
        assert.strictEqual(W.clutterCells(model, grid, 0).length, 6);
    },
    squares_cover_a_surface_once_without_cracks() {
        const columns = 21, rows = 17, inverse = new Float32Array(columns * rows), things = new Uint8Array(columns * rows);
        for (let k = 0; k < columns * rows; k++) {  // a plane, and a nearer one on the right with a hole
            const i = k % columns, j = Math.floor(k / columns);
            inverse[k] = i < 11 ? 0.2 + 0.002 * i + 0.001 * j : i === 15 && j === 6 ? 0 : 0.5;
        }
        const covered = new Uint8Array(columns * rows), edges = new Map();
        const blocks = W.clutterBlocks(inverse, things, columns, rows, 0.08);
        for (const [, k, n, share, around] of blocks) {
            assert(share >= 0 && share < 1);
            for (let j = 0; j < n; j++)
                for (let i = 0; i < n; i++) covered[k + j * columns + i]++;
            around.forEach((a, i) => edges.set(`${a} ${around[(i + 1) % around.length]}`, true));
        }
        for (let j = 0; j + 1 < rows; j++)
            for (let i = 0; i + 1 < columns; i++) {
                const hole = (i === 14 || i === 15) && (j === 5 || j === 6);
                assert.strictEqual(covered[j * columns + i], i === 10 || hole ? 0 : 1, `cell ${i} ${j}`);
            }
        assert(blocks.some((b) => b[2] === 4) && blocks.length < 140);
        for (const e of edges.keys()) {  // each edge is its neighbour's too, or has a gap or the border beside it
            const [a, b] = e.split(' ').map(Number);
            if (edges.has(`${b} ${a}`)) continue;
            const [x, y] = [a, b].map((k) => [k % columns, Math.floor(k / columns)]), [dx, dy] = [y[0] - x[0], y[1] - x[1]];
            // outside is to the right of the way, seen with rows going down
            const i = dy > 0 ? x[0] - 1 : dy < 0 ? x[0] : Math.min(x[0], y[0]),
                  j = dx > 0 ? x[1] : dx < 0 ? x[1] - 1 : Math.min(x[1], y[1]);
            const free = i < 0 || j < 0 || i + 1 >= columns || j + 1 >= rows || !covered[j * columns + i];
            assert(free, `the edge ${x} to ${y} has no partner`);
        }
    },
    what_a_view_sees_is_unpacked() {
        const levels = [1, 1025, 2049, 0], bytes = new Uint8Array(16);  // 8, 4, 0 factors of e below 2; nothing
        let before = 0;
        levels.forEach((x, k) => {
            bytes[k] = (x - before) & 255;
            bytes[4 + k] = ((x - before) >> 8) & 255;
            bytes[8 + k] = 51;
            bytes[12 + k] = 255;
            before = x;
        });
        const t = W.clutterSight({columns: 4, rows: 1, seen: 2}, bytes);
        [2 * Math.exp(-8), 2 * Math.exp(-4), 2, 0].forEach((x, k) => near(t[4 * k], x, 1e-6));
        near(t[1], 0.2);
        near(t[2], 1);
    },
    furniture_takes_the_change_of_light_of_the_faces_around_it() {
        const model = room(), size = [4, 3, 2.5], data = new Uint8Array(4 * 60 * 10);
        const tiles = model.faces.map((f, k) => {  // 10 x 10 texels each
            const [i, j] = f.axes, row = (a, x) => [0, 1, 2].map((c) => (c === a ? 10 / size[a] : 0)).concat(x);
            return [f.id, 0, 10 * k, 0, 10, 10, [...row(i, 10 * k), ...row(j, 0), 0, 0, 0, 1]];
        });
        const fill = (face, byte) => {
            for (let y = 0; y < 10; y++)
                for (let x = 0; x < 10; x++) data.set([byte, byte, byte, 255], 4 * (60 * y + 10 * face + x));
        };
        const light = {atlas: {tiles}, most: 4}, pages = [{width: 60, height: 10, data}];
        const half = Math.round(255 * (1 / 8) ** (1 / 2.2));  // the byte of a factor of 1 / 2
        for (let k = 0; k < 6; k++) fill(k, half);
        const even = W.lightVolume(model, light, pages), count = even.texels.length / 4;
        assert.deepStrictEqual(even.size, [20, 15, 13]);
        for (let k = 0; k < count; k++) near(even.texels[4 * k], 0.5, 0.01);
        fill(0, 255);  // four times as much from the floor
        const lower = W.lightVolume(model, light, pages).texels, column = 20 * 7 + 10, level = 20 * 15;
        for (let z = 0; z < 13; z++) assert(lower[4 * (column + z * level)] > 0.5 && lower[4 * (column + z * level)] < 4);
        assert(lower[4 * column] > lower[4 * (column + 12 * level)]);  // more beside the floor than below the ceiling
    },
    from_above_ceilings_are_off() {
        const inside = room().faces.filter((f) => W.isInside(room(), f)).map((f) => f.name);
        assert(!inside.includes('ceiling') && inside.includes('floor') && inside.includes('north/in'));
    },
};
let failed = 0;
for (const name in tests) {
    try {
        tests[name]();
        console.log(`ok ${name}`);
    } catch (e) {
        failed++;
        console.log(`not ok ${name}: ${e.message}`);
    }
}
process.exit(failed ? 1 : 0);
