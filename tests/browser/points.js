/* points.js PAGE PLY [MOST] - reads points.js of a page as the page does, and compares it with the points of PLY: with
 * all, or with every nth, so that there are at most MOST. */
'use strict';
const fs = require('fs');
const zlib = require('zlib');
const {plyOfPoints} = require('../../stages/draw_model/page/points.js');
const [page, ply, most = Infinity] = process.argv.slice(2);

let packed = null;
new Function('remodel', fs.readFileSync(`${page}/points.js`, 'utf8'))({points: (p) => { packed = p; }});
const bytes = zlib.inflateSync(Buffer.concat(packed.parts.map((t) => Buffer.from(t, 'base64'))));
const read = (file) => {
    const start = file.indexOf('end_header\n') + 11, list = [];
    for (let i = start; i < file.length; i += 45)
        list.push([0, 1, 2].map((k) => file.readDoubleLE(i + 8 * k)).concat([0, 1, 2].map((k) => file.readFloatLE(i + 24 +
            4 * k)), file.readFloatLE(i + 41)));
    return list;
};
const got = read(Buffer.from(plyOfPoints(packed, bytes))), all = read(fs.readFileSync(ply)),
    every = Math.max(1, Math.ceil(all.length / +most)), wanted = all.filter((_, i) => i % every === 0);
let off = 0, turn = 0, sure = 0;
for (let i = 0; i < wanted.length; i++) {
    const [a, b] = [got[i], wanted[i]], along = a[3] * b[3] + a[4] * b[4] + a[5] * b[5];
    for (let k = 0; k < 3; k++) off = Math.max(off, Math.abs(a[k] - b[k]));
    turn = Math.max(turn, Math.acos(Math.min(1, along)) * 180 / Math.PI);
    sure = Math.max(sure, Math.abs(a[6] - b[6]));
}
console.log(`# ${got.length} points of ${all.length}, ${(fs.statSync(`${page}/points.js`).size / got.length).toFixed(1)} bytes each: at most ${off.toPrecision(3)} off, ${turn.toFixed(2)} degrees, confidence ${sure.toFixed(4)}`);
process.exit(got.length === wanted.length && packed.every === every && off <= packed.step / 2 + 1e-12 && turn < 1 &&
    sure < 0.003 ? 0 : 1);
