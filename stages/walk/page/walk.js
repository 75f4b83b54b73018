// walk.js - starts the page.
'use strict';

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
start();
