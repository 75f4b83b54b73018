/* canvas.js - a photograph in a canvas: how far it is enlarged, and where its pixels are on the screen. */
'use strict';

class PhotoView {
    constructor(canvas) {
        this.canvas = canvas;
        this.scale = 0; /* screen px per photo px; 0: the whole photo is shown */
        this.at = [0, 0]; /* photo pixel at the canvas's upper left corner */
        this.size = [1, 1];
    }

    /* width, height: of the stored photo */
    setPhoto(width, height) {
        this.size = [width, height];
        this.showAll();
    }

    box() {
        const r = this.canvas.getBoundingClientRect();
        return [r.width || 1, r.height || 1];
    }

    showAll() {
        const [w, h] = this.box();
        this.scale = Math.min(w / this.size[0], h / this.size[1]);
        this.at = [(this.size[0] - w / this.scale) / 2, (this.size[1] - h / this.scale) / 2];
        this.whole = true;
    }

    /* Enlarges by a factor about a photo pixel. */
    zoom(factor, u, v) {
        const [w, h] = this.box(), least = Math.min(w / this.size[0], h / this.size[1]);
        const scale = Math.min(40, Math.max(least, this.scale * factor)), by = this.scale / scale;
        this.at = [u - (u - this.at[0]) * by, v - (v - this.at[1]) * by];
        this.scale = scale;
        this.whole = false;
        if (scale === least) this.showAll();
    }

    pan(dx, dy) {
        this.at = [this.at[0] - dx / this.scale, this.at[1] - dy / this.scale];
        this.whole = false;
    }

    /* Moves the picture so that a pixel is in sight. */
    reveal(u, v) {
        const [x, y] = this.toScreen(u, v), [w, h] = this.box(), edge = 30;
        this.at[0] += (Math.min(0, x - edge) + Math.max(0, x - w + edge)) / this.scale;
        this.at[1] += (Math.min(0, y - edge) + Math.max(0, y - h + edge)) / this.scale;
    }

    toScreen(u, v) { return [(u - this.at[0]) * this.scale, (v - this.at[1]) * this.scale]; }

    toPhoto(event) {
        const r = this.canvas.getBoundingClientRect();
        return [(event.clientX - r.left) / this.scale + this.at[0], (event.clientY - r.top) / this.scale + this.at[1]];
    }

    clamp([u, v]) { return [Math.min(this.size[0], Math.max(0, u)), Math.min(this.size[1], Math.max(0, v))]; }

    /* A context in screen pixels, for a canvas that is as fine as the screen. */
    begin() {
        const [w, h] = this.box(), fine = window.devicePixelRatio || 1;
        if (this.canvas.width !== Math.round(w * fine) || this.canvas.height !== Math.round(h * fine)) {
            this.canvas.width = Math.round(w * fine);
            this.canvas.height = Math.round(h * fine);
        }
        const context = this.canvas.getContext('2d');
        context.setTransform(fine, 0, 0, fine, 0, 0);
        context.clearRect(0, 0, w, h);
        return context;
    }
}
