// textures.js - pictures and meshes of viewpoints, edits and models: loaded when they are needed, and let go.
'use strict';

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
                if (v.sight) {
                    made.sight = W.clutterSight(v, await W.unpack(v.sight));
                    made.size = [v.columns, v.rows];
                }
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
        p.asked[file] = W.load(file).then(async (list) => {
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
        panes: painter.buffer(W.paneMesh(model, 0.004 * S.size), [[0, 3]]),
        open: W.isOpen(model, scene.places.filter((p, i, all) => i % Math.ceil(all.length / 12) === 0).map((p) => p.centre)),
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
            const pictures = await Promise.all(l.textures.map((t) => W.picture(t))), pixels = pictures.map(W.pixels);
            const pages = pictures.map((picture) => painter.texture(picture));
            const volume = scene.clutter ? painter.volume(W.lightVolume(model, l, pixels)) : null;
            const buffer = painter.buffer(data, [[0, 3], [1, 3], [2, 4]]);
            made.light = {set: {buffer, draws, pages}, most: l.most, volume};
            touch();
        });
    }
    return made.light;
};
