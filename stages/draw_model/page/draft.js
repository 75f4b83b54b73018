/* draft.js - the edited rooms with their texture, over a photograph: a draft of what make remodel draws.
 *
 * The C code says which photo shows what a pixel will show (live_draft_rows); here it gets its colour from there, times
 * how much brighter this photo is than that one, by pixels that show one place in both. Pixels that stay are left out,
 * so that the photo itself is seen. First a coarse picture appears, then a finer one; work goes on in short pieces. */
'use strict';

const LINEAR = Float32Array.from({length: 256}, (_, i) => i <= 10 ? i / 3294.6 : ((i + 14.025) / 269.025) ** 2.4);
const shown8 = (v) => 255 * Math.min(1, v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
const USUAL_ALBEDO = 0.6, SIZES = [120, 480]; /* columns of the pictures, one after the other */

/* The corners of a thing's triangles, nine numbers each, of what draw_shapes.c packed. */
function cornersOf({low, step, corners, triangles}, planes) {
    const count = 3 * (corners + triangles), numbers = new Int32Array(count), made = new Float32Array(9 * triangles);
    for (let i = 0; i < count; i++) {
        const folded = planes[i] | planes[count + i] << 8 | planes[2 * count + i] << 16 | planes[3 * count + i] << 24;
        const before = i < 3 || (i >= 3 * corners && i < 3 * corners + 3) ? 0 : numbers[i - 3];
        numbers[i] = before + ((folded >>> 1) ^ -(folded & 1));
    }
    for (let i = 0; i < 3 * triangles; i++)
        for (let k = 0; k < 3; k++) made[3 * i + k] = low[k] + step * numbers[3 * numbers[3 * corners + i] + k];
    return made;
}

class Draft {
    constructor(live, photos, scene, changed) {
        Object.assign(this, {live, photos, scene, changed, picture: null, running: 0, about: ''});
    }

    /* The furniture, once the cameras are read. names: of the photos, in the order of the C code. */
    async takeThings(names) {
        if (!this.scene.things) return;
        this.things = {masks: [], shapes: []};
        for (const [id, m] of Object.entries(this.scene.things.photos))
            if (names.includes(id)) this.things.masks.push([names.indexOf(id), m.columns, m.rows, await unpack(m.parts)]);
        for (const t of this.scene.things.list)
            this.things.shapes.push(t.shape ? cornersOf(t.shape, await unpack(t.shape.parts)) : null);
        this.giveThings(1);
    }

    /* Hands them to the C code, in a unit of which the scene's own one has so many. */
    giveThings(unit) {
        if (!this.things) return;
        this.scene.things.list.forEach((t, i) => {
            const corners = this.things.shapes[i];
            this.live.call('live_thing', t.name, ...t.middle.map((v) => unit * v), unit * t.radius, t.hangs);
            if (corners) this.live.fillCorners(i, unit === 1 ? corners : corners.map((v) => unit * v));
        });
        for (const mask of this.things.masks) this.live.fillMask(...mask);
    }

    stop() {
        this.running++;
        this.picture = null;
        this.about = '';
    }

    /* Begins with the model that was built last, of an edit. */
    begin(files) {
        this.stop();
        const failed = this.live.call('live_draft', files.script, files.things) ? this.live.error() : '';
        this.ready = !failed;
        return failed;
    }

    /* Makes the draft of a photo. Ends early when another one begins. */
    async make(photo) {
        const run = ++this.running, id = this.photos.list[photo].id;
        this.picture = null;
        if (!this.ready) return;
        for (const columns of SIZES) {
            const {width, height} = this.photos.list[photo], rows = Math.max(1, Math.round(columns * height / width));
            const cells = new Float64Array(5 * columns * rows);
            for (let y = 0; y < rows;) {
                const end = performance.now() + 14;
                for (; y < rows && performance.now() < end; y++)
                    cells.set(this.live.draftRows(photo, columns, rows, y), 5 * columns * y);
                await new Promise((done) => setTimeout(done, 0));
                if (run !== this.running) return;
            }
            const picture = await this.paint(photo, id, cells, columns, rows, run);
            if (run !== this.running) return;
            this.picture = picture;
            this.changed();
        }
    }

    /* How much brighter a photo is than another one, in linear light: the medians of three ratios. */
    gain(photo, other, own, from) {
        const list = this.live.shared(photo, other, 32, 24), ratios = [[], [], []];
        for (let i = 0; i < list.length; i += 4)
            for (let c = 0; c < 3; c++) {
                const a = this.sample(own, this.photos.list[photo], list[i], list[i + 1], c);
                const b = this.sample(from, this.photos.list[other], list[i + 2], list[i + 3], c);
                if (a > 0.002 && b > 0.002 && a < 0.9 && b < 0.9) ratios[c].push(a / b);
            }
        return ratios.map((r) => r.length < 20 ? 1 : Math.min(8, Math.max(0.125, r.sort((a, b) =>
            a - b)[r.length >> 1])));
    }

    /* A channel of a pixel, linear, between four pixels. */
    sample(pixels, size, u, v, channel) {
        const x = Math.min(pixels.width - 1, Math.max(0, u * pixels.width / size.width - 0.5)),
            y = Math.min(pixels.height - 1, Math.max(0, v * pixels.height / size.height - 0.5));
        const x0 = x | 0, y0 = y | 0, x1 = Math.min(pixels.width - 1, x0 + 1), y1 = Math.min(pixels.height - 1, y0 + 1);
        const at = (i, j) => LINEAR[pixels.data[4 * (j * pixels.width + i) + channel]], s = x - x0, t = y - y0;
        return (1 - t) * ((1 - s) * at(x0, y0) + s * at(x1, y0)) + t * ((1 - s) * at(x0, y1) + s * at(x1, y1));
    }

    async paint(photo, id, cells, columns, rows, run) {
        const own = await this.photos.pixelsOf(id), sources = new Map();
        if (!own) return null;
        for (let i = 0; i < cells.length; i += 5)
            if (cells[i] === 0 && cells[i + 1] !== photo) sources.set(cells[i + 1], null);
        await Promise.all([...sources.keys()].map(async (k) => {
            const pixels = await this.photos.pixelsOf(this.photos.list[k].id);
            if (pixels && run === this.running) sources.set(k, {pixels, gain: this.gain(photo, k, own, pixels)});
        }));
        if (run !== this.running) return null;
        sources.set(photo, {pixels: own, gain: [1, 1, 1]});
        const light = this.light(own), image = new ImageData(columns, rows), to = image.data;
        const counts = {stays: 0, taken: 0, colour: 0, unseen: 0}, size = this.photos.list[photo];
        for (let i = 0, at = 0; i < cells.length; i += 5, at += 4) {
            const [kind, k, a, b] = cells.subarray(i, i + 5), x = (i / 5) % columns, y = Math.floor(i / 5 / columns);
            const stays = kind === 0 && k === photo && Math.abs(a - (x + 0.5) * size.width / columns) < 1e-6 &&
                Math.abs(b - (y + 0.5) * size.height / rows) < 1e-6;
            if (stays) {
                counts.stays++;
                continue;
            }
            to[at + 3] = 255;
            const from = kind === 0 && sources.get(k);
            if (from) {
                counts.taken++;
                for (let c = 0; c < 3; c++)
                    to[at + c] = shown8(from.gain[c] * this.sample(from.pixels, this.photos.list[k], a, b, c));
            } else if (kind === 1) {
                counts.colour++;
                for (let c = 0; c < 3; c++) to[at + c] = shown8(cells[i + 2 + c] / USUAL_ALBEDO * light[c]);
            } else {
                counts.unseen++;
                const stripe = ((x + y) * 240 / columns) % 6 < 3;
                to.set(stripe ? [150, 60, 150] : [60, 30, 60], at);
            }
        }
        this.say(counts, columns * rows);
        return createImageBitmap(image);
    }

    /* The median of each channel: the light on a wall of the usual paint. */
    light(pixels) {
        return [0, 1, 2].map((c) => {
            const values = [];
            for (let i = c; i < pixels.data.length; i += 4 * 37) values.push(LINEAR[pixels.data[i]]);
            return values.sort((a, b) => a - b)[values.length >> 1];
        });
    }

    say(counts, all) {
        const share = (n) => n ? `${Math.max(1, Math.round(100 * n / all))} %` : '0 %';
        this.counts = counts;
        this.about = `Right of the border: a draft of what make remodel draws. ${share(all -
            counts.stays)} of the picture changes` +
            (counts.unseen ? `; striped: ${share(counts.unseen)} that no photo shows` : '') +
            `. Not in the draft: new light, and shadows of what comes or goes.` +
            (this.scene.things ? '' : ' Furniture counts as part of the walls, and cannot move, until make things found it; then make draw again.');
    }
}
