// picture.js - what a picture shows: which textures, furniture and photographs, from which camera, at what pace.
'use strict';

const STILL = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);

// What is drawn of furniture in a model: {draws, witnesses}, the views that vote on it.
const clutterDraws = (list, m, camera) => {
    const model = scene.models[m], draws = [], witnesses = [];
    for (const [v, fade] of list) {
        const i = scene.places.findIndex((p) => v >= p.first && v < p.first + p.count), photo = photoOf(i);
        const view = photo && photo[v - scene.places[i].first];
        if (!view || !view.sight) continue;
        witnesses.push({number: v, fade, view: view.view, sight: view.sight, size: view.size});
        if (!view.grid) continue;
        const key = `${v} ${m} ${S.above ? 'above' : ''}`, p = places[i];
        if (!p.cells[key]) {
            const parts = [[0, STILL]];
            for (const t of model.placed) {
                const [r, d] = [t.turn, t.shift];
                parts.push(
                    [t.id, new Float32Array([r[0], r[3], r[6], 0, r[1], r[4], r[7], 0, r[2], r[5], r[8], 0, ...d, 1])]);
            }
            p.cells[key] = parts.map(([thing, moved], k) => {
                const cells = W.clutterCells(model, view.grid, thing, S.above && 0.78);
                return {
                    moved,
                    placed: k ? model.placed[k - 1] : null,
                    first: 0,
                    count: cells.length,
                    buffer: cells.length && painter.buffer(view.grid.points, [[0, 3], [1, 2], [3, 1]], cells)
                };
            });
        }
        for (const c of p.cells[key])
            if (c.count)
                draws.push({
                    ...c,
                    texture: view.texture,
                    own: witnesses.length - 1,
                    // where the camera stands beside the thing at its old place
                    eye: c.placed ? W.turnBack(c.placed.turn, W.add(camera.centre, c.placed.shift, -1)) : camera.centre
                });
    }
    return {draws, witnesses};
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
        panes: made.open || made.pair.open ? null : made.panes,
        light,
        made: S.made ? 1 : 0,
        kinds,
        relitKinds,
        clutter: clutterDraws(made.clutter, m, camera),
        grid: scene.grid,
        sure: above ? [0.6, 0.9] : [0.45, 0.75], // from above, what few photographs agree on is a rag
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
