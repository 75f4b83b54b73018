/* room.js FOLDER [bare] - a made-up scene, exactly known: a room of 4 x 3 x 2.5 m, four photographs, points on its walls and its
 * floor, as files that build_model and draw read. Walls: south y = 0, east x = 4, north y = 3, west x = 0. bare: its scale and its ceiling are unknown. */
'use strict';
const fs = require('fs');
const zlib = require('zlib');

const SIZE = [640, 480], FOCAL = 320, ROOM = [4, 3, 2.5];
const add = (a, b, t) => a.map((v, k) => v + t * b[k]), dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/* Photo pK looks south, east, north, west, a little down. */
const photos = [[0, -1], [1, 0], [0, 1], [-1, 0]].map(([x, y], i) => {
    const tilt = 0.15, z = [x * Math.cos(tilt), y * Math.cos(tilt), -Math.sin(tilt)], right = [y, -x, 0],
        down = cross(z, right);
    return {id: 'p' + i, turn: [right, down, z], centre: [2 - x * 0.8, 1.5 - y * 0.8, 1.45]};
});

function project(id, p) {
    const c = photos.find((q) => q.id === id), to = add(p, c.centre, -1), [x, y, z] = c.turn.map((r) => dot(r, to));
    return [SIZE[0] / 2 + FOCAL * x / z, SIZE[1] / 2 + FOCAL * y / z];
}

function quaternion([a, b, c]) {
    const w = Math.sqrt(Math.max(0, 1 + a[0] + b[1] + c[2])) / 2;
    if (w > 0.1) return [w, (c[1] - b[2]) / (4 * w), (a[2] - c[0]) / (4 * w), (b[0] - a[1]) / (4 * w)];
    const x = Math.sqrt(Math.max(0, 1 + a[0] - b[1] - c[2])) / 2;
    if (x > 0.1) return [(c[1] - b[2]) / (4 * x), x, (a[1] + b[0]) / (4 * x), (a[2] + c[0]) / (4 * x)];
    const y = Math.sqrt(Math.max(0, 1 - a[0] + b[1] - c[2])) / 2;
    return [(a[2] - c[0]) / (4 * y), (a[1] + b[0]) / (4 * y), y, (b[2] + c[1]) / (4 * y)];
}

function points() {
    const list = [], step = 0.04, range = (to) => Array.from({length: Math.floor(to / step)}, (_, i) =>
        (i + 0.5) * step);
    for (const z of range(ROOM[2])) {
        for (const x of range(ROOM[0])) list.push([x, 0, z, 0, 1, 0], [x, ROOM[1], z, 0, -1, 0]);
        for (const y of range(ROOM[1])) list.push([0, y, z, 1, 0, 0], [ROOM[0], y, z, -1, 0, 0]);
    }
    for (const x of range(ROOM[0])) for (const y of range(ROOM[1])) list.push([x, y, 0, 0, 0, 1]);
    return list;
}

function ply() {
    const list = points(), types = ['double x', 'double y', 'double z', 'float nx', 'float ny', 'float nz',
        'uchar red', 'uchar green', 'uchar blue', 'ushort views', 'float confidence'];
    const head = 'ply\nformat binary_little_endian 1.0\ncomment remodel-points 1\ncomment cell 0.04\n' +
        `element vertex ${list.length}\n` +
        types.map((t) => `property ${t}\n`).join('') + 'end_header\n', body = Buffer.alloc(45 * list.length);
    list.forEach((p, i) => {
        for (let k = 0; k < 3; k++) body.writeDoubleLE(p[k], 45 * i + 8 * k),
            body.writeFloatLE(p[3 + k], 45 * i + 24 + 4 * k);
        body.fill(128, 45 * i + 36, 45 * i + 39);
        body.writeUInt16LE(4, 45 * i + 39);
        body.writeFloatLE(1, 45 * i + 41);
    });
    return Buffer.concat([Buffer.from(head), body]);
}

function png(c) {
    const [w, h] = SIZE, raw = Buffer.alloc((3 * w + 1) * h);
    for (let v = 0; v < h; v++)
        for (let u = 0; u < w; u++) {
            const d = [0, 1, 2].map((k) => c.turn[0][k] * (u + 0.5 - w / 2) / FOCAL +
                c.turn[1][k] * (v + 0.5 - h / 2) / FOCAL + c.turn[2][k]);
            let t = Infinity, axis = 0;
            for (let k = 0; k < 3; k++) {
                const at = ((d[k] > 0 ? ROOM[k] : 0) - c.centre[k]) / d[k];
                if (at < t) t = at, axis = k;
            }
            const p = add(c.centre, d, t), check = p.reduce((s, x, k) => s + (k === axis ? 0 : Math.floor(x * 4)),
                0) & 1;
            const grey = [150, 180, 120][axis] + 25 * check, at = (3 * w + 1) * v + 1 + 3 * u;
            raw[at] = grey, raw[at + 1] = grey, raw[at + 2] = axis === 2 ? grey - 40 : grey;
        }
    const chunk = (type, data) => {
        const body = Buffer.concat([Buffer.from(type), data]), out = Buffer.alloc(body.length + 8);
        out.writeUInt32BE(data.length, 0);
        body.copy(out, 4);
        out.writeUInt32BE(crc(body), body.length + 4);
        return out;
    };
    const head = Buffer.alloc(13);
    head.writeUInt32BE(w, 0), head.writeUInt32BE(h, 4), head[8] = 8, head[9] = 2;
    return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk('IHDR', head),
        chunk('IDAT', zlib.deflateSync(raw)), chunk('IEND', Buffer.alloc(0))]);
}

function crc(bytes) {
    let c = 0xffffffff;
    for (const b of bytes) {
        c ^= b;
        for (let k = 0; k < 8; k++) c = c & 1 ? (c >>> 1) ^ 0xedb88320 : c >>> 1;
    }
    return (c ^ 0xffffffff) >>> 0;
}

function write(folder, isBare) {
    const put = (name, text) => {
        fs.mkdirSync(`${folder}/${name}`.replace(/\/[^/]*$/, ''), {recursive: true});
        fs.writeFileSync(`${folder}/${name}`, text);
    };
    const lens = `PINHOLE ${SIZE[0]} ${SIZE[1]} ${FOCAL} ${FOCAL} ${SIZE[0] / 2} ${SIZE[1] / 2}`;
    const poses = photos.map((c, i) =>
        `${i + 1} ${quaternion(c.turn).join(' ')} ${c.turn.map((r) => -dot(r, c.centre)).join(' ')} 1 ${c.id}.exr\n\n`);
    put('views/cameras.txt', `1 ${lens}\n`);
    put('views/images.txt', poses.join(''));
    put('views/points3D.txt', '');
    put('views/lenses.txt', 'remodel-lenses 1\n' + photos.map((c) =>
        `${c.id} ${c.id} ${lens} turn 1 0 0 0\n`).join(''));
    put('model/axes.txt',
        'remodel-axes 1\nrotation 1 0 0 0\ntranslation 0 0 0\n' +
        (isBare ? 'scale 1 unknown\nceiling none\n' : 'scale 1 metres\nceiling 2.5\n') +
        'thickness none\nerror tilt 0\nerror heading 0\nerror floor 0\n' +
        (isBare ? 'error ceiling none\nerror scale none\n' : 'error ceiling 0\nerror scale 0\n'));
    put('points/points.ply', ply());
    for (const c of photos) {
        put(`photos/${c.id}.png`, png(c));
        put(`records/${c.id}.txt`,
            `remodel-photo 2\nfile ${c.id}.png\nhash ${'0'.repeat(32)}\nsize ${SIZE.join(' ')}\nbits 8\norientation 1\nexif 0 0 0 0 0\ncamera "" ""\ntaken 0\n`);
        put(`lines/${c.id}.txt`, 'remodel-lines 1\n');
    }
    put('lines/p0.txt', 'remodel-lines 1\nline 100 100 300 120\n');
}

if (require.main === module) write(process.argv[2], process.argv[3] === 'bare');
module.exports = {photos, project, ROOM};
