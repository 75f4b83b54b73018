// model.js - what the rooms are: rays, which photographs show a place best, and meshes for WebGL.
'use strict';

// --- rays

W.prepareModel = (model) => {
    const v = model.vertices;
    model.point = (i) => [v[3 * i], v[3 * i + 1], v[3 * i + 2]];
    model.low = [Infinity, Infinity, Infinity];
    model.high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < v.length; i++) {
        model.low[i % 3] = Math.min(model.low[i % 3], v[i]);
        model.high[i % 3] = Math.max(model.high[i % 3], v[i]);
    }
    for (const f of model.faces) {
        const n = f.n.map(Math.abs), drop = n[0] > n[1] && n[0] > n[2] ? 0 : n[1] > n[2] ? 1 : 2;
        f.axes = [0, 1, 2].filter((k) => k !== drop);
        f.corners = f.tris.map(model.point);
        f.flat = [];
        for (let k = 0; k < f.corners.length; k += 3) {
            const t = [0, 1, 2].map((c) => f.axes.map((a) => f.corners[k + c][a]));
            f.flat.push(t[0][0], t[0][1], t[1][0] - t[0][0], t[1][1] - t[0][1], t[2][0] - t[0][0], t[2][1] - t[0][1]);
        }
        f.box = [0, 1].map((k) => {
            const x = f.corners.map((p) => p[f.axes[k]]);
            return [Math.min(...x), Math.max(...x)];
        });
    }
};

// Whether a face has the point of its plane with coordinates a, b along its axes.
W.faceHas = (f, a, b) => {
    const g = 1e-9;
    if (a < f.box[0][0] - g || a > f.box[0][1] + g || b < f.box[1][0] - g || b > f.box[1][1] + g) return false;
    for (let k = 0; k < f.flat.length; k += 6) {
        const x = a - f.flat[k], y = b - f.flat[k + 1];
        const ux = f.flat[k + 2], uy = f.flat[k + 3], vx = f.flat[k + 4], vy = f.flat[k + 5], d = ux * vy - uy * vx;
        const s = (x * vy - y * vx) / d, t = (ux * y - uy * x) / d;
        if (s >= -g && t >= -g && s + t <= 1 + g) return true;
    }
    return false;
};

// The first face on a ray: {t, face, point}, or null. glass: whether panes count.
W.hit = (model, from, along, most = Infinity, glass = true) => {
    let best = null, least = most;
    for (const f of model.faces) {
        const slope = W.dot(f.n, along);
        if (slope === 0 || (f.pane && !glass)) continue;
        const t = (f.d - W.dot(f.n, from)) / slope;
        if (!(t > 1e-6 && t < least)) continue;
        const [i, j] = f.axes;
        if (!W.faceHas(f, from[i] + t * along[i], from[j] + t * along[j])) continue;
        least = t;
        best = f;
    }
    return best && {t: least, face: best, point: W.add(from, along, least)};
};
W.blocked = (model, from, along, most, glass = true) => {
    for (const f of model.faces) {
        const slope = W.dot(f.n, along);
        if (slope === 0 || (f.pane && !glass)) continue;
        const t = (f.d - W.dot(f.n, from)) / slope;
        if (!(t > 1e-6 && t < most)) continue;
        const [i, j] = f.axes;
        if (W.faceHas(f, from[i] + t * along[i], from[j] + t * along[j])) return true;
    }
    return false;
};

// --- which photographs show a place best: as choose_pair.c and clutter_choose.c of render_model

W.samples = (model, camera, columns, rows) => {
    const list = [];
    for (let j = 0; j < rows; j++)
        for (let i = 0; i < columns; i++) {
            const ray = W.rayOf(camera, ((i + 0.5) * camera.width) / columns, ((j + 0.5) * camera.height) / rows);
            const hit = W.hit(model, camera.centre, W.unit(ray));
            if (hit) list.push({point: hit.point, away: hit.t});
        }
    return list;
};

// Whether a view of the viewpoint shows the point in the unedited model.
W.sees = (scene, place, point) => {
    for (let i = place.first; i < place.first + place.count; i++) {
        const view = scene.views[i], [x, y, z] = W.project(view, point);
        if (!(z > 0) || x < 0 || y < 0 || x >= view.width || y >= view.height) continue;
        return !W.blocked(scene.models[0], place.centre, W.add(point, place.centre, -1), 1 - 1e-4);
    }
    return false;
};

// Two viewpoints and the share of the second one [Buehler 2001]; -1: none. fine: as many rays as render_model.
W.choosePair = (scene, model, camera, fine) => {
    const samples = W.samples(model, camera, fine ? 16 : 8, fine ? 12 : 6);
    const unseen = Math.PI / 2, best = [];
    for (let i = 0; i < scene.places.length; i++) {
        const place = scene.places[i];
        let sum = 0, seen = 0;
        for (const s of samples) {
            if (!W.sees(scene, place, s.point)) {
                sum += unseen;
                continue;
            }
            const a = W.add(camera.centre, s.point, -1), b = W.add(place.centre, s.point, -1);
            const angle = Math.atan2(W.length(W.cross(a, b)), W.dot(a, b));
            sum += Math.min(unseen, angle + 0.2 * Math.max(0, W.length(b) / s.away - 1));
            seen++;
        }
        if (seen) best.push([sum / samples.length, i]);
    }
    best.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const open = samples.length < (fine ? 192 : 48);  // rays that leave the rooms
    if (best.length < 2) return {places: [best.length ? best[0][1] : -1, -1], t: 0, open};
    const last = best.length > 2 ? best[2][0] : unseen;
    const weights = [0, 1].map((k) => Math.max(0, 1 - best[k][0] / last) / Math.max(best[k][0], 1e-9));
    const all = weights[0] + weights[1];
    return {places: [best[0][1], best[1][1]], t: all > 0 ? weights[1] / all : 0, open};
};

// Places where furniture may be seen: on what the camera sees, and half way to it.
W.clutterPlaces = (model, camera, fine) =>
    W.samples(model, camera, fine ? 16 : 8, fine ? 12 : 6)
        .flatMap((s) => [0.5, 1].map((part) => W.add(W.scale(camera.centre, 1 - part), s.point, part)));

// The views that furniture is drawn from: [[view, fade], ...], best first. fade falls to 0 as a view leaves the choice.
W.chooseClutter = (scene, camera, places, most) => {
    const scores = new Float64Array(scene.views.length);
    for (const point of places) {
        const weights = [];
        let sum = 0;
        scene.views.forEach((view, i) => {
            const [x, y, z] = W.project(view, point);
            if (!(z > 0) || x < 0 || y < 0 || x >= view.width || y >= view.height) return;
            const a = W.add(camera.centre, point, -1), b = W.add(view.centre, point, -1);
            if (W.blocked(scene.models[0], view.centre, W.scale(b, -1), 0.98, false)) return;
            const la = W.length(a), lb = W.length(b);
            const chord = W.length(W.add(W.scale(a, 1 / la), b, -1 / lb)) + 0.1 * Math.max(0, lb / la - 1);
            weights.push([i, 1 / (0.005 + chord * chord) ** 2]);
            sum += weights[weights.length - 1][1];
        });
        for (const [i, w] of weights) scores[i] += w / sum;
    }
    const order = [...scores.keys()].filter((i) => scores[i] > 0).sort((a, b) => scores[b] - scores[a]);
    const next = order.length > most ? scores[order[most]] : 0;
    return order.slice(0, most).map((i) => [i, Math.min(1, 3 * (1 - next / scores[i]))]).filter((c) => c[1] > 0);
};

// --- meshes

// Triangles of the parts of polygons, each corner: x y z, place in the page (u v w), four numbers more.
class Pieces {
    constructor() {
        this.groups = new Map();  // "rule page kind": numbers
    }
    add(rule, kind, page, polygon, more) {
        const key = `${rule} ${kind} ${page}`;
        if (!this.groups.has(key)) this.groups.set(key, []);
        const to = this.groups.get(key);
        for (let i = 1; i + 1 < polygon.length; i++)
            for (const c of [polygon[0], polygon[i], polygon[i + 1]]) to.push(...c, ...more);
    }
    // {data, draws: [{rule, kind, page, first, count}]}
    pack() {
        const draws = [], parts = [];
        let first = 0;
        for (const [key, numbers] of this.groups) {
            const [rule, kind, page] = key.split(' ');
            draws.push({rule: +rule, kind, page: +page, first, count: numbers.length / 10});
            first += numbers.length / 10;
            parts.push(numbers);
        }
        const data = new Float32Array(10 * first);
        let at = 0;
        for (const numbers of parts) {
            data.set(numbers, at);
            at += numbers.length;
        }
        return {data, draws};
    }
}

const seesPlane = (m, normal) => Math.abs(W.dot(W.unit(W.cross(m.slice(0, 3), m.slice(4, 7))), normal)) > 0.999;

// The triangles of a face, limited to the quadrilateral of a rule.
W.limited = (face, rule) => {
    const polygons = [];
    for (let k = 0; k < face.corners.length; k += 3) polygons.push(face.corners.slice(k, k + 3));
    if (!rule.within) return polygons;
    const q = [0, 3, 6, 9].map((k) => rule.within.slice(k, k + 3));
    const area = W.cross(W.add(q[2], q[0], -1), W.add(q[3], q[1], -1)), turn = W.dot(area, face.n) < 0 ? -1 : 1;
    return polygons.map((p) => {
        for (let k = 0; k < 4; k++) {
            const left = W.scale(W.unit(W.cross(face.n, W.add(q[(k + 1) % 4], q[k], -1))), turn),
                  off = W.dot(left, q[k]);
            p = W.clip(p, (c) => W.dot(left, c) - off + 1e-6);
        }
        return p;
    });
};

// Whether a face bounds a room from inside, so that a look from above needs it.
W.isInside = (model, face) => {
    if (face.n[2] < -0.5) return false;  // ceilings
    if (face.n[2] > 0.5) return face.corners[0][2] < model.low[2] + 0.8 * (model.high[2] - model.low[2]);
    const n = face.corners.length, middle = face.corners.reduce((s, p) => W.add(s, p, 1 / n), [0, 0, 0]);
    const before = W.add(middle, face.n, 0.02 * (model.high[2] - model.low[2]));
    return !model.rooms.length || model.rooms.some((r) => W.insidePolygon(r.corners.flat(), before[0], before[1])) ||
        !/\/(out|in)$/.test(face.name);
};

// The mesh of a model under an atlas. wanted(face): which faces. free: an atlas of no viewpoint, whose tiles look
// straight at their faces; it also gives the colours and the nearest texels of rules.
W.atlasMesh = (model, atlas, free, wanted = () => true) => {
    const pieces = new Pieces(), tiles = new Map();
    for (const t of atlas.tiles) {
        if (!tiles.has(t[0])) tiles.set(t[0], []);
        tiles.get(t[0]).push({page: t[1], rect: [t[2], t[3], t[2] + t[4], t[3] + t[5]], m: t[6]});
    }
    for (const face of model.faces) {
        if (!face.shown || !wanted(face)) continue;
        face.rules.forEach((rule, r) => {
            if (rule.kind === 'outdoors') return;
            for (const polygon of W.limited(face, rule)) {
                if (polygon.length < 3) continue;
                if (rule.kind === 'colour') {
                    if (free)
                        pieces.add(r, 'colour', 0, polygon.map((p) => [...p, 0, 0, 1]), [...W.squared(rule.rgb), 1]);
                    continue;
                }
                if (rule.kind === 'edge' && !free) continue;
                let nearest = null, least = Infinity;
                for (const tile of tiles.get(rule.from) || []) {
                    const m = W.after(tile.m, rule.m), [x0, y0, x1, y1] = tile.rect;
                    if (free && !seesPlane(m, face.n)) continue;
                    let part = polygon.map((p) => [...p, ...W.place(m, p)]);
                    if (rule.kind === 'edge') {
                        const c = part.reduce((s, p) => W.add(s, p.slice(3), 1 / part.length), [0, 0, 0]);
                        const off = Math.hypot(Math.max(x0 - c[0], 0, c[0] - x1), Math.max(y0 - c[1], 0, c[1] - y1));
                        if (off < least) {
                            least = off;
                            nearest = [tile, part];
                        }
                        continue;
                    }
                    part = W.clip(part, (p) => p[5] - 1e-6);
                    part = W.clip(part, (p) => p[3] - x0 * p[5]);
                    part = W.clip(part, (p) => x1 * p[5] - p[3]);
                    part = W.clip(part, (p) => p[4] - y0 * p[5]);
                    part = W.clip(part, (p) => y1 * p[5] - p[4]);
                    if (part.length > 2) pieces.add(r, 'place', tile.page, part, tile.rect);
                }
                if (nearest) pieces.add(r, 'edge', nearest[0].page, nearest[1], nearest[0].rect);
            }
        });
    }
    return pieces.pack();
};

// All faces that are seen: x y z
W.solidMesh = (model, wanted = () => true) =>
    new Float32Array(model.faces.filter((f) => f.shown && wanted(f)).flatMap((f) => f.corners.flat()));

// Panes that are looked through, a little larger than they are so that no border stays free: x y z
W.paneMesh = (model, more) =>
    new Float32Array(model.faces.filter((f) => f.pane && !f.shown).flatMap((f) => f.corners.flatMap((p) => {
        const q = [...p];
        f.axes.forEach((a, k) => {
            const [low, high] = f.box[k];
            q[a] += more * ((2 * p[a] - low - high) / (high - low || 1));
        });
        return q;
    })));

// Whether one looks out of the rooms elsewhere than through a pane, as far as some hundred rays from places tell.
W.isOpen = (model, places) => {
    for (const from of places)
        for (let k = 0; k < 150; k++) {
            const z = (2 * k + 1) / 150 - 1, r = Math.sqrt(1 - z * z), a = 2.39996 * k;
            if (!W.hit(model, from, [r * Math.cos(a), r * Math.sin(a), z])) return true;
        }
    return false;
};

// A view's furniture: {points: x y z u v of the grid and slack, 1 more in a thing that was found, columns, cells}
W.clutterGrid = (scene, view, grid, bytes) => {
    const {columns, rows, most} = grid, count = columns * rows, step = scene.grid, [fx, fy, cx, cy] = view.lens;
    const points = new Float32Array(6 * count), inverse = new Float32Array(count), things = bytes.subarray(2 * count);
    for (let k = 0; k < count; k++) {
        inverse[k] = ((bytes[k] + 256 * bytes[count + k]) / 65535) * most;
        if (!inverse[k]) continue;
        const u = (k % columns) * step, v = Math.floor(k / columns) * step, z = 1 / inverse[k];
        const p = W.add(W.turnBack(view.turn, [((u - cx) / fx) * z, ((v - cy) / fy) * z, z]), view.centre);
        points.set([...p, u / view.width, v / view.height, (0.03 / 255) * bytes[3 * count + k] + (things[k] ? 1 : 0)], 6 * k);
    }
    return {points, columns, cells: W.clutterBlocks(inverse, things, columns, rows, (STEEPEST * step) / fx)};
};

// How steep a surface may be towards the view that shows it, as a slope. What is steeper joins the edge of a thing with
// what is behind it, and would be a rag when it is seen from elsewhere.
const STEEPEST = 8, STEEPEST_FROM_ABOVE = 5;

// Squares of a grid that lie on one surface, which changes by less than the share `steep` from one point to the next:
// [thing, first point, side in cells, share of `steep`, points around], as large as their surface is flat there, which a
// plane is in 1 / z. Points of smaller neighbours are among those around a square, so that no crack opens between them.
W.clutterBlocks = (inverse, things, columns, rows, steep) => {
    const taken = new Uint8Array(columns * rows), used = new Uint8Array(columns * rows), blocks = [];
    const isFlat = (k, n) => {
        const d = (i, j) => inverse[k + j * columns + i], least = 0.02 * d(0, 0);
        for (let j = 0; j <= n; j++)
            for (let i = 0; i <= n; i++) {
                const s = i / n, t = j / n;
                const flat = (1 - t) * ((1 - s) * d(0, 0) + s * d(n, 0)) + t * ((1 - s) * d(0, n) + s * d(n, n));
                if (!(d(i, j) > 0 && Math.abs(d(i, j) - flat) < least)) return false;
            }
        return true;
    };
    for (const n of [4, 2, 1])
        for (let j = 0; j + n < rows; j += n)
            for (let i = 0; i + n < columns; i += n) {
                const k = j * columns + i, corners = [k, k + n * columns, k + n * (columns + 1), k + n];
                if (taken[k]) continue;
                if (n > 1) {
                    if (!isFlat(k, n)) continue;
                } else {
                    const low = Math.min(...corners.map((c) => inverse[c]));
                    if (!(low > 0 && Math.max(...corners.map((c) => inverse[c])) < (1 + steep) * low)) continue;
                }
                for (let y = 0; y < n; y++) taken.fill(1, k + y * columns, k + y * columns + n);
                corners.forEach((c) => (used[c] = 1));
                const d = corners.map((c) => inverse[c]), share = (Math.max(...d) / Math.min(...d) - 1) / (n * steep);
                blocks.push([corners.map((c) => things[c]).find((x) => x) || 0, k, n, share]);
            }
    for (const block of blocks) {
        const [, k, n] = block, around = [];
        for (const [from, by] of [
                 [k, columns], [k + n * columns, 1], [k + n * (columns + 1), -columns], [k + n, -1]
             ])
            for (let i = 0; i < n; i++)
                if (used[from + i * by]) around.push(from + i * by);
        block.push(around);
    }
    return blocks;
};

// What a view sees at the points of its grid, as texels: 1 / z of the nearest surface, confidence, share of furniture.
W.clutterSight = (grid, bytes) => {
    const {columns, rows, seen} = grid, count = columns * rows, texels = new Float32Array(4 * count);
    for (let j = 0; j < rows; j++)
        for (let i = 0, level = 0; i < columns; i++) {
            const k = j * columns + i;
            level = (level + bytes[k] + 256 * bytes[count + k]) & 65535;
            texels[4 * k] = level ? seen * Math.exp((level - 1) / 256 - 8) : 0;
            texels[4 * k + 1] = bytes[2 * count + k] / 255;
            texels[4 * k + 2] = bytes[3 * count + k] / 255;
        }
    return texels;
};

// The cells that a model shows where the photographs have them (thing 0), or those of one thing: corners of triangles.
// below: only those below this part of the height; 0: all.
W.clutterCells = (model, grid, thing, below) => {
    const limit = below ? model.low[2] + below * (model.high[2] - model.low[2]) : Infinity;
    const list = [], ceiling = model.low[2] + 0.85 * (model.high[2] - model.low[2]);
    const cleared = (p) => {
        let gone = false;
        for (const z of model.zones) {
            if (p[2] < z.low || p[2] > z.high || !W.insidePolygon(z.corners, p[0], p[1])) continue;
            if (z.keep) return false;
            gone = true;
        }
        return gone;
    };
    const shown = (id, k) => {
        const p = grid.points.subarray(6 * k, 6 * k + 3);
        if (p[2] > limit) return false;
        if (thing) return id === thing;
        const fate = id ? model.things[id - 1] : 'stays';
        return fate !== 'gone' && !(fate === 'stays' && model.zones.length && p[2] <= ceiling && cleared(p));
    };
    const {columns} = grid;
    for (const [id, k, n, share, around] of grid.cells) {
        if (below && share * STEEPEST > STEEPEST_FROM_ABOVE) continue;
        const all = [k, k + n, k + n * columns, k + n * (columns + 1)].map((c) => shown(id, c));
        if (n === 1 ? all[0] : all.every((x) => x)) {
            for (let i = 1; i + 1 < around.length; i++) list.push(around[0], around[i], around[i + 1]);
        } else if (all.some((x) => x))  // a part of it
            for (let j = 0; j < n; j++)
                for (let i = 0; i < n; i++) {
                    const c = k + j * columns + i;
                    if (shown(id, c)) list.push(c, c + columns, c + 1, c + 1, c + columns, c + columns + 1);
                }
    }
    return new Uint32Array(list);
};

// How an edit changes the light in the space of the rooms, for furniture, whose own change nobody computed: at each
// point of a lattice the mean of the factors of the faces around it. {size, low, high, texels}
W.lightVolume = (model, light, pages) => {
    const {low, high} = model, way = W.add(high, low, -1), most = Math.max(...way), ways = [];
    const size = way.map((x) => Math.max(2, Math.round((20 * x) / most)));
    const texels = new Float32Array(4 * size[0] * size[1] * size[2]);
    for (let x = -1; x <= 1; x++)
        for (let y = -1; y <= 1; y++)
            for (let z = -1; z <= 1; z++)
                if ((x || y || z) && Math.abs(x) + Math.abs(y) + Math.abs(z) !== 2) ways.push(W.unit([x, y, z]));
    const tiles = new Map();
    for (const t of light.atlas.tiles) {
        if (!tiles.has(t[0])) tiles.set(t[0], []);
        tiles.get(t[0]).push(t);
    }
    const factor = (face, point) => {
        for (const [, page, x, y, w, h, m] of tiles.get(face.id) || []) {
            if (!seesPlane(m, face.n)) continue;
            const [u, v, d] = W.place(m, point), i = Math.floor(u / d), j = Math.floor(v / d);
            const {data, width} = pages[page];
            if (!(d > 0) || i < x || j < y || i >= x + w || j >= y + h) continue;
            const k = 4 * (j * width + i);
            return data[k + 3] ? [0, 1, 2].map((c) => light.most * (data[k + c] / 255) ** 2.2) : null;
        }
        return null;
    };
    for (let k = 0, at = 0; k < size[2]; k++)
        for (let j = 0; j < size[1]; j++)
            for (let i = 0; i < size[0]; i++, at += 4) {
                const p = [i, j, k].map((n, c) => low[c] + ((n + 0.5) / size[c]) * way[c]);
                let sum = [0, 0, 0], count = 0;
                for (const along of ways) {
                    const hit = W.hit(model, p, along, Infinity, false);
                    if (!hit || W.dot(hit.face.n, along) > 0) continue;  // from behind: outside of the rooms
                    const f = factor(hit.face, hit.point);
                    if (!f) continue;
                    sum = W.add(sum, f);
                    count++;
                }
                if (count) texels.set([...W.scale(sum, 1 / count), 1], at);
            }
    // inside walls, and outside of the rooms, as beside them
    const steps = [1, size[0], size[0] * size[1]];
    const known = (k) => k >= 0 && 4 * k < texels.length && texels[4 * k + 3] > 0;
    for (let empty = true, round = 0; empty && round < 30; round++) {
        empty = false;
        const found = [];
        for (let k = 0; 4 * k < texels.length; k++) {
            if (known(k)) continue;
            empty = true;
            const beside = steps.flatMap((s) => [k - s, k + s]).filter(known);
            if (beside.length)
                found.push([k, [0, 1, 2].map((c) => beside.reduce((s, b) => s + texels[4 * b + c], 0) / beside.length)]);
        }
        for (const [k, rgb] of found) texels.set([...rgb, 1], 4 * k);
    }
    return {size, low, high, texels};
};
