/* shapes.js PAGE THINGS - surfaces of furniture as scene.js has them, against the boxes of things.txt: each box is filled to its
 * borders, and nothing is beyond. Prints how many were compared. */
'use strict';
const fs = require('fs'), vm = require('vm'), zlib = require('zlib');
const [, , page, things] = process.argv;
const read = (path) => fs.readFileSync(path, 'utf8');
const world = {remodel: {}};
vm.createContext(world);
vm.runInContext(read(`${page}/scene.js`), world);
vm.runInContext(read('stages/draw_model/page/draft.js') + '\nthis.cornersOf = cornersOf;', world);
const boxes = new Map(read(things).split('\n').filter((l) => l.startsWith('thing ')).map((l) => l.split(' '))
    .map((w) => [w[1], [w.slice(3, 6).map(Number), w.slice(6, 9).map(Number)]]));
let count = 0, triangles = 0;
for (const t of world.remodel.scene.things.list) {
    if (!t.shape) continue;
    const planes = zlib.inflateSync(Buffer.concat(t.shape.parts.map((p) => Buffer.from(p, 'base64'))));
    const c = world.cornersOf(t.shape, planes), [low, high] = boxes.get(t.name), slack = 0.06 * Math.hypot(...high.map((v, k) => v - low[k])) + 0.05;
    for (let k = 0; k < 3; k++) {
        let least = Infinity, most = -Infinity;
        for (let i = k; i < c.length; i += 3) least = Math.min(least, c[i]), most = Math.max(most, c[i]);
        if (!(Math.abs(least - low[k]) < slack && Math.abs(most - high[k]) < slack))
            throw new Error(`${t.name}: coordinate ${k} from ${least} to ${most}, wanted ${low[k]} to ${high[k]}`);
    }
    count++;
    triangles += t.shape.triangles;
}
if (!count) throw new Error('no thing has a surface');
console.log(`ok surfaces of ${count} things, ${triangles} triangles`);
