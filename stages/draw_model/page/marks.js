/* marks.js - what marks and edits mean in the rooms: symbols on the plan, and a sentence for each.
 *
 * Places are found as the stages find them that read the marks: a pixel on the floor, on the surface of the model that it
 * shows, or where the rays of several photos meet. Symbols differ in form and have words, never in colour alone. */
'use strict';

/* Where rays come nearest to each other; null: they are parallel. rays: origin and direction, six numbers each. */
function meetRays(rays) {
    const m = [[0, 0, 0], [0, 0, 0], [0, 0, 0]], r = [0, 0, 0];
    for (const ray of rays)
        for (let i = 0; i < 3; i++)
            for (let k = 0; k < 3; k++) {
                const w = (i === k ? 1 : 0) - ray[3 + i] * ray[3 + k];
                m[i][k] += w;
                r[i] += w * ray[k];
            }
    const det = (a) => a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] -
        a[1][2] * a[2][0]) + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    const d = det(m);
    if (Math.abs(d) < 1e-9) return null;
    return [0, 1, 2].map((c) => det(m.map((row, i) => row.map((v, k) => k === c ? r[i] : v))) / d);
}

const away = (a, b) => Math.hypot(...a.map((v, k) => v - b[k]));

class Marks {
    constructor(app) { this.app = app; }

    /* Fills `shapes` and `sentences` from the file that is open. */
    read() {
        this.shapes = [];
        this.sentences = [];
        const file = this.app.file;
        const readers = {'scale.txt': 'scale', 'axes_fix.txt': 'axes', 'lights.txt': 'lights', 'things.txt': 'things',
            'materials.txt': 'materials', 'subjects.txt': 'subjects', 'lri.txt': 'references', 'masks.txt': 'masks'};
        if (readers[file]) this[readers[file]](this.statements(file));
        else if (EDIT_FILES.test(file)) this.edit(this.statements(file));
    }

    statements(file) { return Script.statements(this.app.texts.get(file)).map((s) => s.words); }
    say(text) { this.sentences.push(text); }
    length(v) { return `${v.toFixed(this.app.live.isMetric() ? 3 : 4)}${this.app.live.isMetric() ? ' m' : ' units'}`; }

    photo(view) { return this.app.photos.findIndex((p) => !p.isReference && p.id === view.split('@')[0]); }
    ray(view, u, v) {
        const i = this.photo(view);
        return i < 0 ? null : this.app.live.ray(i, +u, +v);
    }

    floor(view, u, v) {
        const ray = this.ray(view, u, v);
        return ray && meetPlane(ray, [0, 0, 1], [0, 0, 0]);
    }

    surface(view, u, v) {
        const i = this.photo(view), hit = i < 0 ? null : this.app.live.pick(i, +u, +v);
        return hit && [...hit.at];
    }

    surfaces(view, numbers) {
        const list = [];
        for (let i = 0; i + 1 < numbers.length; i += 2) list.push(this.surface(view, numbers[i], numbers[i + 1]));
        return list.filter((p) => p);
    }

    /* Numbers after "in VIEW", as far as there are any. */
    numbers(words, at) {
        const list = [];
        for (; at < words.length && /^[-+.0-9e]+$/.test(words[at]); at++) list.push(+words[at]);
        return list;
    }

    dot(at, label, kind) { if (at) this.shapes.push({form: 'dot', at: [at], label, kind}); }
    line(a, b, label, kind) { if (a && b) this.shapes.push({form: 'line', at: [a, b], label, kind}); }
    area(at, label, kind) { if (at.length > 2) this.shapes.push({form: 'area', at, label, kind}); }

    /* Places of `mark` lines: name -> place. */
    places(list) {
        const places = new Map(), rays = new Map();
        for (const w of list.filter((w) => w[0] === 'mark')) {
            if (w[5] === 'floor') places.set(w[1], this.floor(w[2], w[3], w[4]));
            else if (w[5] === 'surface') places.set(w[1], this.surface(w[2], w[3], w[4]));
            else if (w[5] === 'above' && places.get(w[6])) {
                const ray = this.ray(w[2], w[3], w[4]), foot = places.get(w[6]);
                if (ray) places.set(w[1], [foot[0], foot[1], foot[2] + nearestOnLine(ray, foot, [0, 0, 1])]);
            } else
                rays.set(w[1], [...(rays.get(w[1]) || []), this.ray(w[2], w[3], w[4])].filter((r) => r));
        }
        for (const [name, r] of rays) {
            places.set(name, r.length > 1 ? meetRays(r) : null);
            if (r.length < 2) this.say(`${name}: mark it in a second photo, or say that it is on the floor.`);
        }
        return places;
    }

    scale(list) {
        const places = this.places(list), metric = this.app.live.isMetric();
        for (const [name, at] of places) this.dot(at, name, 'mark');
        this.ratios = [];
        const compare = (what, found, wanted) => {
            if (wanted > 0 && found > 0) this.ratios.push([found, wanted]);
            this.say(metric ? `${what}: ${wanted} m given; the model ${this.app.isScaledHere() ? 'here' : 'as it was made'} has ${found.toFixed(3)} m.`
                : `${what}: ${wanted} m given, ${found.toFixed(4)} units here: 1 unit is ${(wanted / found).toFixed(4)} m.`);
        };
        for (const w of list) {
            const a = places.get(w[1]), b = places.get(w[2]);
            if (w[0] === 'length' && a && b && +w[3] > 0) {
                this.line(a, b, `${w[3]} m`, 'scale');
                compare(`${w[1]} to ${w[2]}`, away(a, b), +w[3]);
            } else if (w[0] === 'height' && w[1] === 'ceiling' && this.app.live.c.live_ceiling() > 0)
                compare('the ceiling', this.app.live.c.live_ceiling(), +w[2]);
            else if (w[0] === 'height' && a) {
                this.dot(a, `${w[1]} ${w[2]} m high`, 'mark');
                compare(`the height of ${w[1]}`, a[2], +w[2]);
            } else if (/^(length|height)$/.test(w[0]) && w[1] !== 'ceiling')
                this.say(`${w.join(' ')}: its marks have no place yet.`);
        }
        if (list.length && !list.some((w) => /^(length|height)$/.test(w[0]))) this.say('Give a length between two marks, or a height: buttons above.');
    }

    /* How many metres a length of 1 is, by scale.txt, as find_axes has it; 0: it does not say. */
    metres() {
        const other = new Marks(this.app);
        other.shapes = [], other.sentences = [], other.ratios = [];
        other.scale(other.statements('scale.txt'));
        const sum = (f) => other.ratios.reduce((s, r) => s + f(r), 0);
        return other.ratios.length ? sum(([d, m]) => d * m) / sum(([d]) => d * d) : 0;
    }

    axes(list) {
        const places = this.places(list), corners = new Map();
        for (const [name, at] of places) this.dot(at, name, 'mark');
        for (const w of list.filter((w) => w[0] === 'corner')) {
            const at = this.floor(w[2], w[3], w[4]), known = corners.get(w[1]);
            if (!at) continue;
            if (known) this.say(`corner ${w[1]}: the two photos place it ${this.length(away(at, known))} apart on the floor as it is; make axes moves the floor.`);
            else this.shapes.push({form: 'corner', at: [at], label: w[1], kind: 'axes'});
            corners.set(w[1], known || at);
        }
        for (const w of list.filter((w) => w[0] === 'edge')) {
            const from = corners.get(w[1]), to = this.floor(w[2], w[3], w[4]);
            this.line(from, to, '', 'axes');
            if (!from || !to) continue;
            const turn = Math.atan2(to[1] - from[1], to[0] - from[0]) * 180 / Math.PI, off = turn - 90 *
                Math.round(turn / 90);
            this.say(`edge of ${w[1]}: ${Math.abs(off).toFixed(2)} degrees off the nearest axis, ${off < 0 ? 'clockwise' : 'counter-clockwise'}.`);
        }
        for (const name of corners.keys())
            if (list.filter((w) => w[1] === name && /^(corner|edge)$/.test(w[0])).length < 2) this.say(`corner ${name} needs a mark in a second photo, or an edge.`);
        for (const w of list.filter((w) => w[0] === 'thickness')) {
            const a = places.get(w[1]), b = places.get(w[2]);
            this.line(a, b, 'thickness', 'scale');
            if (a && b) this.say(`The wall between ${w[1]} and ${w[2]} is ${this.length(away(a, b))} thick.`);
        }
    }

    /* Lamps that make lights fitted: name -> {at, normal, radius, corners, radiance, beta} */
    fitted() {
        const lamps = new Map();
        for (const {words: w} of Script.statements(this.app.scene.files['out/lights/lights.txt'] || '')) {
            const n = w.slice(2).map(Number), at = n.slice(0, 3), add = (a, b, s, t) => a.map((v, k) => v + s * b[0][k] +
                t * b[1][k]);
            if (w[0] === 'disk') lamps.set(w[1], {at, normal: n.slice(3, 6), radius: n[6], radiance: n.slice(7, 10),
                beta: n[10]});
            if (w[0] !== 'quad') continue;
            const u = n.slice(3, 6), v = n.slice(6, 9), normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0]], size = Math.hypot(...normal);
            lamps.set(w[1], {at, normal: normal.map((x) => x / size), radiance: n.slice(9, 12), beta: n[12],
                corners: [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([s, t]) => add(at, [u, v], s, t))});
        }
        return lamps;
    }

    /* Where the edge of a lamp's cone meets the floor, or how it opens in plan. */
    cone(lamp, name) {
        if (!(lamp.beta > 0 && lamp.beta < 85)) return;
        const beta = lamp.beta * Math.PI / 180, at = lamp.at, ring = [];
        if (lamp.normal[2] < -0.9) {
            for (let i = 0; i < 48; i++) {
                const t = i / 24 * Math.PI, r = at[2] * Math.tan(beta);
                ring.push([at[0] + r * Math.cos(t), at[1] + r * Math.sin(t), 0]);
            }
        } else {
            const turn = Math.atan2(lamp.normal[1], lamp.normal[0]), far = 0.8 * this.app.live.height();
            ring.push(at);
            for (let i = -6; i <= 6; i++) ring.push([at[0] + far * Math.cos(turn + beta * i / 6),
                at[1] + far * Math.sin(turn + beta * i / 6), 0]);
        }
        this.area(ring, `cone of ${name}`, 'cone');
    }

    lights(list) {
        const fitted = this.fitted();
        for (const w of list) {
            const at = w.indexOf('in'), view = w[at + 1], n = at < 0 ? [] : this.numbers(w, at + 2);
            const value = (word) => w.includes(word) ? w[w.indexOf(word) + 1] : null;
            if (/^(disk|area)$/.test(w[0]) && at > 0) {
                const lamp = fitted.get(w[1]), here = this.surface(view, n[0], n[1]);
                const corners = w[0] === 'area' ? lamp ? lamp.corners : this.surfaces(view, n) : null;
                const middle = lamp ? lamp.at : corners ? corners[0] : here, beta = lamp ? lamp.beta : +value('beta');
                if (corners) this.area(corners, w[1], 'lamp');
                else if (middle) this.shapes.push({form: 'lamp', at: [middle], label: w[1], kind: 'lamp'});
                if (middle && beta > 0) this.cone({at: middle, normal: lamp ? lamp.normal : [0, 0, -1], beta}, w[1]);
                const marks = (kind) => list.filter((m) => m[0] === kind && m[1] === w[1]).length;
                const count = {lit: marks('lit'), unlit: marks('unlit'), line: marks('line')};
                const more = count.lit ? w[0] === 'disk' && !count.line ? '; a Cone line finds its cone' : ''
                    : w[0] === 'disk' ? '; a spot is dark beside its cone: drag a Lit rectangle, or accept what make lights proposes, after another make draw'
                    : '; its own pixels tell its radiance, surer with Lit rectangles';
                this.say(`${w[1]}: ${lamp
                    ? `radiance ${lamp.radiance.map((v) => +v.toPrecision(3)).join(' ')}, cone of ${lamp.beta.toFixed(1)} degrees, as make lights fitted it`
                    : middle ? 'make lights will fit its radiance' : 'its pixel shows no surface of the model: build the rooms first'}; ${count.lit} lit, ${count.unlit} unlit, ${count.line} cone lines${more}.`);
            } else if (/^(lit|unlit)$/.test(w[0]) && n.length > 1)
                this.dot(this.surface(view, n.length > 3 ? (n[0] + n[2]) / 2 : n[0],
                    n.length > 3 ? (n[1] + n[3]) / 2 : n[1]), w[0], w[0]);
            else if (w[0] === 'line' && n.length > 3) this.line(this.surface(view, n[0], n[1]),
                this.surface(view, n[2], n[3]), '', 'edge');
        }
    }

    things(list) {
        for (const w of list) {
            const at = w.indexOf('in'), n = at < 0 ? [] : this.numbers(w, at + 2);
            if (w[0] === 'thing' && n.length > 1) {
                const found = this.app.scene.things && this.app.scene.things.list.find((t) => t.name === w[1]);
                this.dot(found ? found.middle.map((v) => this.app.unit * v) : this.surface(w[at + 1], n[0], n[1]), w[1], 'thing');
                this.say(found ? `${w[1]} was found.` : `${w[1]}: make things looks for it.`);
            } else if (w[0] === 'flat' && n.length > 5) this.area(this.surfaces(w[at + 1], n), w[1], 'thing');
        }
    }

    materials(list) {
        for (const w of list.filter((w) => w[0] === 'material'))
            for (let i = 2; i < w.length; i++)
                if (w[i] === 'in') this.area(this.surfaces(w[i + 1], this.numbers(w, i + 2)), w[1], 'material');
    }

    subjects(list) {
        list.filter((w) => w[0] === 'subject').forEach((w, i) => {
            const n = this.numbers(w, 2);
            if (n.length < 4) return;
            this.dot(this.surface(w[1], (n[0] + n[2]) / 2, (n[1] + n[3]) / 2), `subject ${i + 1}`, 'subject');
        });
        if (list.length) this.say('Films go around the first subject, or between the first two.');
    }

    references(list) {
        const images = new Map();
        for (const w of list.filter((w) => /^(corner|point)$/.test(w[0]))) images.set(w[1], (images.get(w[1]) || 0) + 1);
        for (const [id, count] of images) this.say(`${id}: ${count} mark${count > 1 ? 's' : ''}${count < 3 ? '; it needs 3 or more, better 4' : ''}.`);
        for (const w of list.filter((w) => w[0] === 'in')) this.say(`${w[1]} was taken in ${w[2]}, looking out.`);
    }

    masks(list) {
        for (const id of new Set(list.map((w) => w[2]))) {
            const share = this.app.masks.share(id);
            if (share !== null) this.say(`${id}: ${(100 * share).toFixed(1)} % of its pixels are hidden.`);
        }
    }

    isMarked(name) { return this.statements('things.txt').some((w) => /^(thing|flat)$/.test(w[0]) && w[1] === name); }

    edit(list) {
        for (const w of list.filter((w) => /^(clear|keep)$/.test(w[0]))) {
            const at = w.indexOf('in'), from = w.indexOf('from'), n = at > 0 ? this.numbers(w, at + 2) : [];
            let corners = null;
            if (at > 0 && n.length >= 4) corners = [this.floor(w[at + 1], n[0], n[1]), this.floor(w[at + 1], n[2],
                n[3])];
            else if (from > 0 && w[from + 3] === 'to') corners = [[+w[from + 1], +w[from + 2]], [+w[from + 4],
                +w[from + 5]]];
            const rooms = this.app.model.rooms.filter((r) => w[1] === 'all' || w[1] === r.name);
            if (corners && corners[0] && corners[1]) {
                const [a, b] = corners;
                this.area([[a[0], a[1], 0], [b[0], a[1], 0], [b[0], b[1], 0], [a[0], b[1], 0]], w[0], w[0]);
            } else
                for (const r of rooms) this.dot([...r.middle, 0], `${w[0]} ${r.name}`, w[0]);
        }
        const gone = this.app.draft.ready ? this.app.live.gone() : [];
        const things = this.app.scene.things ? this.app.scene.things.list : [];
        let count = 0;
        things.forEach((t, i) => {
            if (!gone[i]) return;
            count++;
            this.dot(t.middle.map((v) => this.app.unit * v), `${t.name} goes`, 'gone');
        });
        const placed = this.app.draft.ready ? this.app.live.placed() : [], objects = placed.filter((p) => p.thing < 0);
        for (const p of placed) this.dot(p.at, p.thing < 0 ? 'object' : `${things[p.thing].name} here`, 'placed');
        if (things.length) this.say(`${count} of ${things.length} pieces of furniture leave their places` +
            `${placed.length > objects.length ? `; ${placed.length - objects.length} stand at new ones` : ''}.`);
        for (const w of list.filter((w) => (w[0] === 'move' || w[0] === 'copy') && things.length))
            if (this.isMarked(w[1]) && !things.some((t) => t.name === w[1]))
                this.say(`${w[1]}: not in the draft; make things, then make draw, show it.`);
    }

    /* ------------------------------------------------------------------------------------------------------- plan */

    /* Draws them into plan.svg, which is in `element`. */
    draw(element) {
        const svg = element.querySelector('svg'), place = svg && this.app.live.planPlace();
        if (!place) return;
        const old = svg.querySelector('.marks');
        if (old) old.remove();
        const make = (name, attributes, text) => {
            const e = document.createElementNS('http://www.w3.org/2000/svg', name);
            for (const [k, v] of Object.entries(attributes)) e.setAttribute(k, v);
            if (text) e.textContent = text;
            group.append(e);
        };
        const group = document.createElementNS('http://www.w3.org/2000/svg', 'g');
        group.setAttribute('class', 'marks');
        /* px of the screen, whatever size the plan has */
        const box = svg.viewBox.baseVal, shown = svg.getBoundingClientRect();
        const px = Math.max(box.width / (shown.width || 1), box.height / (shown.height || 1));
        const at = (p) => [place.scale * (p[0] - place.left), place.scale * (place.top - p[1])];
        const path = (list) => list.map((p, i) => `${i ? 'L' : 'M'}${at(p).map((v) => v.toFixed(1)).join(' ')}`).join('');
        const cross = (x, y, r, attributes, upright) => make('path', {...attributes, d: `M${x - r * px} ${y - r * px}l${2 * r * px} ${2 * r *
            px}m0 ${-2 * r * px}l${-2 * r * px} ${2 * r * px}` + (upright ? `M${x - 1.4 * r * px} ${y}h${2.8 * r * px}M${x} ${y - 1.4 * r * px}v${2.8 * r *
            px}` : '')}), names = [];
        for (const s of this.shapes) {
            const [x, y] = at(s.at[0]), inside = {class: 'mark ' + s.kind};
            if (s.form === 'area') make('path', {...inside, d: path(s.at) + 'Z'});
            else if (s.form === 'line') make('path', {...inside, d: path(s.at)});
            else if (s.form === 'lamp') cross(x, y, 8, inside, true);
            else if (s.form === 'corner') make('path', {...inside, d: `M${x} ${y - 14 * px}V${y}H${x + 14 * px}`});
            else if (/^(gone|unlit|clear)$/.test(s.kind)) cross(x, y, 4, inside, false);
            else make('circle', {...inside, cx: x, cy: y, r: 3.5 * px});
            if (!s.label) continue;
            const middle = s.form === 'line' || s.form === 'area' ? s.at.map(at).reduce((m, p) => [m[0] + p[0] /
                s.at.length, m[1] + p[1] / s.at.length], [0, 0]) : [x, y - 10 * px];
            names.push([s.label, ...middle]);
        }
        /* names that would lie on another one are left to the sentences */
        const placed = [];
        for (const [label, x, y] of names) {
            const w = 3.6 * px * label.length, h = 6.5 * px;
            if (placed.some((p) => Math.abs(p[0] - x) < p[2] + w && Math.abs(p[1] - y) < 2 * h)) continue;
            placed.push([x, y, w]);
            make('text', {x: x.toFixed(1), y: y.toFixed(1), class: 'mark-name', style: `font-size:${11 * px}px`}, label);
        }
        svg.append(group);
    }
}
