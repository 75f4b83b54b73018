/* plan.js - the model from above: faces in the order of their distance, ceilings left out, turned by dragging or by
 * arrow keys. */
'use strict';

class SolidPicture {
    constructor(canvas) {
        this.canvas = canvas;
        this.turn = 0.6;
        this.tilt = 0.9;
        this.model = null;
        let from = null;
        canvas.addEventListener('pointerdown', (e) => {
            from = [e.clientX, e.clientY];
            canvas.setPointerCapture(e.pointerId);
        });
        canvas.addEventListener('pointermove', (e) => {
            if (!from) return;
            this.rotate((e.clientX - from[0]) / 100, (e.clientY - from[1]) / 100);
            from = [e.clientX, e.clientY];
        });
        canvas.addEventListener('pointerup', () => { from = null; });
        canvas.addEventListener('keydown', (e) => {
            const by = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]}[e.key];
            if (!by) return;
            e.preventDefault();
            this.rotate(...by);
        });
    }

    rotate(turn, tilt) {
        this.turn += turn;
        this.tilt = Math.min(1.5, Math.max(0.2, this.tilt + tilt));
        this.draw(this.model, this.selected);
    }

    draw(model, selected) {
        this.model = model;
        this.selected = selected;
        const box = this.canvas.getBoundingClientRect(), fine = window.devicePixelRatio || 1;
        this.canvas.width = box.width * fine;
        this.canvas.height = box.height * fine;
        const c = this.canvas.getContext('2d');
        c.setTransform(fine, 0, 0, fine, 0, 0);
        if (!model || !model.vertices.length) return;
        const low = [0, 1, 2].map((k) => Math.min(...model.vertices.map((p) => p[k])));
        const high = [0, 1, 2].map((k) => Math.max(...model.vertices.map((p) => p[k])));
        const middle = low.map((v, k) => (v + high[k]) / 2);
        const radius = Math.hypot(...high.map((v, k) => v - low[k])) / 2;
        const scale = Math.min(box.width, box.height) / 2 / radius;
        const [s, co, st, ct] = [Math.sin(this.turn), Math.cos(this.turn), Math.sin(this.tilt), Math.cos(this.tilt)];
        /* right, down and away from the eye */
        const see = (d) => {
            const x = d[0] * co + d[1] * s, y = -d[0] * s + d[1] * co;
            return [x, -y * st - d[2] * ct, y * ct - d[2] * st];
        };
        const at = model.vertices.map((p) => see(p.map((v, k) => v - middle[k])));
        const faces = [];
        for (const f of model.faces) {
            const n = see(f.normal);
            if (n[2] >= 0 || /^ceiling\//.test(f.name) || /\/(bottom|side)$/.test(f.name)) continue;
            const loop = f.loops[0];
            faces.push({f, away: loop.reduce((sum, i) => sum + at[i][2], 0) / loop.length, light: 0.35 +
                0.5 * Math.abs(n[2]) + 0.15 * Math.max(0, n[0])});
        }
        faces.sort((a, b) => b.away - a.away);
        for (const {f, light} of faces) {
            c.beginPath();
            for (const loop of f.loops)
                loop.forEach((i, k) => c[k ? 'lineTo' : 'moveTo'](box.width / 2 + scale * at[i][0], box.height / 2 +
                    scale * at[i][1]));
            const grey = Math.round(235 * light), on = selected && f.name.split('/')[1] === selected;
            c.fillStyle = on ? '#c99a10' : f.glass ? 'rgba(120,190,255,.5)'
                : `rgb(${grey},${grey},${Math.round(grey * 0.95)})`;
            c.fill('evenodd');
            c.strokeStyle = on ? '#fff' : '#222';
            c.lineWidth = on ? 2 : 0.7;
            c.stroke();
        }
    }
}
