// probe.js - for tests: pictures from given cameras once all that they need is here, and how quick frames are.
'use strict';

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
        for (let k = 0; k < 3; k++) {  // the photograph, then what changes it
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
};
