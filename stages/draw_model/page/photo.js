/* photo.js - draws a photograph with what is known of the scene over it: the model's edges, points, the floor's grid,
 * what statements drew. Kinds differ in form too, never in colour alone. */
'use strict';

class PhotoPicture {
    constructor(view, live) {
        this.view = view;
        this.live = live;
        this.kept = new Map(); /* what the C code gave for a photo; forgotten when the model changes */
    }

    forget() { this.kept.clear(); }

    keep(key, make) {
        if (!this.kept.has(key)) this.kept.set(key, make());
        return this.kept.get(key);
    }

    edges(photo) { return this.keep('edges' + photo, () => this.live.edges(photo,
        Math.max(1, this.view.size[0] / 500))); }
    points(photo) { return this.keep('points' + photo, () => this.live.points(photo, 30000)); }

    /* {image, photo, scene, shown, drawn, refused, gesture, cursor, selected} */
    draw(what) {
        const c = this.view.begin(), [x, y] = this.view.toScreen(0, 0);
        c.imageSmoothingEnabled = this.view.scale < 3;
        const size = this.view.size.map((s) => s * this.view.scale);
        if (what.image) c.drawImage(what.image, x, y, ...size);
        if (what.draft) this.drawDraft(c, what, [x, y], size);
        if (what.mask) c.drawImage(what.mask, x, y, ...size);
        if (what.shown.points) this.drawPoints(c, what.photo);
        if (what.shown.lines) this.drawLines(c, what.lines);
        if (what.shown.floor) this.drawFloor(c, what.photo);
        if (what.shown.edges) this.drawEdges(c, what.photo);
        for (const d of what.drawn) this.drawMark(c, d, d.refused ? 'refused' : d.current ? 'current' : 'mark');
        if (what.gesture) this.drawMark(c, what.gesture, 'gesture');
        if (what.cursor) this.drawCursor(c, what.cursor, what.snapped);
    }

    /* Where the border's grip is on the screen. */
    grip(split) {
        const [x, y] = this.view.toScreen(split * this.view.size[0], this.view.size[1]), [w, h] = this.view.box();
        return [Math.min(w - 12, Math.max(12, x)), Math.min(h, y) - 24];
    }

    /* Right of the border the pixels that change. */
    drawDraft(c, what, [x, y], size) {
        const at = x + what.split * size[0];
        c.save();
        c.beginPath();
        c.rect(at, y, size[0] + x - at, size[1]);
        c.clip();
        c.imageSmoothingEnabled = true;
        c.drawImage(what.draft, x, y, ...size);
        c.restore();
        c.beginPath();
        c.moveTo(at, y);
        c.lineTo(at, y + size[1]);
        this.stroke(c, '#ffffff', 1.5);
        const [gx, gy] = this.grip(what.split);
        c.beginPath();
        c.arc(gx, gy, 12, 0, 7);
        c.fillStyle = '#ffd24a';
        c.fill();
        c.lineWidth = 2;
        c.strokeStyle = '#000';
        c.stroke();
        c.beginPath();
        c.moveTo(gx - 3, gy - 5), c.lineTo(gx - 8, gy), c.lineTo(gx - 3, gy + 5);
        c.moveTo(gx + 3, gy - 5), c.lineTo(gx + 8, gy), c.lineTo(gx + 3, gy + 5);
        c.stroke();
    }

    path(c, points, close) {
        c.beginPath();
        points.forEach((p, i) => c[i ? 'lineTo' : 'moveTo'](...this.view.toScreen(...p)));
        if (close) c.closePath();
    }

    stroke(c, colour, width, dash = []) {
        c.setLineDash(dash);
        c.strokeStyle = 'rgba(0,0,0,.65)';
        c.lineWidth = width + 2;
        c.stroke();
        c.strokeStyle = colour;
        c.lineWidth = width;
        c.stroke();
        c.setLineDash([]);
    }

    /* Visible edges are thick, hidden ones thin and dotted, those of glass dashed. */
    drawEdges(c, photo) {
        const dots = this.edges(photo), parts = {seen: [], glass: [], hidden: []};
        const apart = Math.max(1, this.view.size[0] / 500) * 6;
        for (let i = 0; i + 5 < dots.length; i += 3) {
            const [u, v, flags, u1, v1, next] = dots.subarray(i, i + 6);
            if (next & 4 || Math.hypot(u1 - u, v1 - v) > apart) continue;
            parts[flags & next & 1 ? (flags & 2 ? 'glass' : 'seen') : 'hidden'].push([u, v, u1, v1]);
        }
        const draw = (list, colour, width, dash, casing) => {
            c.beginPath();
            for (const [u, v, u1, v1] of list) {
                c.moveTo(...this.view.toScreen(u, v));
                c.lineTo(...this.view.toScreen(u1, v1));
            }
            c.setLineDash(dash);
            if (casing) {
                c.strokeStyle = 'rgba(0,0,0,.6)';
                c.lineWidth = width + 2;
                c.stroke();
            }
            c.strokeStyle = colour;
            c.lineWidth = width;
            c.stroke();
            c.setLineDash([]);
        };
        draw(parts.hidden, '#fff2a0', 0.7, [], false);
        draw(parts.glass, '#7cc4ff', 2, [], true);
        draw(parts.seen, '#ff8a3c', 2.4, [], true);
    }

    /* A dash for each axis: lying, upright, a square, a dot. */
    drawPoints(c, photo) {
        const list = this.points(photo), colours = ['#ff9a9a', '#9affb0', '#a9c8ff', '#dddddd'];
        for (let i = 0; i < list.length; i += 3) {
            const [x, y] = this.view.toScreen(list[i], list[i + 1]), kind = list[i + 2];
            c.fillStyle = colours[kind];
            c.fillRect(x - (kind === 0 ? 2 : 0.5), y - (kind === 1 ? 2 : 0.5), kind === 0 ? 4 : kind === 3 ? 1 : 2,
                kind === 1 ? 4 : kind === 3 ? 1 : 2);
        }
    }

    drawLines(c, lines) {
        for (const l of lines) {
            const points = [];
            for (let i = 0; i < l.length; i += 2) points.push([l[i], l[i + 1]]);
            this.path(c, points);
            this.stroke(c, '#d6ff5c', 1, [5, 3]);
        }
    }

    /* A grid on the floor, 13 lines each way, of metres if rooms are about 2.5 high, and the axes from the origin. */
    drawFloor(c, photo) {
        const along = (a, b) => {
            let points = [];
            const flush = (colour, width, dash) => {
                if (points.length > 1) {
                    this.path(c, points);
                    this.stroke(c, colour, width, dash);
                }
                points = [];
            };
            return (colour, width, dash = []) => {
                for (let i = 0; i <= 40; i++) {
                    const t = i / 40, p = a.map((v, k) => v + t * (b[k] - v)), at = this.live.project(photo, p);
                    if (at && at[0] > -200 && at[1] > -200 && at[0] < this.view.size[0] + 200 &&
                        at[1] < this.view.size[1] + 200) points.push([...at]);
                    else flush(colour, width, dash);
                }
                flush(colour, width, dash);
            };
        };
        const unit = this.live.height() / 2.5;
        for (let k = -6; k <= 6; k++) {
            const i = k * unit, far = 6 * unit;
            along([i, -far, 0], [i, far, 0])('#cfd6de', 0.6);
            along([-far, i, 0], [far, i, 0])('#cfd6de', 0.6);
        }
        const names = [['x', [unit, 0, 0], '#ff9a9a', []], ['y', [0, unit, 0], '#9affb0', [8, 3]],
            ['z', [0, 0, unit], '#a9c8ff', [2, 3]]];
        for (const [name, end, colour, dash] of names) {
            along([0, 0, 0], end)(colour, 2.5, dash);
            const at = this.live.project(photo, end);
            if (at) this.label(c, at, name);
        }
    }

    label(c, at, text) {
        const [x, y] = this.view.toScreen(...at);
        c.font = '13px system-ui, sans-serif';
        const width = c.measureText(text).width;
        c.fillStyle = 'rgba(0,0,0,.78)';
        c.fillRect(x + 4, y - 19, width + 8, 19);
        c.fillStyle = '#fff';
        c.fillText(text, x + 8, y - 5);
    }

    drawMark(c, mark, kind) {
        const styles = {mark: ['#ffffff', 1.2, [4, 4]], current: ['#ffd24a', 2, []], refused: ['#ff8a80', 3, [9, 4]],
            gesture: ['#ffd24a', 2, []]};
        const points = mark.kind === 'rectangle' && mark.points.length === 2
            ? [mark.points[0], [mark.points[1][0], mark.points[0][1]], mark.points[1],
                [mark.points[0][0], mark.points[1][1]]]
            : mark.points;
        this.path(c, points, mark.kind === 'rectangle');
        this.stroke(c, ...styles[kind]);
        for (const p of mark.points) {
            const [x, y] = this.view.toScreen(...p);
            c.beginPath();
            if (kind === 'refused') {
                c.moveTo(x - 6, y - 6), c.lineTo(x + 6, y + 6);
                c.moveTo(x + 6, y - 6), c.lineTo(x - 6, y + 6);
            } else
                c.arc(x, y, 3, 0, 7);
            this.stroke(c, styles[kind][0], 1.5);
        }
        if (mark.label) this.label(c, points[0], mark.label);
    }

    drawCursor(c, at, snapped) {
        const [x, y] = this.view.toScreen(...at);
        c.beginPath();
        c.moveTo(x - 12, y), c.lineTo(x + 12, y), c.moveTo(x, y - 12), c.lineTo(x, y + 12);
        this.stroke(c, '#ffffff', 1);
        if (!snapped) return;
        c.beginPath();
        c.rect(x - 6, y - 6, 12, 12);
        this.stroke(c, '#ffd24a', 2);
    }
}
