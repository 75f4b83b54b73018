// walk.js - the page: where one stands and looks, what is loaded for it, and what buttons, keys and fingers do.
'use strict';

const $ = (id) => document.getElementById(id);
const FIELD = 1.31, MOST_BYTES = 400e6, CLUTTER_VIEWS = 12, MOVING_VIEWS = 5;

W.say = (text, bad) => {
    $('told').textContent = text || '';
    $('told').classList.toggle('bad', !!bad);
};

const S = {
    // what is shown
    edit: 0,
    compare: false,
    split: 0.5,
    light: false,
    made: false,
    above: null,
    measure: null,
    tour: null,
    move: null,
    eye: {centre: [0, 0, 0], heading: 0, up: 0},
    field: FIELD,
    keys: new Set(),
    dirty: true,
    moved: 0,
    details: false,
};
let scene, painter, plan, pictures = new Set(), kinds, relitKinds;
const places = [];  // of each photograph: {texture, photo, used, meshes}
const models = [];  // of each model: {solid, vita, above, light, objects, cells}
const vita = {
    pages: []
};
let outdoors = null;

// --- what is loaded

const touch = () => {
    S.dirty = true;
};
const loadPages = async (name) => {
    const list = await W.load(name);
    W.forget(name);
    return list && Promise.all(list.map(async (text) => painter.texture(await W.picture(text))));
};
const bytesOf = (place) => [...(place.texture || []), ...(place.photo || []).map((v) => v.texture)].reduce(
    (s, t) => s + (t ? t.bytes : 0), 0);

// Lets go what was not used for longest, until the rest fits.
const makeRoom = () => {
    let all = places.reduce((s, p) => s + bytesOf(p), 0);
    for (const p of [...places].sort((a, b) => a.used - b.used)) {
        if (all < MOST_BYTES || p.used >= S.frame - 2) return;
        all -= bytesOf(p);
        (p.texture || []).forEach((t) => painter.drop(t));
        (p.photo || []).forEach((v) => {
            painter.drop(v.texture);
            painter.dropBuffer(v.buffer);
        });
        Object.assign(p, {texture: null, photo: null, asked: {}, cells: {}});
    }
};
// The textures of a viewpoint, or null while they are on their way.
const textureOf = (i) => {
    const p = places[i];
    p.used = S.frame;
    if (!p.asked.texture) {
        p.asked.texture = loadPages(`texture-${scene.places[i].photo}`).then((t) => {
            p.texture = t;
            makeRoom();
            touch();
        });
    }
    return p.texture;
};
const photoOf = (i) => {
    const p = places[i], place = scene.places[i];
    p.used = S.frame;
    if (!p.asked.photo) {
        const name = `photo-${place.photo}`;
        p.asked.photo = W.load(name).then(async (list) => {
            W.forget(name);
            if (!list) return;
            p.photo = await Promise.all(list.map(async (v, k) => {
                const made = {texture: painter.texture(await W.picture(v.picture)), view: scene.views[place.first + k]};
                if (v.depth && v.most > 0) made.grid = W.clutterGrid(scene, made.view, v, await W.unpack(v.depth));
                return made;
            }));
            makeRoom();
            touch();
        });
    }
    return p.photo;
};
// Pictures of an edit from a viewpoint; undefined: there are none, null: not here yet.
const changesOf = (name, i) => {
    const file = `${name}-${scene.places[i].photo}`, p = places[i];
    if (!pictures.has(file)) return undefined;
    if (!(file in p.changes)) {
        p.changes[file] = null;
        W.load(file).then(async (list) => {
            W.forget(file);
            p.changes[file] =
                list && await Promise.all(list.map(async (t) => t && painter.texture(await W.picture(t))));
            touch();
        });
    }
    return p.changes[file];
};
const meshOf = (i, m) => {
    const p = places[i];
    if (!p.meshes[m]) {
        const {data, draws} = W.atlasMesh(scene.models[m], scene.places[i].atlas, false);
        p.meshes[m] = {buffer: painter.buffer(data, [[0, 3], [1, 3], [2, 4]]), draws};
    }
    return {...p.meshes[m], pages: p.texture};
};
const freeMesh = (model, atlas, wanted) => {
    const {data, draws} = W.atlasMesh(model, atlas, true, wanted);
    return {buffer: painter.buffer(data, [[0, 3], [1, 3], [2, 4]]), draws};
};
const modelOf = (m) => {
    if (models[m]) return models[m];
    const model = scene.models[m], inside = (f) => W.isInside(model, f);
    W.prepareModel(model);
    models[m] = {
        rules: Math.max(1, ...model.faces.map((f) => f.rules.length)),
        solid: painter.buffer(W.solidMesh(model), [[0, 3]]),
        vita: freeMesh(model, scene.vita),
        aboveSolid: () => painter.buffer(W.solidMesh(model, inside), [[0, 3]]),
        aboveVita: () => freeMesh(model, scene.vita, inside),
        objects: model.objects.map(
            (o) => ({albedo: W.squared(o.rgb), buffer: painter.buffer(new Float32Array(o.corners), [[0, 3], [1, 3]])})),
        pair: {places: [-1, -1], t: 0},
        clutter: [],
    };
    return models[m];
};
const lightOf = (m) => {
    const made = modelOf(m), model = scene.models[m];
    if (!model.light) return null;
    if (made.light === undefined) {
        made.light = null;
        W.load(`relit-${model.edit}`).then(async (l) => {
            if (!l) return;
            const {data, draws} =
                W.atlasMesh(
                    {
                        ...model,
                        faces: model.faces.map(
                            (f) =>
                                ({...f, rules: [{kind: 'place', from: f.id, m: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]}]}))
                    },
                    l.atlas, true);
            const pages = await Promise.all(l.textures.map(async (t) => painter.texture(await W.picture(t))));
            made.light = {set: {buffer: painter.buffer(data, [[0, 3], [1, 3], [2, 4]]), draws, pages}, most: l.most};
            touch();
        });
    }
    return made.light;
};

// --- a picture

const STILL = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);

// What is drawn of a view's furniture in a model.
const clutterDraws = (list, m) => {
    const model = scene.models[m], draws = [];
    for (const [v, weight] of list) {
        const i = scene.places.findIndex((p) => v >= p.first && v < p.first + p.count), photo = photoOf(i);
        const view = photo && photo[v - scene.places[i].first];
        if (!view || !view.grid) continue;
        const key = `${v} ${m} ${S.above ? 'above' : ''}`, p = places[i];
        if (!p.cells[key]) {
            const parts = [[0, STILL]];
            for (const t of model.placed) {
                const [r, d] = [t.turn, t.shift];
                parts.push(
                    [t.id, new Float32Array([r[0], r[3], r[6], 0, r[1], r[4], r[7], 0, r[2], r[5], r[8], 0, ...d, 1])]);
            }
            p.cells[key] = parts.map(([thing, moved]) => {
                const cells = W.clutterCells(model, view.grid, thing, S.above && 0.78);
                return {
                    moved,
                    first: 0,
                    count: cells.length,
                    buffer: cells.length && painter.buffer(view.grid.points, [[0, 3], [1, 2]], cells)
                };
            });
        }
        for (const c of p.cells[key])
            if (c.count) draws.push({...c, texture: view.texture, weight});
    }
    return draws;
};

// The photographs of the viewpoint that a camera stands in, and how much they cover.
const photosAt = (camera, m, light) => {
    let best = -1, least = Infinity;
    scene.places.forEach((p, i) => {
        const away = W.length(W.add(p.centre, camera.centre, -1));
        if (away < least) [best, least] = [i, away];
    });
    const alpha = 1 - Math.min(1, Math.max(0, (least / S.size - 0.001) / 0.005));
    if (!(alpha > 0)) return [];
    const photo = photoOf(best), model = scene.models[m];
    if (!photo) return [];
    const own = photo.map((v) => ({texture: v.texture, view: v.view, alpha}));
    if (!model.edit) return own;
    if (alpha < 1) return [];  // what changed must cover the photograph, not mix with it
    if (light && model.light) {
        const relit = changesOf(`light-${model.edit}`, best);
        return relit ? own.map((v, k) => relit[k] && {...v, texture: relit[k], relit: true}).filter((v) => v) : [];
    }
    if (!model.drawn) return [];
    const changed = changesOf(`edit-${model.edit}`, best);
    if (changed === null) return [];
    return [
        ...own,
        ...(changed || []).map((t, k) => t && {texture: t, view: photo[k].view, alpha, change: true}).filter((v) => v)
    ];
};

// Draws a model from a camera into a part of the canvas. fixed: {pair, photos}: for tests.
const drawModel = (camera, m, box, fixed = {}) => {
    const made = modelOf(m), light = S.light && lightOf(m), above = !!S.above && !fixed.inside;
    let sets = [null, null], share = 0;
    if (above) {
        if (typeof made.aboveSolid === 'function') made.aboveSolid = made.aboveSolid();
        if (typeof made.aboveVita === 'function') made.aboveVita = made.aboveVita();
    } else {
        const pair = fixed.pair || made.pair;
        const here = pair.places.map((i) => (i >= 0 && textureOf(i) ? i : -1));
        if (here[0] >= 0 || here[1] >= 0) made.shown = pair;
        const used = made.shown || pair;
        const there = used.places.map((i) => (i >= 0 && textureOf(i) ? meshOf(i, m) : null));
        share = used.t;
        sets = !there[0] ? [there[1], null] : !there[1] ? [there[0], null] : there;
        if (!there[0] || !there[1]) share = 0;
    }
    const model = scene.models[m], size = S.size, part = fixed.part || S.part;
    const photos = above || fixed.photos === false ? [] : photosAt(camera, m, S.light);
    painter.paint({
        camera,
        box,
        part: photos.some((v) => v.alpha === 1) ? Math.min(1, part) : part, // several samples would blur it
        sets,
        share,
        rules: made.rules,
        solid: above ? made.aboveSolid : made.solid,
        vita: {...(above ? made.aboveVita : made.vita), pages: vita.pages},
        outdoors: above ? null : outdoors,
        light,
        made: S.made ? 1 : 0,
        kinds,
        relitKinds,
        clutter: clutterDraws(made.clutter, m),
        photos,
        objects: made.objects.length ? made.objects : null,
        near: above ? 0.05 * size : 0.01 * size,
        far: 8 * size,
        model,
    });
};

// Chooses textures for a camera; fine: with as many rays as render_model.
const choose = (camera, m, fine) => {
    const made = modelOf(m), model = scene.models[m];
    if (S.above) {
        const middle = [];
        for (const room of model.rooms) {
            const flat = room.corners.flat(), x = room.corners.map((c) => c[0]), y = room.corners.map((c) => c[1]);
            for (let i = 0.5; i < 5; i++)
                for (let j = 0.5; j < 5; j++) {
                    const a = Math.min(...x) + (i / 5) * (Math.max(...x) - Math.min(...x)),
                          b = Math.min(...y) + (j / 5) * (Math.max(...y) - Math.min(...y));
                    if (W.insidePolygon(flat, a, b))
                        middle.push([a, b, room.floor + 0.17 * (model.high[2] - model.low[2])]);
                }
        }
        made.clutter = scene.clutter ? W.chooseClutter(scene, camera, middle, 10) : [];
        return;
    }
    made.pair = W.choosePair(scene, model, camera, fine);
    made.clutter = scene.clutter ?
        W.chooseClutter(scene, camera, W.clutterPlaces(model, camera, fine), fine ? CLUTTER_VIEWS : MOVING_VIEWS) :
        [];
};

const eyeCamera = (width, height) => {
    if (!S.above) return W.camera(S.eye.centre, S.eye.heading, S.eye.up, width, height, S.field);
    const a = S.above, back = W.turnOf(a.heading, a.up).slice(6);
    return W.camera(W.add(a.target, back, -a.away), a.heading, a.up, width, height, 0.8);
};

let canvas;
const fit = () => {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)),
          height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) {
        canvas.width = width;
        canvas.height = height;
    }
    painter.resize(Math.max(1, S.part) * width, Math.max(1, S.part) * height);
};
S.part = 1;
// Frames that take too long while one moves are drawn with fewer pixels; at rest all are.
const pace = (now, rests) => {
    if (rests)
        S.part = S.time < 25 ? 2 : 1; // four samples a pixel, as render_model, where it is quick
    else if (S.painted && now - S.painted < 1000) {
        S.time = 0.7 * (S.time || 40) + 0.3 * (now - S.painted);
        if (S.time > 85)
            S.quick = Math.max(0.5, (S.quick || 1) - 0.1);
        else if (S.time < 40)
            S.quick = Math.min(1, (S.quick || 1) + 0.05);
        S.part = S.quick || 1;
    }
    S.painted = now;
};

const paint = () => {
    const camera = eyeCamera(canvas.width, canvas.height), now = performance.now();
    const shown = S.compare && S.edit ? [0, S.edit] : [S.edit];
    painter.counts = {calls: 0, triangles: 0};
    painter.seen = new Map();
    for (const m of shown) {
        const made = modelOf(m), where = [
            ...camera.centre, S.eye.heading, S.eye.up, !!S.above, S.above && S.above.heading, S.above && S.above.up,
            S.field
        ].join();
        const rests = now - S.moved > 150;
        if (made.where !== where || (rests && !made.fine)) {
            choose(camera, m, rests);
            made.where = where;
            made.fine = rests;
        }
    }
    const w = canvas.width, h = canvas.height, at = Math.round(S.split * w);
    if (shown.length === 2) {
        drawModel(camera, 0, [0, 0, at, h]);
        drawModel(camera, S.edit, [at, 0, w - at, h]);
    } else
        drawModel(camera, S.edit, [0, 0, w, h]);
    S.camera = camera;
    if (S.details) {
        const bytes = [...painter.seen.values()].reduce((a, b) => a + b, 0);
        W.say(`${painter.counts.calls} draw calls, ${Math.round(painter.counts.triangles)} triangles, ${
            (1e-6 * bytes).toFixed(1)} MB of textures in use, ${w} x ${h} px`);
    }
    marks();
    const field = 2 * Math.atan((0.5 * camera.width) / camera.lens[0]);
    plan.stand(
        S.above ? S.above.target : S.eye.centre, S.above ? S.above.heading : S.eye.heading, field,
        S.above ? [] :
                  modelOf(S.edit).pair.places.filter((i, k) => i >= 0 && (k ? modelOf(S.edit).pair.t > 0.1 : true)));
};

// Circles on the floor below viewpoints, what is measured, and the aim of the keyboard.
const marks = () => {
    const ratio = canvas.clientWidth / canvas.width, camera = S.camera, parts = [];
    const on = (p) => {
        const [x, y, z] = W.project(camera, p);
        return z > 0.02 * S.size ? [x * ratio, y * ratio, z] : null;
    };
    S.spots = [];
    if (!S.measure && !S.compare)
        scene.places.forEach((p, i) => {
            const foot = [p.centre[0], p.centre[1], floorAt(p.centre)], at = on(foot);
            if (!at || at[0] < 0 || at[1] < 0 || at[0] > canvas.clientWidth || at[1] > canvas.clientHeight) return;
            const to = W.add(foot, camera.centre, -1);
            if (!S.above && W.hit(scene.models[S.edit], camera.centre, to, 0.97, false)) return;
            const r = Math.min(S.above ? 11 : 26, Math.max(5, (0.025 * S.size * camera.lens[0] * ratio) / at[2]));
            S.spots.push([at[0], at[1], r, i]);
            parts.push(`<ellipse class="spot" cx="${at[0].toFixed(1)}" cy="${at[1].toFixed(1)}" rx="${
                r.toFixed(1)}" ry="${(r * (S.above ? 0.8 : 0.38)).toFixed(1)}"/>`);
        });
    if (S.measure) {
        const ends = S.measure.points.map(on), c = [canvas.clientWidth / 2, canvas.clientHeight / 2];
        parts.push(`<path class="aim" d="M${c[0] - 12} ${c[1]}h24M${c[0]} ${c[1] - 12}v24"/>`);
        if (ends[0] && ends[1]) {
            parts.push(
                `<line class="rule" x1="${ends[0][0]}" y1="${ends[0][1]}" x2="${ends[1][0]}" y2="${ends[1][1]}"/>`);
            parts.push(`<text x="${(ends[0][0] + ends[1][0]) / 2}" y="${(ends[0][1] + ends[1][1]) / 2 - 8}">${
                W.escape(S.measure.text)}</text>`);
        }
        ends.forEach((e) => e && parts.push(`<circle class="end" cx="${e[0]}" cy="${e[1]}" r="5"/>`));
    }
    $('marks').innerHTML = parts.join('');
};

// --- walking

const floorAt = (p) => {
    const hit = W.hit(scene.models[S.edit], p, [0, 0, -1]);
    return hit ? hit.point[2] : 0;
};
const eyeHeight = () => {
    const heights = scene.places.map((p) => p.centre[2]).sort((a, b) => a - b);
    return heights[heights.length >> 1];
};
const near = () => 0.035 * S.size;
// As far as one can walk from a place to another one.
const reach = (from, to) => {
    const way = W.add(to, from, -1), length = W.length(way);
    if (!(length > 0)) return from;
    let free = length;
    const hit = W.hit(scene.models[S.edit], from, W.scale(way, 1 / length), length + near());
    if (hit) free = Math.max(0, Math.min(free, hit.t - near()));
    return W.add(from, way, free / length);
};
const inRooms = (p) => {
    const hit = W.hit(scene.models[S.edit], p, [0, 0, -1]);
    return !!hit && hit.face.n[2] > 0.5;
};
const shortest = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));
const goTo = (centre, heading, up, seconds) => {
    const from = {...S.eye, centre: [...S.eye.centre]}, away = W.length(W.add(centre, from.centre, -1));
    const turn = heading === undefined ? 0 : shortest(heading - from.heading);
    S.tour = null;
    S.move = {
        from,
        to: {centre, turn, up: up === undefined ? from.up : up},
        start: performance.now(),
        time: 1000 * (seconds || Math.min(2.5, 0.35 + (2.2 * away) / S.size + 0.25 * Math.abs(turn)))
    };
    buttons();
    touch();
};
// Into a viewpoint, looking as its photograph does unless one keeps looking where one did.
const enter = (i, keep) => {
    if (S.above) toggleAbove();
    const p = scene.places[i], axis = p.axis || (p.axis = placeAxis(p));
    if (keep)
        goTo(p.centre);
    else
        goTo(p.centre, Math.atan2(axis[1], axis[0]), 0);
    W.say(`Photograph ${p.photo}`);
};
const placeAxis = (p) => {
    let sum = [0, 0, 0];
    for (let i = p.first; i < p.first + p.count; i++) sum = W.add(sum, scene.views[i].turn.slice(6));
    return W.unit([sum[0], sum[1], 0]);
};
const nearest = () => {
    let best = 0;
    scene.places.forEach((p, i) => {
        if (W.length(W.add(p.centre, S.eye.centre, -1)) < W.length(W.add(scene.places[best].centre, S.eye.centre, -1)))
            best = i;
    });
    return best;
};
const next = (by) => {
    const n = scene.places.length, here = nearest(),
          in_ = W.length(W.add(scene.places[here].centre, S.eye.centre, -1)) < 0.01 * S.size;
    enter((here + (in_ ? by : 0) + n) % n);
};
const goToPlan = (x, y) => {
    if (S.above) toggleAbove();
    const p = [x, y, eyeHeight()];
    if (inRooms(p))
        goTo(p);
    else
        W.say('That place is not inside a room.');
};
const pick = (x, y) => {  // px of the page
    const ratio = canvas.width / canvas.clientWidth, ray = W.unit(W.rayOf(S.camera, x * ratio, y * ratio));
    return W.hit(scene.models[S.edit], S.camera.centre, ray, Infinity, !!S.measure);
};
const pressed = (x, y) => {
    if (S.measure) return mark(x, y);
    const spot = (S.spots || []).find(([u, v, r]) => Math.hypot(x - u, (y - v) * 1.6) < Math.max(14, r * 1.2));
    if (spot) return enter(spot[3], true);
    if (S.above) return undefined;
    const hit = pick(x, y);
    if (!hit) return undefined;
    const target = [hit.point[0], hit.point[1], S.eye.centre[2]], way = W.add(target, S.eye.centre, -1);
    const off = hit.face.n[2] > 0.5 ? 0 : 0.09 * S.size, length = W.length(way);
    return goTo(reach(S.eye.centre, W.add(S.eye.centre, way, Math.max(0, length - off) / (length || 1))));
};

const step = (now) => {
    const passed = Math.min(0.1, (now - (S.last || now)) / 1000);
    S.last = now;
    if (S.move) {
        const m = S.move, t = Math.min(1, (now - m.start) / m.time), s = t * t * (3 - 2 * t);
        S.eye.centre = W.add(W.scale(m.from.centre, 1 - s), m.to.centre, s);
        S.eye.heading = m.from.heading + s * m.to.turn;
        S.eye.up = m.from.up + s * (m.to.up - m.from.up);
        if (t >= 1) S.move = null;
        S.moved = now;
        touch();
    }
    if (S.tour) {
        const frames = scene.models[S.edit].tour;
        S.tour.time += passed;
        const last = frames[frames.length - 1][0];
        if (S.tour.time >= last) {
            S.tour = null;
            buttons();
            W.say('The tour ends here.');
        } else {
            let k = frames.findIndex((f) => f[0] > S.tour.time);
            k = Math.max(1, k);
            const a = frames[k - 1], b = frames[k], t = (S.tour.time - a[0]) / (b[0] - a[0] || 1);
            const mix = (i) => a[i] + t * (b[i] - a[i]), axis = [mix(4), mix(5), mix(6)];
            S.eye = {
                centre: [mix(1), mix(2), mix(3)],
                heading: Math.atan2(axis[1], axis[0]),
                up: Math.atan2(axis[2], Math.hypot(axis[0], axis[1]))
            };
        }
        S.moved = now;
        touch();
    }
    if (S.keys.size) {
        const k = (name) => (S.keys.has(name) ? 1 : 0), turn = 1.6 * passed, far = 0.22 * S.size * passed;
        if (S.above) {
            S.above.heading += turn * (k('left') - k('right'));
            S.above.up = Math.min(-0.25, Math.max(-1.55, S.above.up + turn * (k('back') - k('forward')) * 0.7));
        } else {
            S.eye.heading += turn * (k('left') - k('right'));
            S.eye.up = Math.min(1.4, Math.max(-1.4, S.eye.up + turn * (k('up') - k('down'))));
            const c = Math.cos(S.eye.heading), s = Math.sin(S.eye.heading), on = k('forward') - k('back'),
                  side = k('sideRight') - k('sideLeft');
            if (on || side) {
                const to = W.add(S.eye.centre, [on * c + side * s, on * s - side * c, 0], far),
                      there = reach(S.eye.centre, to);
                if (inRooms(there)) S.eye.centre = there;
            }
        }
        S.moved = now;
        touch();
    }
};
const loop = (now) => {
    step(now);
    const was = S.rests, rests = now - S.moved > 150;
    S.rests = rests;
    if (!S.busy && (S.dirty || (rests && !was))) {
        S.dirty = false;
        S.frame++;
        pace(now, rests);
        fit();
        paint();
    }
    requestAnimationFrame(loop);
};

// --- measures

const length = (x) => (scene.unit ? `${x.toFixed(2)} m` : `${x.toFixed(3)} units (no length was given for this scene)`);
const area = (x) => (scene.unit ? `${x.toFixed(2)} m²` : `${x.toFixed(3)} square units`);
const mark = (x, y) => {
    const hit = pick(x, y), m = S.measure;
    if (!hit) return W.say('Nothing to measure there.');
    if (m.points.length === 2) m.points = [];
    m.points.push(hit.point);
    const same = scene.models[S.edit].faces.filter(
        (f) => f.name === hit.face.name && Math.abs(f.d - hit.face.d) < 1e-6 && W.dot(f.n, hit.face.n) > 0.999);
    const face = `${hit.face.name}: ${area(same.reduce((s, f) => s + f.area, 0))}`;
    m.text = m.points.length === 2 ? length(W.length(W.add(m.points[1], m.points[0], -1))) : '';
    W.say(m.points.length === 2 ? `Distance ${m.text}. ${face}` : `${face}. Choose a second point for a distance.`);
    return touch();
};

// --- buttons and keys

const toggleMeasure = () => {
    S.measure = S.measure ? null : {points: [], text: ''};
    W.say(
        S.measure ?
            'Choose a point: its surface is measured. Choose a second one: the distance. With the keyboard, turn until the cross is on it and press Enter.' :
            '');
};
const toggleAbove = () => {
    const model = scene.models[S.edit], size = S.size;
    S.move = S.tour = null;
    S.above = S.above ? null : {
        heading: Math.PI / 2,
        up: -1.0,
        away: 1.35 * size,
        target: [0, 1, 2].map((k) => 0.5 * (model.low[k] + model.high[k]))
    };
    W.say(S.above ? 'From above, without ceilings. Drag to turn, click a circle to go there.' : '');
};
const toggleTour = () => {
    const frames = scene.models[S.edit].tour;
    S.move = null;
    if (S.above) toggleAbove();
    S.tour = S.tour ? null : {time: 0};
    W.say(
        S.tour ? `The tour takes ${Math.round(frames[frames.length - 1][0])} seconds. Press T to stop.` :
                 'The tour stops here.');
};
const setEdit = (m) => {
    S.edit = m;
    if (!scene.models[m].edit) S.compare = S.light = false;
    if (!scene.models[m].light) S.light = false;
    S.tour = null;
    modelOf(m);
    plan.show(scene.models[m]);
    W.say(
        scene.models[m].edit ? `${title(m)}${scene.models[m].about ? `: ${scene.models[m].about}` : ''}` :
                                                                     'The rooms as they are.');
};
const title = (m) => (scene.models[m].edit ? scene.models[m].edit.replace(/[-_]/g, ' ') : 'as they are');
const cycle = () => {  // keep the eye where it is possible
    setEdit((S.edit + 1) % scene.models.length);
};
const tools = [
    [
        'compare', 'Compare', 'B', 'compare before and after',
        () => {
            S.compare = !S.compare;
            W.say(S.compare ? 'Left: before. Right: after. Drag the bar, or move it with [ and ].' : '');
        },
        () => S.compare, () => S.edit > 0
    ],
    [
        'light', 'New light', 'L', 'show the light that the change makes',
        () => {
            S.light = !S.light;
            W.say(S.light ? 'In the light that the change makes.' : 'In the light of the photographs.');
        },
        () => S.light, () => scene.models[S.edit].light
    ],
    [
        'tour', 'Tour', 'T', 'walk along the route of the film', toggleTour, () => !!S.tour,
        () => scene.models[S.edit].tour.length > 1
    ],
    ['above', 'From above', 'O', 'look into the rooms from above', toggleAbove, () => !!S.above],
    ['measure', 'Measure', 'M', 'measure distances and surfaces', toggleMeasure, () => !!S.measure],
    [
        'made', 'Origin', 'C', 'show what each place comes from, as colours',
        () => {
            S.made = !S.made;
        },
        () => S.made
    ],
    ['next', 'Next photo', 'N', 'go to the next photograph', () => next(1), null],
    ['help', 'Help', 'H', 'show all keys', () => $('help').showModal(), null],
];
const run = (tool) => {
    if (tool[6] && !tool[6]())
        return W.say(
            tool[0] === 'light' ? 'For this change the new light was not computed: run make relight, then make walk.' :
                tool[0] === 'tour' ? 'This scene has no tour: run make tour-path, then make walk.' :
                                     'Choose a change first.');
    tool[4]();
    S.moved = performance.now();
    buttons();
    return touch();
};
const buttons = () => {
    for (const t of tools) {
        const b = $(`tool-${t[0]}`);
        if (t[5]) b.setAttribute('aria-pressed', !!t[5]());
        b.setAttribute('aria-disabled', !!(t[6] && !t[6]()));
        b.style.opacity = t[6] && !t[6]() ? 0.5 : 1;
    }
    const compare = S.compare && S.edit > 0;
    $('edit').value = S.edit;
    $('divider').hidden = $('before').hidden = $('after').hidden = !compare;
    $('divider').style.left = `${100 * S.split}%`;
    $('divider').setAttribute('aria-valuenow', Math.round(100 * S.split));
    $('after').textContent = compare ? title(S.edit) : '';
    $('legend').hidden = !S.made;
    canvas.classList.toggle('measuring', !!S.measure);
};
const split = (x) => {
    S.split = Math.min(0.98, Math.max(0.02, x));
    buttons();
    touch();
};
const held = {
    ArrowUp: 'forward',
    ArrowDown: 'back',
    ArrowLeft: 'left',
    ArrowRight: 'right',
    w: 'forward',
    s: 'back',
    a: 'sideLeft',
    d: 'sideRight',
    PageUp: 'up',
    PageDown: 'down',
    q: 'left',
    e: 'right'
};
const keyDown = (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || $('help').open || e.target.tagName === 'SELECT') return;
    const key = e.key.length === 1 ? e.key.toLowerCase() : e.key;
    if (e.target === $('divider') && (key === 'ArrowLeft' || key === 'ArrowRight')) {
        e.preventDefault();
        return split(S.split + (key === 'ArrowLeft' ? -0.03 : 0.03));
    }
    if (held[key]) {
        e.preventDefault();
        S.move = null;
        if (S.tour) {
            S.tour = null;
            buttons();
        }
        S.keys.add(held[key]);
        if (e.shiftKey && (key === 'ArrowLeft' || key === 'ArrowRight')) {
            S.keys.delete(held[key]);
            S.keys.add(key === 'ArrowLeft' ? 'sideLeft' : 'sideRight');
        }
        return undefined;
    }
    const tool = tools.find((t) => t[2].toLowerCase() === key);
    if (tool) return run(tool);
    if (key === 'p') return next(-1);
    if (key === 'x') {
        cycle();
        buttons();
        return touch();
    }
    if (key === '[' || key === ']') return split(S.split + (key === '[' ? -0.03 : 0.03));
    if (key === '+' || key === '=' || key === '-') return zoom(key === '-' ? 1.1 : 1 / 1.1);
    if (key === 'i') {
        S.details = !S.details;
        W.say('');
        return touch();
    }
    if (key === 'r') {
        S.eye.up = 0;
        S.field = FIELD;
        S.moved = performance.now();
        return touch();
    }
    if (/^[0-9]$/.test(key) && +key < scene.models.length) {
        setEdit(+key);
        buttons();
        return touch();
    }
    if ((key === 'Enter' || key === ' ') && e.target === canvas) {
        e.preventDefault();
        return pressed(canvas.clientWidth / 2, canvas.clientHeight / 2);
    }
    if (key === 'Escape') {
        Object.assign(S, {measure: null, tour: null, move: null, compare: false, made: false});
        if (S.above) toggleAbove();
        W.say('');
        buttons();
        touch();
    }
    return undefined;
};
const keyUp = (e) => {
    const key = held[e.key.length === 1 ? e.key.toLowerCase() : e.key];
    S.keys.delete(key);
    if (key === 'left') S.keys.delete('sideLeft');
    if (key === 'right') S.keys.delete('sideRight');
};
const zoom = (by) => {
    if (S.above)
        S.above.away = Math.min(3 * S.size, Math.max(0.4 * S.size, S.above.away * by));
    else
        S.field = Math.min(1.9, Math.max(0.4, S.field * by));
    S.moved = performance.now();
    touch();
};

// Mouse and fingers: one turns, two walk and zoom, a short touch goes there.
const fingers = new Map();
const down = (e) => {
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({preventScroll: true});
    fingers.set(e.pointerId, {x: e.clientX, y: e.clientY, still: true, time: performance.now()});
};
const moveFinger = (e) => {
    const f = fingers.get(e.pointerId);
    if (!f) return;
    const dx = e.clientX - f.x, dy = e.clientY - f.y;
    if (f.still && Math.hypot(dx, dy) < 5) return;
    const others = [...fingers.values()].filter((o) => o !== f);
    f.still = false;
    canvas.classList.add('turning');
    S.move = null;
    if (S.tour) {
        S.tour = null;
        buttons();
    }
    if (others.length) {
        others[0].still = false;
        const was = Math.hypot(f.x - others[0].x, f.y - others[0].y), is = Math.hypot(e.clientX - others[0].x, e.clientY - others[0].y);
        if (S.above)
            zoom(was / is);
        else {
            const c = Math.cos(S.eye.heading), s = Math.sin(S.eye.heading), far = (0.006 * (is - was) * S.size) / 6;
            const there = reach(S.eye.centre, W.add(S.eye.centre, [c, s, 0], far));
            if (inRooms(there)) S.eye.centre = there;
        }
    } else {
        const turn = S.above ? 0.006 : S.field / Math.max(canvas.clientWidth, canvas.clientHeight),
              at = S.above || S.eye;
        at.heading += turn * dx;
        at.up = S.above ? Math.min(-0.25, Math.max(-1.55, at.up - turn * dy)) :
                          Math.min(1.4, Math.max(-1.4, at.up + turn * dy));
    }
    Object.assign(f, {x: e.clientX, y: e.clientY});
    S.moved = performance.now();
    touch();
};
const up = (e) => {
    const f = fingers.get(e.pointerId);
    fingers.delete(e.pointerId);
    canvas.classList.remove('turning');
    if (f && f.still && e.type === 'pointerup') {
        const box = canvas.getBoundingClientRect();
        pressed(e.clientX - box.left, e.clientY - box.top);
    }
};

const build = () => {
    $('tools').innerHTML = tools
                               .map(
                                   (t) => `<button id="tool-${t[0]}" title="${t[3]}"${
                                       t[5] ? ' aria-pressed="false"' : ''}>${t[1]}<kbd>${t[2]}</kbd></button>`)
                               .join('');
    tools.forEach((t) => $(`tool-${t[0]}`).addEventListener('click', () => {
        run(t);
        if (t[0] !== 'help') canvas.focus({preventScroll: true});
    }));
    $('more').addEventListener(
        'click', () => $('more').setAttribute('aria-expanded', $('tools').classList.toggle('open')));
    $('edit').innerHTML = scene.models.map((m, i) => `<option value="${i}">${W.escape(title(i))}</option>`).join('');
    $('edit').addEventListener('change', () => {
        setEdit(+$('edit').value);
        buttons();
        touch();
        canvas.focus({preventScroll: true});
    });
    $('choice').hidden = scene.models.length < 2;
    const words = {
        photo: 'the photograph itself',
        original: 'original: from the photograph of this viewpoint',
        warped: 'warped: from another photograph',
        guessed: 'synthesised: no photograph shows it',
        colour: 'a colour for a new surface',
        outdoors: 'what lies outdoors',
        clutter: 'furniture, by its depth in the photographs'
    };
    const box = (rgb, text) => `<div><i style="background:rgb(${rgb.join()})"></i>${text}</div>`;
    $('legend').innerHTML = '<b>Where the picture comes from</b>' +
        scene.made.filter((k) => words[k.word]).map((k) => box(k.rgb, words[k.word])).join('') +
        box([255, 205, 40], 'yellow over it: relit') + '<div id="aimed"></div>';
    $('help').innerHTML = `<h2>Walk through ${W.escape(scene.name)}</h2><table>
<tr><td>drag, <kbd>←</kbd> <kbd>→</kbd>, <kbd>PgUp</kbd> <kbd>PgDn</kbd></td><td>look around</td></tr>
<tr><td>click, <kbd>↑</kbd> <kbd>↓</kbd>, <kbd>A</kbd> <kbd>D</kbd></td><td>go there; walk; step aside. On a touch screen, two fingers walk.</td></tr>
<tr><td>circles on the floor, blue dots on the plan, <kbd>N</kbd> <kbd>P</kbd></td><td>go where a photograph was taken: there you see it as it is</td></tr>
<tr><td>wheel, <kbd>+</kbd> <kbd>-</kbd>, <kbd>R</kbd></td><td>nearer, wider, back to normal</td></tr>
<tr><td><kbd>0</kbd> to <kbd>9</kbd>, <kbd>X</kbd></td><td>the rooms as they are, or after a change; the next change</td></tr>
${tools.map((t) => `<tr><td><kbd>${t[2]}</kbd></td><td>${t[3]}</td></tr>`).join('')}
<tr><td><kbd>Enter</kbd></td><td>go to, or measure, what is in the middle of the picture</td></tr>
<tr><td><kbd>Esc</kbd></td><td>back to walking</td></tr>
<tr><td><kbd>I</kbd></td><td>what drawing takes</td></tr></table>
<form method="dialog"><button>Close</button></form>`;
    canvas.addEventListener('pointerdown', down);
    canvas.addEventListener('pointermove', moveFinger);
    canvas.addEventListener('pointerup', up);
    canvas.addEventListener('pointercancel', up);
    canvas.addEventListener('wheel', (e) => {
        e.preventDefault();
        zoom(e.deltaY > 0 ? 1.08 : 1 / 1.08);
    }, {passive: false});
    document.addEventListener('keydown', keyDown);
    document.addEventListener('keyup', keyUp);
    window.addEventListener('blur', () => S.keys.clear());
    window.addEventListener('resize', touch);
    const drag = (e) => {
        if (e.buttons) split(e.clientX / window.innerWidth);
    };
    $('divider').addEventListener('pointerdown', (e) => $('divider').setPointerCapture(e.pointerId));
    $('divider').addEventListener('pointermove', drag);
};

const start = async () => {
    canvas = $('rooms');
    try {
        painter = new W.Painter(canvas);
        scene = await W.load('scene');
        if (!scene) return;
        scene.models.forEach(W.prepareModel);
        S.size = Math.max(...[0, 1].map((k) => scene.models[0].high[k] - scene.models[0].low[k]));
        S.frame = 0;
        kinds = new Float32Array(scene.made.flatMap((k) => k.rgb.map((x) => (x / 255) ** 2)));
        relitKinds = kinds.slice();
        relitKinds.set([1.6, 1.1, 0.05]);  // the first one: where light changes
        for (const p of scene.places)
            places.push({texture: null, photo: null, asked: {}, used: 0, meshes: {}, changes: {}, cells: {}});
        plan = new W.Plan($('plan'), scene, goToPlan, enter);
        build();
        const list = await W.load('pictures');
        (list || []).forEach((n) => pictures.add(n));
        scene.models.forEach((m) => {
            m.drawn = !!m.edit && [...pictures].some((n) => n.startsWith(`edit-${m.edit}-`));
        });
        const first = scene.models[0].tour[0];
        const p = scene.places[first && first[7] >= 0 ? first[7] : 0], axis = placeAxis(p);
        S.eye = {centre: [...p.centre], heading: Math.atan2(axis[1], axis[0]), up: 0};
        setEdit(0);
        W.say('Drag to look around, click to go there. H shows all keys.');
        buttons();
        const pages = loadPages('vita').then((t) => {
            vita.pages = t || [];
            touch();
        });
        if (scene.outdoors)
            W.load('outdoors').then(async (t) => {
                outdoors = t && painter.texture(await W.picture(t));
                touch();
            });
        photoOf(scene.places.indexOf(p));
        await Promise.race([pages, places[scene.places.indexOf(p)].asked.photo]);
        $('wait').hidden = true;
        requestAnimationFrame((now) => {
            loop(now);
            W.firstPicture = performance.now();
        });
    } catch (e) {
        $('wait').textContent = e.message;
        console.error(e);
    }
};

// --- for tests: a picture from a given camera, once all that it needs is here

W.settled = async () => {
    for (;;) {
        const waiting = places.flatMap((p) => Object.values(p.asked)), n = W.waiting.size;
        await Promise.all(waiting);
        await Promise.all([...W.waiting.values()].map((w) => w.value));
        await new Promise((take) => setTimeout(take, 20));
        if (waiting.length === places.flatMap((p) => Object.values(p.asked)).length && W.waiting.size === n) return;
    }
};
window.walk = {
    ready: async () => {
        while (!W.firstPicture) await new Promise((take) => setTimeout(take, 20));
        await W.settled();
        return W.firstPicture;
    },
    // spec: {camera: {centre, turn, lens, width, height}, edit: number or name, light, made, photos: false}
    picture: async (spec) => {
        const m = typeof spec.edit === 'string' ? scene.models.findIndex((x) => x.edit === spec.edit) : spec.edit || 0,
              {camera} = spec;
        Object.assign(S, {light: !!spec.light, made: !!spec.made, above: null, busy: true});
        const size = [canvas.width, canvas.height];
        for (let k = 0; k < 2; k++) {
            canvas.width = camera.width;
            canvas.height = camera.height;
            painter.resize(2 * camera.width, 2 * camera.height);
            painter.counts = {calls: 0, triangles: 0};
            painter.seen = new Map();
            S.frame++;
            choose(camera, m, true);
            modelOf(m).where = '';
            drawModel(camera, m, [0, 0, camera.width, camera.height], {photos: spec.photos, inside: true, part: 2});
            await W.settled();
        }
        const made = modelOf(m), url = canvas.toDataURL('image/png');
        [canvas.width, canvas.height] = size;
        S.dirty = true;
        S.busy = false;
        return {
            url,
            pair: made.pair,
            clutter: made.clutter,
            counts: painter.counts,
            bytes: [...painter.seen.values()].reduce((a, b) => a + b, 0)
        };
    },
    // Frames per second along the tour, with all that is needed loaded. count: frames; width x height: of the canvas.
    // part: of the pixels along each side.
    speed: async (count, width, height, part = 1) => {
        const frames = scene.models[0].tour.length ? scene.models[0].tour :
                                                     scene.places.map((p) => [0, ...p.centre, ...placeAxis(p)]);
        const cameras = [];
        for (let i = 0; i < count; i++) {
            const f = frames[Math.floor((i * frames.length) / count)];
            cameras.push(W.camera(
                [f[1], f[2], f[3]], Math.atan2(f[5], f[4]), Math.atan2(f[6], Math.hypot(f[4], f[5])), width, height,
                FIELD));
        }
        S.busy = true;
        const pixel = new Uint8Array(4), gl = painter.gl, result = {};
        for (const pass of ['load', 'measure']) {
            canvas.width = width;
            canvas.height = height;
            painter.resize(width, height);
            const begin = performance.now();
            let choosing = 0, calls = 0, bytes = 0, triangles = 0;
            for (const camera of cameras) {
                painter.counts = {calls: 0, triangles: 0};
                painter.seen = new Map();
                S.frame++;
                const t = performance.now();
                choose(camera, 0, false);
                choosing += performance.now() - t;
                drawModel(camera, 0, [0, 0, width, height], {inside: true, part});
                gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
                calls += painter.counts.calls / count;
                triangles += painter.counts.triangles / count;
                bytes += [...painter.seen.values()].reduce((a, b) => a + b, 0) / count;
            }
            const seconds = (performance.now() - begin) / 1000;
            Object.assign(result, {fps: count / seconds, choosing: choosing / count, calls, triangles, bytes});
            if (pass === 'load') await W.settled();
        }
        S.busy = false;
        touch();
        return result;
    },
    state: S,
    scene: () => scene,
    get painter() { return painter; },
    get painter() { return painter; },
    get painter() { return painter; },
};
start();
