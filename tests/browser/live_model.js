/* live_model.js WASM FOLDER SCENE... - builds scenes/S/model.txt and each of its edits by the WebAssembly module, from the
 * files below FOLDER, and writes the products of the model and of edit E to FOLDER/live/model and FOLDER/live/E. What is
 * refused goes to refused.txt there. */
'use strict';
const fs = require('fs');
const {WasiFiles} = require('../../stages/draw_model/page/wasi.js');
const {Live} = require('../../stages/draw_model/page/live.js');
const [wasm, folder, scene] = process.argv.slice(2);

const system = new WasiFiles();
const add = (name, path) => { if (fs.existsSync(path)) system.files.set(name, new Uint8Array(fs.readFileSync(path))); };
for (const f of ['cameras', 'images', 'points3D', 'lenses']) add(`out/views/${f}.txt`, `${folder}/views/${f}.txt`);
add('out/model/axes.txt', `${folder}/model/axes.txt`);
add('out/points/points.ply', `${folder}/points/points.ply`);
for (const f of ['model', 'things', 'objects']) add(`${scene}/${f}.txt`, `${scene}/${f}.txt`);
const edits = fs.existsSync(`${scene}/edits`) ? fs.readdirSync(`${scene}/edits`).filter((f) =>
    f.endsWith('.txt')).sort() : [];
for (const e of edits) add(`${scene}/edits/${e}`, `${scene}/edits/${e}`);

const live = new Live(fs.readFileSync(wasm), system);
const failed = live.begin({views: 'out/views', axes: 'out/model/axes.txt', points: 'out/points/points.ply'});
if (failed) {
    console.error(failed);
    process.exit(1);
}
for (const edit of ['', ...edits]) {
    const made = `${folder}/live/${edit ? edit.replace('.txt', '') : 'model'}`;
    const refused = live.build({script: `${scene}/model.txt`, things: system.files.has(`${scene}/things.txt`)
        ? `${scene}/things.txt` : '',
        edit: edit && `${scene}/edits/${edit}`, scene: edit && scene, base: edit && 'out/model/model.txt'}) ||
            live.write('made') || live.writePlan('made/plan.svg');
    fs.mkdirSync(made, {recursive: true});
    if (refused) fs.writeFileSync(`${made}/refused.txt`, refused + '\n');
    for (const [name, bytes] of [...system.files]) {
        if (!name.startsWith('made/')) continue;
        fs.writeFileSync(`${made}/${name.slice(5)}`, bytes);
        if (!edit && name === 'made/model.txt') system.files.set('out/model/model.txt', bytes);
        system.files.delete(name);
    }
}
