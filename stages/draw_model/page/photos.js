/* photos.js - the photographs: scripts that are loaded when a photo is first looked at, since a page from a disk may not
 * have the pixels of picture files. */
'use strict';

class Photos {
    /* list: [{id, width, height}, ...], those of the model first, then reference images */
    constructor(list, changed) {
        this.list = list;
        this.changed = changed;
        this.waiting = new Map(); /* id -> function that takes the bytes */
        this.images = new Map();
        this.pixels = new Map(); /* the last ones that were asked for */
        remodel.photo = (id, text) => this.waiting.get(id)(text);
    }

    small(id) {
        const of = remodel.small[id] || remodel.references[id];
        return of ? 'data:image/jpeg;base64,' + of[2] : '';
    }

    /* A promise of the photo as an image; null if its file is missing. */
    load(id) {
        if (!this.images.has(id))
            this.images.set(id, {image: null, promise: new Promise((done) => {
                const script = document.createElement('script');
                this.waiting.set(id, async (text) => {
                    const image = await createImageBitmap(new Blob([bytesFromBase64(text)], {type: 'image/jpeg'}));
                    this.images.get(id).image = image;
                    script.remove();
                    done(image);
                    this.changed();
                });
                script.onerror = () => done(null);
                script.src = `photos/${encodeURIComponent(id)}.js`;
                document.body.append(script);
            })});
        return this.images.get(id).promise;
    }

    /* The image, or null while it is being loaded. */
    image(id) {
        this.load(id);
        return this.images.get(id).image;
    }

    /* A promise of {data, width, height}, no wider than 1024 px; those of 24 photos are kept. */
    async pixelsOf(id) {
        if (!this.pixels.has(id)) {
            const image = await this.load(id), width = image ? Math.min(1024, image.width) : 0;
            if (!image) return null;
            const canvas = new OffscreenCanvas(width, Math.max(1, Math.round(image.height * width / image.width)));
            const context = canvas.getContext('2d', {willReadFrequently: true});
            context.drawImage(image, 0, 0, canvas.width, canvas.height);
            this.pixels.set(id, context.getImageData(0, 0, canvas.width, canvas.height));
        }
        const pixels = this.pixels.get(id);
        this.pixels.delete(id);
        this.pixels.set(id, pixels);
        while (this.pixels.size > 24) this.pixels.delete(this.pixels.keys().next().value);
        return pixels;
    }
}
