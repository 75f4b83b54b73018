/* masks.js - masks of photos: pixels to ignore, drawn as polygons, saved as masks/PHOTO.png.
 *
 * masks.txt is not a file of the scene: its lines are what was drawn on this page, "hide in PHOTO X Y X Y ..." and
 * "show in PHOTO ...", in order, over the mask that the scene has. */
'use strict';

class Masks {
    /* given: PHOTO -> PNG as base64; changed: called when a picture was read */
    constructor(given, photos, texts, changed) {
        Object.assign(this, {photos, texts, pictures: new Map(), kept: new Map()});
        for (const [id, text] of Object.entries(given || {}))
            createImageBitmap(new Blob([bytesFromBase64(text)], {type: 'image/png'})).then((image) => {
                this.pictures.set(id, image);
                this.kept.clear();
                changed();
            });
    }

    strokes(id, text = this.texts.get('masks.txt')) {
        return Script.statements(text).map((s) => s.words).filter((w) => /^(hide|show)$/.test(w[0]) && w[1] === 'in' &&
            w[2] === id && w.length >= 9);
    }

    ids(text) { return [...new Set(Script.statements(text).map((s) => s.words[2]))].filter((id) => id); }

    /* White, black where pixels are ignored. null: the photo has no mask. */
    draw(id, width) {
        const of = this.photos.list.find((p) => p.id === id), strokes = this.strokes(id), given = this.pictures.get(id);
        if (!of || (!strokes.length && !given)) return null;
        const canvas = new OffscreenCanvas(width, Math.round(of.height * width / of.width)), c = canvas.getContext('2d');
        c.fillStyle = '#fff';
        c.fillRect(0, 0, canvas.width, canvas.height);
        if (given) c.drawImage(given, 0, 0, canvas.width, canvas.height);
        c.scale(canvas.width / of.width, canvas.height / of.height);
        for (const w of strokes) {
            c.beginPath();
            for (let i = 3; i + 1 < w.length; i += 2) c[i === 3 ? 'moveTo' : 'lineTo'](+w[i], +w[i + 1]);
            c.fillStyle = w[0] === 'hide' ? '#000' : '#fff';
            c.fill();
        }
        return canvas;
    }

    /* What is hidden, striped, 512 px wide, and its share of the photo. null: nothing. */
    overlay(id) {
        const key = id + '\n' + this.strokes(id).map((w) => w.join(' ')).join('\n');
        if (!this.kept.has(key)) {
            const canvas = this.draw(id, 512);
            let hidden = 0;
            if (canvas) {
                const c = canvas.getContext('2d'), image = c.getImageData(0, 0, canvas.width, canvas.height);
                for (let i = 0; i < image.data.length; i += 4) {
                    const is = image.data[i] < 128, stripe = ((i >> 2) % canvas.width + Math.floor((i >> 2) /
                        canvas.width)) % 12 < 6;
                    hidden += is;
                    image.data.set(is ? stripe ? [0, 0, 0, 235] : [255, 210, 74, 200] : [0, 0, 0, 0], i);
                }
                c.putImageData(image, 0, 0);
                hidden /= image.data.length / 4;
            }
            this.kept.set(key, canvas && {canvas, share: hidden});
        }
        return this.kept.get(key);
    }

    share(id) {
        const of = this.overlay(id);
        return of ? of.share : null;
    }

    /* A promise of the PNG, of the size of the stored photo, black and white alone. */
    async png(id) {
        const canvas = this.draw(id, this.photos.list.find((p) => p.id === id).width), c = canvas.getContext('2d'),
            image = c.getImageData(0, 0, canvas.width, canvas.height);
        for (let i = 0; i < image.data.length; i += 4) {
            const v = image.data[i] < 128 ? 0 : 255;
            image.data.set([v, v, v, 255], i);
        }
        c.putImageData(image, 0, 0);
        return canvas.convertToBlob({type: 'image/png'});
    }
}
