/* draw_pictures.js FOLDER [PICTURES] - what the page of `draw` shows of the room of room.js, against pictures that were looked
 * at: plan, 3D view and photograph, in tests/browser/pictures. PICTURES: a folder to write them to anew. Prints "ok NAME" or
 * "not ok NAME: WHY".
 *
 * Means of squares of 8 px are compared, without words: browsers smooth lines, and machines have fonts, in their own ways,
 * which moves such a mean by some levels of 255. A line of 2 px that is missing, or stands 2 px away, moves those that it
 * crosses by a quarter of its contrast, 30 levels or more. At most 0.5 % of the squares may be more than 20 levels off. */
'use strict';
const fs = require('fs');
const path = require('path');
const {check, runTests} = require('./hand.js');
const [folder, to] = process.argv.slice(2), kept = path.join(__dirname, 'pictures');
const ROOM = `remodel-script 1
wall south from 4 0 to 0 0
wall west from 0 0 to 0 3
wall north from 0 3 to 4 3
wall east from 4 3 to 4 0
join south west north east south
room main south west north east
door door1 on south from 1 0 to 1.8 2
window window1 on north from 1.2 0.9 to 2.8 2.1
box chest from 0.2 0.4 to 1.2 1 top 0.7
`;
/* without words, and of sizes that fonts do not change */
const STILL = `#plan text, #plan-larger { visibility: hidden }
    #stage { position: fixed; left: 0; top: 0; width: 640px; height: 480px; z-index: 9 }
    #pictures { position: fixed; left: 648px; top: 0; width: 560px; height: 280px; z-index: 9 }`;
const PARTS = {plan: '#plan svg', model: '#solid', photo: '#canvas'};

/* A picture of an element as a PNG, in base64. */
async function picture(page, selector) {
    await page.run('new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 50))))');
    const clip = await page.run(`(() => { const r = document.querySelector('${selector}').getBoundingClientRect();
        return {x: r.left, y: r.top, width: r.width, height: r.height, scale: 1}; })()`);
    return (await page.send('Page.captureScreenshot', {format: 'png', clip})).data;
}

/* [share of squares that differ, the largest difference] */
function difference(page, a, b) {
    return page.run(`(async () => {
        const means = async (text) => {
            const p = await createImageBitmap(await (await fetch('data:image/png;base64,' + text)).blob());
            const w = p.width >> 3, h = p.height >> 3, c = new OffscreenCanvas(p.width, p.height).getContext('2d');
            c.drawImage(p, 0, 0);
            const d = c.getImageData(0, 0, p.width, p.height).data, sums = new Float64Array(3 * w * h);
            for (let y = 0; y < 8 * h; y++)
                for (let x = 0; x < 8 * w; x++)
                    for (let k = 0; k < 3; k++) sums[3 * ((y >> 3) * w + (x >> 3)) + k] += d[4 * (y * p.width + x) + k] / 64;
            return {sums, w, h};
        };
        const a = await means('${a}'), b = await means('${b}');
        if (a.w !== b.w || a.h !== b.h) return [1, 255];
        let most = 0, off = 0;
        for (let i = 0; i < a.w * a.h; i++) {
            const by = Math.max(...[0, 1, 2].map((k) => Math.abs(a.sums[3 * i + k] - b.sums[3 * i + k])));
            most = Math.max(most, by);
            off += by > 20;
        }
        return [off / (a.w * a.h), most];
    })()`);
}

const show = async (hand, text) => {
    await hand.begin(text);
    await hand.photo('p2');
    await hand.page.run("app.selected = []; app.refresh && app.refresh(); document.activeElement.blur()");
};

const tests = {};
for (const [part, selector] of Object.entries(PARTS))
    tests[`the_${part}_looks_as_it_did`] = async (hand) => {
        await hand.page.run(`document.querySelector('#still') || document.head.append(Object.assign(document.createElement('style'),
            {id: 'still', textContent: ${JSON.stringify(STILL)}}))`);
        await show(hand, ROOM);
        const now = await picture(hand.page, selector), file = path.join(kept, `${part}.png`);
        if (to) {
            fs.mkdirSync(to, {recursive: true});
            fs.writeFileSync(path.join(to, `${part}.png`), Buffer.from(now, 'base64'));
            return;
        }
        const [off, most] = await difference(hand.page, now, fs.readFileSync(file).toString('base64'));
        console.log(`# ${part}: ${(100 * off).toFixed(2)} % of the squares differ, at most by ${most.toFixed(0)} levels`);
        if (off > 0.005) fs.writeFileSync(path.join(folder, `${part}-now.png`), Buffer.from(now, 'base64'));
        check(off <= 0.005, `${(100 * off).toFixed(1)} % of its squares differ from ${file}; look at ${folder}/${part}-now.png`);
        await show(hand, ROOM.replace(/^window.*\n/m, ''));
        const [without] = await difference(hand.page, await picture(hand.page, selector), now);
        check(without > 0.005, 'without its window it looks the same');
    };
runTests(tests, folder, []);
