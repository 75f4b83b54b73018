// measure.js - marks over the picture: circles below viewpoints, and what is measured.
'use strict';

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
            for (const kind of ['spot under', 'spot'])  // a dark edge: floors may be white
                parts.push(`<ellipse class="${kind}" cx="${at[0].toFixed(1)}" cy="${at[1].toFixed(1)}" rx="${
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
