// relit.js - photographs in the light that is chosen: sums of parts that LUX/relit.js has, as
// stages/light_levels/relit_picture.c draws them.
'use strict';

const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

// Light: 0 is none, otherwise the logarithm between most / 1e7 and most in 16 bits.
const lightOf = (text, most) => {
    const bytes = bytesOf(text), values = new Float32Array(bytes.length / 2), span = Math.log(1e7) / 65534;
    for (let i = 0; i < values.length; i++) {
        const n = bytes[2 * i] + 256 * bytes[2 * i + 1];
        values[i] = n ? most / 1e7 * Math.exp(span * (n - 1)) : 0;
    }
    return values;
};

// Numbers of either sign, up to most.
const signedOf = (text, most) => {
    const bytes = bytesOf(text), values = new Float32Array(bytes.length / 2);
    for (let i = 0; i < values.length; i++)
        values[i] = most * (bytes[2 * i] + 256 * bytes[2 * i + 1] - 32768) / 32767;
    return values;
};

// Runs of equal numbers.
const runsOf = (text, count) => {
    const bytes = bytesOf(text), values = new Int32Array(count);
    let at = 0, filled = 0;
    const number = () => {
        let n = 0, shift = 0;
        for (;; shift += 7) {
            const b = bytes[at++];
            n |= (b & 127) << shift;
            if (b < 128) return n;
        }
    };
    while (at < bytes.length) {
        const run = number(), value = number();
        values.fill(value, filled, filled += run);
    }
    return values;
};

const CURVE = new Uint8Array(4097).map((_, i) => {
    const v = i / 4096;
    return Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
});
const LINEAR = new Float32Array(256).map((_, i) => {
    const v = i / 255;
    return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
});
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const clamp = (v, low, high) => Math.min(high, Math.max(low, v));

// What the file of a variant says.
class RelitLight {
    constructor(text) {
        Object.assign(this, {lamps: [], windows: [], fields: [], skies: [], faces: [], photos: [], normals: []});
        for (const line of text.split('\n')) {
            const [word, ...rest] = line.split(' ');
            if (this[`read_${word}`]) this[`read_${word}`](rest);
        }
    }
    name(word) { return word === '.' ? '' : decodeURIComponent(word); }
    read_places([places, things, suns]) {
        Object.assign(this, {places: Number(places), things: Number(things), suns: Number(suns)});
    }
    read_scale([v]) { this.scale = Number(v); }
    read_horizontal([v]) { this.horizontal = Number(v); }
    read_lamp([name]) { this.lamps.push({name: this.name(name)}); }
    read_rest() { this.lamps.push({name: ''}); }
    read_planned([name]) { this.lamps.push({name: this.name(name), planned: true}); }
    read_window([name]) { this.windows.push(this.name(name)); }
    read_field([kind, of, most, data]) {
        const values = kind === 'part' ? signedOf(data, Number(most)) : lightOf(data, Number(most));
        this.fields.push({kind, of: Number(of), values});
        if (kind === 'texture') this.texture = values;
    }
    read_sky([, , , , horizontal, sun, x, y, z, shade, ...mixes]) {
        this.skies.push({horizontal: Number(horizontal), sun: Number(sun), toSun: [x, y, z].map(Number),
            shade: Number(shade), mixes: mixes.map(Number)});
    }
    read_face(words) {
        const n = words.slice(0, 16).map(Number);
        this.faces.push({normal: n.slice(0, 3), offset: n[3], u: n.slice(4, 7), v: n.slice(7, 10), low: n.slice(10, 12),
            step: n.slice(12, 14), columns: n[14], rows: n[15], places: runsOf(words[16], n[14] * n[15])});
    }
    read_normals([data]) { this.normals = signedOf(data, 1); }
    read_photo([name, width, height, x, y, z, rays]) {
        this.photos.push({name: this.name(name), width: Number(width), height: Number(height),
            from: [x, y, z].map(Number), rays: signedOf(rays, 1), shades: []});
    }
    last() { return this.photos[this.photos.length - 1]; }
    read_pixels([data]) { this.last().pixels = runsOf(data, this.last().width * this.last().height); }
    read_shade([k, data]) { this.last().shades[Number(k)] = data; }
    read_picture([data]) { this.last().jpeg = data; }

    // The light of a choice at all places, with factors of lamps, windows and the sun.
    sum(choice) {
        const lx = 1 / (this.scale > 0 ? this.scale : 1), light = new Float32Array(3 * this.places);
        const photos = this.scale > 0 || !choice.isAbsolute();
        const add = (values, by) => {
            for (let i = 0; by && i < light.length; i++) light[i] += by * values[i];
        };
        const lamps = this.lamps.map((l) => (photos || l.planned ? choice.lamp(l.name) : 0));
        const blinds = this.windows.map((w, i) => (i < this.windows.length - 1 ? choice.blind(w) : 1));
        const photographed = choice.sky === 'photographed' && photos, sky = this.skies[choice.skyNumber()];
        let part = 0, level = null;
        for (const f of this.fields) {
            if (f.kind === 'lamp') add(f.values, lamps[f.of] * (this.lamps[f.of].planned ? lx : 1));
            if (f.kind === 'window' && photographed) add(f.values, blinds[f.of]);
            if (f.kind === 'level') level = f;
            if (f.kind === 'part' && sky) this.addPart(light, level, f, lx * blinds[f.of] * sky.mixes[part]);
            part += f.kind === 'part';
        }
        return {light, lamps, blinds, sun: sky ? lx * sky.sun : 0, toSun: sky ? sky.toSun : [0, 0, -1],
            shade: sky ? sky.shade : -1, outdoors: blinds.map((b) => (photographed ? b :
                sky && this.horizontal > 0 ? b * lx * sky.horizontal / this.horizontal : 0))};
    }

    addPart(light, level, part, by) {
        for (let i = 0; by && i < light.length; i++) light[i] += by * level.values[i] * part.values[i];
    }
}

// One photograph on a canvas.
class RelitPhoto {
    constructor(canvas, light, photo) {
        Object.assign(this, {canvas, light, photo, shades: new Map()});
        canvas.width = photo.width;
        canvas.height = photo.height;
        const faces = 1 + light.windows.length + light.lamps.length;
        Object.assign(this, {faces, things: faces + light.faces.length});
    }

    // Reads the picture, and finds the places and weights of each pixel.
    async prepare() {
        const {width, height, jpeg, pixels} = this.photo, count = width * height, image = new Image();
        image.src = `data:image/jpeg;base64,${jpeg}`;
        await image.decode();
        const to = this.canvas.getContext('2d', {willReadFrequently: true});
        to.drawImage(image, 0, 0);
        this.data = to.getImageData(0, 0, width, height);
        const base = this.base = new Float32Array(3 * count);
        for (let i = 0; i < count; i++) for (let c = 0; c < 3; c++) base[3 * i + c] = LINEAR[this.data.data[4 * i + c]];
        this.at = new Int32Array(4 * count);
        this.weights = new Float32Array(4 * count);
        for (let i = 0; i < count; i++) if (pixels[i] >= this.faces) this.preparePixel(i);
        this.values = new Float32Array(3 * count);
    }

    preparePixel(i) {
        const {at, weights, light, photo, base} = this, number = photo.pixels[i], texture = [0, 0, 0];
        if (number >= this.things) {
            at[4 * i] = light.things + number - this.things;
            weights[4 * i] = 1;
        } else this.findCells(i, light.faces[number - this.faces]);
        for (let k = 4 * i; k < 4 * i + 4; k++)
            for (let c = 0; c < 3; c++) texture[c] += weights[k] * light.texture[3 * at[k] + c];
        for (let c = 0; c < 3; c++) base[3 * i + c] = texture[c] > 0 ? base[3 * i + c] / texture[c] : 0;
    }

    ray(x, y) {
        const {width, height, rays} = this.photo, size = (n) => Math.floor((n + 6) / 8) + 1;
        const columns = size(width), rows = size(height), column = x >> 3, row = y >> 3;
        const right = Math.min(column + 1, columns - 1), below = Math.min(row + 1, rows - 1);
        const wide = Math.min(8 * right, width - 1) - 8 * column, tall = Math.min(8 * below, height - 1) - 8 * row;
        const a = wide > 0 ? (x - 8 * column) / wide : 0, b = tall > 0 ? (y - 8 * row) / tall : 0, to = [0, 0, 0];
        for (let k = 0; k < 4; k++) {
            const from = 3 * ((k & 2 ? below : row) * columns + (k & 1 ? right : column));
            const weight = (k & 1 ? a : 1 - a) * (k & 2 ? b : 1 - b);
            if (Math.abs(rays[from]) + Math.abs(rays[from + 1]) + Math.abs(rays[from + 2]) < 0.5) return null;
            for (let c = 0; c < 3; c++) to[c] += weight * rays[from + c];
        }
        return to;
    }

    findCells(i, f) {
        const {width, from} = this.photo, ray = this.ray(i % width, Math.floor(i / width));
        const t = ray ? (f.offset - dot(f.normal, from)) / dot(f.normal, ray) : 0;
        if (!(t > 0) || !Number.isFinite(t)) return;
        const at = from.map((v, c) => v + t * ray[c]);
        const a = clamp((dot(f.u, at) - f.low[0]) / f.step[0] - 0.5, 0, f.columns - 1);
        const b = clamp((dot(f.v, at) - f.low[1]) / f.step[1] - 0.5, 0, f.rows - 1);
        const column = Math.min(Math.floor(a), Math.max(0, f.columns - 2));
        const row = Math.min(Math.floor(b), Math.max(0, f.rows - 2));
        for (let k = 0; k < 4; k++) {
            const weight = (k & 1 ? a - column : 1 - a + column) * (k & 2 ? b - row : 1 - b + row);
            const place = weight > 0 ? f.places[(row + (k >> 1)) * f.columns + column + (k & 1)] - 1 : -1;
            if (place < 0) continue;
            this.at[4 * i + k] = place;
            this.weights[4 * i + k] = weight;
        }
    }

    shade(k) {
        const {width, height, shades} = this.photo;
        if (k < 0 || !shades[k]) return null;
        if (!this.shades.has(k)) this.shades.set(k, runsOf(shades[k], (width >> 1) * (height >> 1)));
        return this.shades.get(k);
    }

    // Linear values before exposure, of a sum of RelitLight.
    add(sum) {
        const {base, values, at, weights, light, faces} = this, {pixels, width, height} = this.photo;
        const shade = this.shade(sum.shade), half = width >> 1, lamps = 1 + light.windows.length, mean = this.mean(sum);
        for (let i = 0; i < pixels.length; i++) {
            const number = pixels[i];
            let r = 0, g = 0, b = 0;
            if (number >= faces) {
                for (let k = 4 * i; k < 4 * i + 4; k++) {
                    const w = weights[k], p = 3 * at[k];
                    r += w * sum.light[p];
                    g += w * sum.light[p + 1];
                    b += w * sum.light[p + 2];
                }
                if (shade) {
                    const x = i % width, y = Math.floor(i / width);
                    let part = 0;
                    for (let k = 0; k < 4; k++) {
                        const row = Math.min((y + (k >> 1)) >> 1, (height >> 1) - 1);
                        const window = shade[row * half + Math.min((x + (k & 1)) >> 1, half - 1)];
                        if (window) part += sum.blinds[window - 1] / 4;
                    }
                    const sun = part > 0 ? part * sum.sun * Math.max(0, dot(this.normal(number), sum.toSun)) : 0;
                    r += sun;
                    g += sun;
                    b += sun;
                }
            } else if (number >= lamps) {
                r = g = b = sum.lamps[number - lamps];
            } else if (number) r = g = b = sum.outdoors[number - 1];
            const lamp = number >= lamps && number < faces ? sum.lamps[number - lamps] : 1;
            const cover = 0.4 * mean * Math.max(0, 1 - lamp);
            values[3 * i] = r * base[3 * i] + cover;
            values[3 * i + 1] = g * base[3 * i + 1] + cover;
            values[3 * i + 2] = b * base[3 * i + 2] + cover;
        }
    }

    normal(number) {
        const k = 3 * (number - this.things), {faces, normals} = this.light;
        return k < 0 ? faces[number - this.faces].normal : normals.subarray(k, k + 3);
    }

    mean(sum) {
        let light = 0, texture = 0;
        for (let k = 1; k < sum.light.length; k += 3) {
            light += sum.light[k];
            texture += this.light.texture[k];
        }
        return texture > 0 ? light / texture : 0;
    }

    // The exposure at which nearly the brightest pixels of the room are at 0.8.
    wellExposed() {
        const {width, height, pixels} = this.photo, found = [], v = this.values;
        for (let y = 0; y < height; y += 4)
            for (let x = 0; x < width; x += 4) {
                const i = y * width + x;
                if (pixels[i] < this.faces) continue;
                found.push(0.2126 * v[3 * i] + 0.7152 * v[3 * i + 1] + 0.0722 * v[3 * i + 2]);
            }
        found.sort((a, b) => a - b);
        const bright = found.length ? found[Math.floor(0.95 * (found.length - 1))] : 0;
        return bright > 0 ? 0.8 / bright : 1;
    }

    paint(exposure) {
        const to = this.data.data, v = this.values, count = v.length / 3;
        for (let i = 0; i < count; i++)
            for (let c = 0; c < 3; c++)
                to[4 * i + c] = CURVE[Math.min(4096, Math.round(4096 * exposure * v[3 * i + c]))];
        this.canvas.getContext('2d').putImageData(this.data, 0, 0);
    }
}

// The photographs of all variants, each read when it is first wanted.
class RelitPhotos {
    constructor(variants) {
        this.files = variants.map((v) => v.relit);
        this.lights = [];
        this.place = byId('relit');
        this.how = byId('exposure');
        this.kept = new Map();
        this.busy = false;
        this.how.addEventListener('change', () => this.show(this.choice));
        byId('in-photos').hidden = !this.files[0];
    }

    // Loads the script of a variant, which calls remodelRelit().
    load(number) {
        if (!this.lights[number])
            this.lights[number] = new Promise((done) => {
                const script = make('script', {src: this.files[number]});
                window.remodelRelit = (text) => done(new RelitLight(text));
                script.addEventListener('error', () => done(null));
                document.head.append(script);
            }).then(async (light) => {
                if (!light) return [];
                const photos = light.photos.map((p) => new RelitPhoto(make('canvas', {role: 'img'}), light, p));
                for (const p of photos) await p.prepare();
                return photos;
            });
        return this.lights[number];
    }

    // Draws the newest choice; those that come while it is drawn are left out.
    async show(choice) {
        this.choice = choice;
        this.wanted = true;
        if (this.busy || !this.files[choice.shownVariant()]) return;
        this.busy = true;
        while (this.wanted) {
            this.wanted = false;
            const number = this.choice.shownVariant(), photos = await this.load(number);
            if (number !== this.shown) {
                this.shown = number;
                this.place.replaceChildren(...photos.map((p) => make('figure', {}, p.canvas,
                    make('figcaption', {}, ''))));
            }
            for (const p of photos) {
                this.draw(p);
                await new Promise(requestAnimationFrame);
            }
        }
        this.busy = false;
    }

    draw(p) {
        const name = p.photo.name, sum = p.light.sum(this.choice);
        p.add(sum);
        const own = p.wellExposed(), how = this.how.value;
        const exposure = how === 'photo' ? (p.light.scale > 0 || !this.choice.isAbsolute() ? 1 : own) :
            how === 'kept' && this.kept.has(name) ? this.kept.get(name) : own;
        this.kept.set(name, exposure);
        p.paint(exposure);
        const dark = !sum.light.some((v) => v > 0);
        const relative = p.light.scale > 0 || !this.choice.isAbsolute();
        const words = dark ? 'no light' : relative ? `exposed ${shown(exposure)} times as the photograph` :
            'well exposed';
        p.canvas.nextElementSibling.textContent = `${name}: ${words}`;
        p.canvas.setAttribute('aria-label', `Photograph ${name} in this light, ${words}`);
    }
}
