// space.js - points, polygons and cameras. The model's frame: z up. A camera's: x right, y down, z forward.
'use strict';
const W = {};

W.dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
W.cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
W.add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
W.scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
W.length = (a) => Math.hypot(a[0], a[1], a[2]);
W.unit = (a) => W.scale(a, 1 / (W.length(a) || 1));
// m: 9 numbers by rows, or 12: 3 x 4
W.turn = (m, p) => [W.dot(m, p), W.dot(m.slice(3, 6), p), W.dot(m.slice(6, 9), p)];
W.turnBack = (m, p) => [0, 1, 2].map((k) => m[k] * p[0] + m[3 + k] * p[1] + m[6 + k] * p[2]);
W.place = (m, p) => [0, 4, 8].map((r) => m[r] * p[0] + m[r + 1] * p[1] + m[r + 2] * p[2] + m[r + 3]);
// the matrix of a after b, both 3 x 4 with 0 0 0 1 below b
W.after = (a, b) => {
    const m = [];
    for (let i = 0; i < 3; i++)
        for (let k = 0; k < 4; k++)
            m.push(a[4 * i] * b[k] + a[4 * i + 1] * b[4 + k] + a[4 * i + 2] * b[8 + k] + (k === 3 ? a[4 * i + 3] : 0));
    return m;
};

// What remains of a convex polygon where side(p) is not below 0; corners are arrays of numbers.
W.clip = (polygon, side) => {
    const kept = [];
    for (let i = 0; i < polygon.length; i++) {
        const p = polygon[i], q = polygon[(i + 1) % polygon.length];
        const a = side(p), b = side(q);
        if (a >= 0) kept.push(p);
        if (a >= 0 !== b >= 0) kept.push(p.map((x, k) => x + (a / (a - b)) * (q[k] - x)));
    }
    return kept;
};

W.insidePolygon = (corners, x, y) => {  // corners: x, y, x, y, ...
    let inside = false;
    for (let i = 0, j = corners.length - 2; i < corners.length; j = i, i += 2)
        if (corners[i + 1] > y !== corners[j + 1] > y &&
            x < ((corners[j] - corners[i]) * (y - corners[i + 1])) / (corners[j + 1] - corners[i + 1]) + corners[i])
            inside = !inside;
    return inside;
};

// A camera that stands at `centre` and looks along a compass direction (radians, 0: x, counter-clockwise) and up.
W.turnOf = (heading, up) => {
    const c = Math.cos(heading), s = Math.sin(heading), u = Math.cos(up), v = Math.sin(up);
    return [s, -c, 0, v * c, v * s, -u, u * c, u * s, v];
};
W.camera = (centre, heading, up, width, height, field) => {
    const f = (0.5 * Math.max(width, height)) / Math.tan(0.5 * field);
    return {centre, turn: W.turnOf(heading, up), lens: [f, f, width / 2, height / 2], width, height};
};
// The direction of the ray through a pixel, of any length.
W.rayOf = (camera, x, y) => {
    const [fx, fy, cx, cy] = camera.lens;
    return W.turnBack(camera.turn, [(x - cx) / fx, (y - cy) / fy, 1]);
};
// [x, y, depth] of a point
W.project = (camera, p) => {
    const q = W.turn(camera.turn, W.add(p, camera.centre, -1)), [fx, fy, cx, cy] = camera.lens;
    return [(fx * q[0]) / q[2] + cx, (fy * q[1]) / q[2] + cy, q[2]];
};
// Column-major 4 x 4 for WebGL: clip coordinates of a point of the model.
W.clipMatrix = (camera, near, far) => {
    const [fx, fy, cx, cy] = camera.lens, r = camera.turn, c = camera.centre, w = camera.width, h = camera.height;
    const rows = [0, 3, 6].map((k) => [r[k], r[k + 1], r[k + 2], -(r[k] * c[0] + r[k + 1] * c[1] + r[k + 2] * c[2])]);
    const mix = (a, b, s, t) => a.map((x, k) => s * x + t * b[k]);
    const x = mix(rows[0], rows[2], (2 * fx) / w, (2 * cx) / w - 1);
    const y = mix(rows[1], rows[2], (-2 * fy) / h, 1 - (2 * cy) / h);
    const z =
        rows[2].map((v, k) => (v * (far + near)) / (far - near) - (k === 3 ? (2 * far * near) / (far - near) : 0));
    const m = [];
    for (let k = 0; k < 4; k++) m.push(x[k], y[k], z[k], rows[2][k]);
    return new Float32Array(m);
};
