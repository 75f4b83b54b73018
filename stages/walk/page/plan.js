// plan.js - the floor plan, with viewpoints, the tour's route and the place where one stands.
'use strict';

class Plan {
    // go(x, y): somebody chose a place; choose(place): a viewpoint
    constructor(svg, scene, go, choose) {
        Object.assign(this, {svg, scene, go, choose});
        this.ask = svg.createSVGPoint();
        svg.addEventListener('click', (e) => {
            Object.assign(this.ask, {x: e.clientX, y: e.clientY});
            const p = this.ask.matrixTransform(svg.getScreenCTM().inverse());
            const stand = e.target.dataset && e.target.dataset.place;
            if (stand !== undefined)
                choose(+stand);
            else
                go(p.x, -p.y);
        });
    }
    show(model) {
        const {svg, scene} = this, low = model.low, high = model.high,
                    size = Math.max(high[0] - low[0], high[1] - low[1]);
        const edge = 0.03 * size, parts = [];
        this.size = size;
        svg.setAttribute(
            'viewBox',
            [low[0] - edge, -high[1] - edge, high[0] - low[0] + 2 * edge, high[1] - low[1] + 2 * edge].join(' '));
        // walls: what a cut above the window sills meets; as triangles of faces that look down or up this is not known,
        // so rooms are filled over the outline of everything
        for (const room of model.rooms) {
            const c = room.corners.map(([x, y]) => `${x.toFixed(3)},${(-y).toFixed(3)}`);
            parts.push(`<polygon class="room" points="${c.join(' ')}"><title>${W.escape(room.name)}</title></polygon>`);
        }
        if (!model.rooms.length)
            parts.push(`<rect class="room" x="${low[0]}" y="${- high[1]}" width="${high[0] - low[0]}" height="${
                high[1] - low[1]}"/>`);
        if (model.tour.length)
            parts.push(`<polyline class="way" points="${
                model.tour.map((f) => `${f[1].toFixed(3)},${(-f[2]).toFixed(3)}`).join(' ')}"/>`);
        scene.places.forEach(
            (p, i) => parts.push(`<circle class="stand" data-place="${i}" cx="${p.centre[0]}" cy="${
                - p.centre[1]}" r="${0.013 * size}"><title>photograph ${W.escape(p.photo)}</title></circle>`));
        for (const room of model.rooms) {
            const n = room.corners.length, x = room.corners.reduce((s, c) => s + c[0] / n, 0),
                  y = room.corners.reduce((s, c) => s + c[1] / n, 0);
            parts.push(`<text x="${x}" y="${- y}" style="font-size:${0.045 * size}px" pointer-events="none">${
                W.escape(room.name)}</text>`);
        }
        parts.push('<path class="look" pointer-events="none"/><circle class="you" pointer-events="none"/>');
        svg.innerHTML = parts.join('');
        this.look = svg.querySelector('.look');
        this.you = svg.querySelector('.you');
        this.stands = [...svg.querySelectorAll('.stand')];
    }
    stand(centre, heading, field, used) {
        const x = centre[0], y = -centre[1], r = 0.12 * this.size, a = heading - field / 2, b = heading + field / 2;
        this.you.setAttribute('cx', x);
        this.you.setAttribute('cy', y);
        this.you.setAttribute('r', 0.02 * this.size);
        const at = (k) => `${x + r * Math.cos(k)} ${y - r * Math.sin(k)}`;
        this.look.setAttribute('d', `M${x} ${y}L${at(a)}A${r} ${r} 0 0 0 ${at(b)}Z`);
        this.stands.forEach((s, i) => s.classList.toggle('on', used.includes(i)));
    }
}
W.Plan = Plan;
W.escape = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
