// levels.js - the page of light levels: sums of groups of light on the plan, and pictures of the photographs.
//
// `variants` has the data of the room as it is, then of each edit (stages/light_levels/level_script.c).
'use strict';

const make = (name, attributes, ...inside) => {
    const e = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
    e.append(...inside);
    return e;
};
const words = (name) => name.replace(/[-_]/g, ' ');
const byId = (id) => document.getElementById(id);

// Three digits; whole numbers from 100 on.
const shown = (v) => {
    if (!Number.isFinite(v)) return '–';
    const size = Math.abs(v);
    if (size >= 100) return String(Math.round(Number(v.toPrecision(3))));
    return size < 0.001 ? '0' : String(Number(v.toPrecision(3)));
};
const signed = (v) => (v > 0 ? '+' : v < 0 ? '−' : '') + shown(Math.abs(v));

// ------------------------------------------------------------------------------------------------------------- data

const decode = ({high, most, data}) => (most === undefined ? lightOf(data, high) : signedOf(data, most));

class Variant {
    constructor(data, name, relit) {
        Object.assign(this, data, {name, relit, count: data.points.length / 2});
        this.lamps = data.lamps.map((l) => ({name: l.name, planned: !!l.planned, on: !!l.on && data.scale > 0,
            light: decode(l.light)}));
        this.windows = data.windows.map((w) => ({name: w.name, photographed: decode(w.photographed),
            level: w.level && decode(w.level), parts: (w.parts || []).map(decode)}));
        this.suns = data.suns.map((s) => runsOf(s, this.count));
        this.at = new Map();
        for (let i = 0; i < this.count; i++) this.at.set(this.key(i), i);
    }

    key(i) { return `${this.points[2 * i].toFixed(1)} ${this.points[2 * i + 1].toFixed(1)}`; }

    // The unit of a choice of light: lx if a scale is known, or if only computed skies shine.
    unit(choice) { return this.scale > 0 || choice.isAbsolute() ? 'lx' : 'relative'; }

    // Illuminance at each point. Without a scale, light of the photographs cannot be added to what is in lx.
    values(choice) {
        const to = new Float64Array(this.count), factor = this.scale > 0 ? this.scale : 1;
        const add = (light, by) => {
            for (let i = 0; by && i < this.count; i++) to[i] += by * light[i];
        };
        const photos = this.scale > 0 || !choice.isAbsolute();
        for (const lamp of this.lamps)
            if (photos || lamp.planned) add(lamp.light, (lamp.planned ? 1 : factor) * choice.lamp(lamp.name));
        const photographed = choice.sky === 'photographed' && photos, sky = this.skies[choice.skyNumber()];
        let part = 0;
        for (const w of this.windows) {
            const blind = choice.blind(w.name);
            if (photographed) add(w.photographed, factor * blind);
            for (let k = 0; sky && w.level && k < w.parts.length; k++)
                for (let i = 0; i < this.count; i++) to[i] += blind * sky.mixes[part + k] * w.level[i] * w.parts[k][i];
            part += w.parts.length;
        }
        const shade = sky && this.suns[sky.shade];
        for (let i = 0; shade && i < this.count; i++)
            if (shade[i]) to[i] += choice.blind(this.windows[shade[i] - 1].name) * sky.sun;
        return to;
    }

    // By what a mean is multiplied for the ends of its interval.
    ends(choice) {
        const lamps = this.lamps.filter((l) => choice.lamp(l.name) > 0);
        const isPlanned = lamps.some((l) => l.planned), photos = this.scale > 0 || !choice.isAbsolute();
        const isRelative = photos && (choice.sky === 'photographed' || lamps.some((l) => !l.planned));
        return this.intervals[(isRelative ? 1 : 0) + (isPlanned ? 2 : 0)];
    }

    // Mean, least and most of each room's work plane and of each place.
    rows(values) {
        return this.areas.map((a) => {
            let sum = 0, least = Infinity, most = 0;
            for (let i = a.first; i < a.first + a.count; i++) {
                sum += values[i];
                least = Math.min(least, values[i]);
                most = Math.max(most, values[i]);
            }
            const mean = sum / a.count;
            return {kind: a.kind, name: a.name, mean, least, most, uniformity: mean > 0 ? least / mean : 0};
        });
    }
}

// ------------------------------------------------------------------------------------------------------------- plan

// Isolines of values on a lattice of points, by marching squares; line(x0, y0, x1, y1) for each piece.
const isolines = (lattice, values, level, line) => {
    for (const square of lattice.squares) {
        const cuts = [];
        if (!square.every((i) => Number.isFinite(values[i]))) continue;
        for (let k = 0; k < 4; k++) {
            const a = values[square[k]], b = values[square[(k + 1) % 4]];
            if ((a < level) === (b < level)) continue;
            const t = (level - a) / (b - a), p = lattice.at(square[k]), q = lattice.at(square[(k + 1) % 4]);
            cuts.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
        }
        for (let k = 0; k + 1 < cuts.length; k += 2) line(...cuts[k], ...cuts[k + 1]);
    }
};

// The squares of neighbouring points of an area.
const latticeOf = (variant, area) => {
    const at = (i) => [variant.points[2 * i], variant.points[2 * i + 1]];
    const key = (x, y) => `${Math.round(x / area.step * 4)} ${Math.round(y / area.step * 4)}`;
    const all = new Map(), squares = [];
    for (let i = area.first; i < area.first + area.count; i++) all.set(key(...at(i)), i);
    for (let i = area.first; i < area.first + area.count; i++) {
        const [x, y] = at(i), s = area.step;
        const corners = [i, all.get(key(x + s, y)), all.get(key(x + s, y + s)), all.get(key(x, y + s))];
        if (corners.every((c) => c !== undefined)) squares.push(corners);
    }
    return {at, squares};
};

class Plan {
    constructor(canvas, variants) {
        Object.assign(this, {canvas, to: canvas.getContext('2d'), cursor: -1});
        this.low = [Infinity, Infinity];
        this.high = [-Infinity, -Infinity];
        for (const v of variants)
            for (const r of v.rooms)
                r.outline.forEach((c, i) => {
                    this.low[i % 2] = Math.min(this.low[i % 2], c);
                    this.high[i % 2] = Math.max(this.high[i % 2], c);
                });
        const size = [0, 1].map((k) => this.high[k] - this.low[k]), wide = Math.max(...size) || 1;
        this.scale = 1000 / (1.1 * wide);
        [0, 1].forEach((k) => { this.low[k] -= 0.05 * wide; this.high[k] += 0.05 * wide; });
        canvas.width = this.scale * (this.high[0] - this.low[0]);
        canvas.height = this.scale * (this.high[1] - this.low[1]);
    }

    x(x) { return this.scale * (x - this.low[0]); }
    y(y) { return this.scale * (this.high[1] - y); }

    outline(outline) {
        this.to.beginPath();
        for (let i = 0; i < outline.length; i += 2) this.to.lineTo(this.x(outline[i]), this.y(outline[i + 1]));
        this.to.closePath();
    }

    label(text, x, y, bold) {
        const to = this.to;
        to.font = `${bold ? '600 ' : ''}18px sans-serif`;
        to.textAlign = 'center';
        to.textBaseline = 'middle';
        to.lineWidth = 5;
        to.strokeStyle = '#fff';
        to.strokeText(text, x, y);
        to.fillStyle = '#111';
        to.fillText(text, x, y);
    }

    // show: {values, colour(value), levels, text(level)}
    draw(variant, show) {
        const to = this.to;
        Object.assign(this, {variant, show});
        to.fillStyle = '#fff';
        to.fillRect(0, 0, this.canvas.width, this.canvas.height);
        for (const r of variant.rooms) {
            this.outline(r.outline);
            to.fillStyle = '#efeae0';
            to.fill();
        }
        for (const a of variant.areas) if (a.kind === 'work-plane') this.drawArea(a);
        for (const r of variant.rooms) {
            this.outline(r.outline);
            to.lineWidth = 5;
            to.strokeStyle = '#565b62';
            to.stroke();
        }
        for (const o of variant.openings) {
            to.beginPath();
            to.moveTo(this.x(o.at[0]), this.y(o.at[1]));
            to.lineTo(this.x(o.at[2]), this.y(o.at[3]));
            to.lineWidth = 9;
            to.strokeStyle = o.kind === 'window' ? '#8fc1ea' : '#b98a57';
            to.stroke();
        }
        for (const a of variant.areas) if (a.kind === 'place') this.drawPlace(a);
        if (this.cursor >= 0) this.drawCursor();
    }

    drawArea(a) {
        const to = this.to, side = this.scale * a.step, {values, colour, levels, text} = this.show;
        for (let i = a.first; i < a.first + a.count; i++) {
            if (!Number.isFinite(values[i])) continue;
            to.fillStyle = colour(values[i]);
            to.fillRect(this.x(this.variant.points[2 * i]) - side / 2, this.y(this.variant.points[2 * i + 1]) - side / 2,
                side + 0.5, side + 0.5);
        }
        const lattice = a.lattice || (a.lattice = latticeOf(this.variant, a));
        const labels = [];
        for (const level of levels) {
            const pieces = [];
            isolines(lattice, values, level, (...line) => pieces.push(line));
            for (const [width, style] of [[5, 'rgba(0,0,0,.55)'], [2.4, '#fff']]) {
                to.beginPath();
                for (const [a0, b0, a1, b1] of pieces) {
                    to.moveTo(this.x(a0), this.y(b0));
                    to.lineTo(this.x(a1), this.y(b1));
                }
                to.lineWidth = width;
                to.strokeStyle = style;
                to.stroke();
            }
            const middle = pieces[pieces.length >> 1];
            if (middle) labels.push([text(level), this.x(middle[0]), this.y(middle[1])]);
        }
        const put = [];
        for (const [words, x, y] of labels) {
            if (put.some(([a0, b0]) => Math.hypot(a0 - x, b0 - y) < 34)) continue;
            put.push([x, y]);
            this.label(words, x, y);
        }
    }

    drawPlace(a) {
        const points = [...Array(a.count).keys()].map((i) => [this.variant.points[2 * (a.first + i)],
            this.variant.points[2 * (a.first + i) + 1], this.show.values[a.first + i]]);
        const mean = (k) => points.reduce((s, p) => s + p[k], 0) / a.count;
        this.label(`${words(a.name)} ${this.show.number(mean(2))}`, this.x(mean(0)), this.y(mean(1)), true);
    }

    drawCursor() {
        const to = this.to, x = this.x(this.variant.points[2 * this.cursor]);
        const y = this.y(this.variant.points[2 * this.cursor + 1]);
        for (const [width, style] of [[6, '#000'], [3, '#fff']]) {
            to.beginPath();
            to.arc(x, y, 12, 0, 7);
            to.lineWidth = width;
            to.strokeStyle = style;
            to.stroke();
        }
        this.label(this.show.number(this.show.values[this.cursor]), x, y - 26, true);
    }

    // The point nearest to a place of the model, or from the cursor in a direction.
    nearest(x, y) {
        let best = -1, least = Infinity;
        for (let i = 0; i < this.variant.count; i++) {
            const d = Math.hypot(this.variant.points[2 * i] - x, this.variant.points[2 * i + 1] - y);
            if (d < least) { least = d; best = i; }
        }
        return best;
    }

    move(dx, dy) {
        const p = this.variant.points, from = this.cursor;
        if (from < 0) return this.nearest((this.low[0] + this.high[0]) / 2, (this.low[1] + this.high[1]) / 2);
        let best = from, least = Infinity;
        for (let i = 0; i < this.variant.count; i++) {
            const x = p[2 * i] - p[2 * from], y = p[2 * i + 1] - p[2 * from + 1];
            const ahead = x * dx + y * dy, aside = Math.abs(x * dy) + Math.abs(y * dx);
            if (ahead > 1e-6 && ahead + 3 * aside < least) { least = ahead + 3 * aside; best = i; }
        }
        return best;
    }
}

// ---------------------------------------------------------------------------------------------------------- controls

class Choice {
    constructor() {
        Object.assign(this, {sky: 'photographed', day: 0, hour: 0, cover: 0, edit: 0, show: 'after', factors: new Map(),
            planned: [], blinds: new Map(), skies: []});
    }
    blind(name) { return this.blinds.has(name) ? this.blinds.get(name) : 1; }
    // The number of the computed sky that shines; -1: none.
    skyNumber() {
        if (this.sky === 'overcast') return 0;
        return this.sky === 'hour' && this.skies.length ? this.skies[this.day][3 * this.hour + this.cover] : -1;
    }
    shownVariant() { return this.show === 'before' ? 0 : this.edit; }
    lamp(name) { return this.factors.has(name) ? this.factors.get(name) : 1; }
    // Whether something shines that is in lx: a computed sky, or a planned lamp.
    isAbsolute() { return this.sky === 'overcast' || this.sky === 'hour' || this.planned.some((n) => this.lamp(n) > 0); }
}

const clock = (hour) => `${Math.floor(hour)}:${String(Math.round(60 * (hour % 1))).padStart(2, '0')}`;
const MONTHS = ['January', 'February', 'March', 'April', 'May', 'June', 'July', 'August', 'September', 'October',
    'November', 'December'];
const dateOf = (text) => `${Number(text.slice(3))} ${MONTHS[Number(text.slice(0, 2)) - 1]}`;

class Page {
    constructor(variants) {
        this.variants = variants;
        this.choice = new Choice();
        this.plan = new Plan(byId('plan'), variants);
        this.addVariants();
        this.addSkies();
        this.addLamps();
        this.addBlinds();
        this.addCursor();
        this.pictures = new Pictures(variants);
        this.relit = new RelitPhotos(variants);
        this.update();
    }

    addVariants() {
        const c = this.choice, edit = byId('edit'), show = byId('show');
        this.variants.forEach((v, i) => edit.append(make('option', {value: i}, i ? words(v.name) : 'none')));
        edit.addEventListener('change', () => {
            c.edit = Number(edit.value);
            c.show = 'after';
            show.value = 'after';
            this.plan.cursor = -1;
            this.pictures.choose(c.edit);
            this.update();
        });
        show.addEventListener('change', () => {
            c.show = show.value;
            this.plan.cursor = -1;
            this.update();
        });
        byId('edits').hidden = this.variants.length < 2;
    }

    addSkies() {
        const c = this.choice, days = this.variants[0].days;
        c.skies = days.map((d) => d.skies);
        const change = (id, act) => {
            byId(id).addEventListener('input', () => { act(byId(id)); this.update(); });
        };
        days.forEach((d, i) => byId('day').append(make('option', {value: i}, dateOf(d.date))));
        const hasRooms = this.variants.some((v) => v.rooms.length);
        byId('no-rooms').hidden = hasRooms;
        byId('no-site').hidden = days.length > 0 || !hasRooms;
        byId('sky').querySelector('[value=hour]').disabled = !days.length || !hasRooms;
        byId('sky').querySelector('[value=overcast]').disabled = !hasRooms;
        for (const id of ['plan', 'bar', 'ticks', 'unit', 'said', 'values']) byId(id).hidden = !hasRooms;
        change('sky', (e) => { c.sky = e.value; });
        change('cover', (e) => { c.cover = Number(e.value); });
        change('hour', (e) => { c.hour = Number(e.value); });
        change('day', (e) => {
            const at = days[c.day].hours[c.hour];
            c.day = Number(e.value);
            this.setHour(at);
        });
        byId('play').addEventListener('click', () => this.play());
        if (days.length) this.setHour(12);
    }

    // The hour of the chosen day that is nearest to one by the clock.
    setHour(at) {
        const c = this.choice, hours = this.variants[0].days[c.day].hours;
        c.hour = hours.reduce((best, h, i) => Math.abs(h - at) < Math.abs(hours[best] - at) ? i : best, 0);
        byId('hour').max = hours.length - 1;
        byId('hour').value = c.hour;
    }

    play() {
        const c = this.choice;
        if (this.timer) return this.stop();
        byId('play').textContent = 'Stop';
        this.timer = setInterval(() => {
            const next = c.hour + 1;
            if (next > Number(byId('hour').max)) return this.stop();
            c.hour = next;
            byId('hour').value = next;
            this.update();
        }, 400);
        c.hour = 0;
        byId('hour').value = 0;
        this.update();
        return undefined;
    }

    stop() {
        clearInterval(this.timer);
        this.timer = 0;
        byId('play').textContent = 'Play the day';
    }

    // All lamps, each lamp of any variant, and the light of the photographs that nothing explains.
    addLamps() {
        const lamps = this.variants.flatMap((v) => v.lamps), names = [...new Set(lamps.map((l) => l.name))];
        const box = byId('lamps'), c = this.choice;
        c.planned = names.filter((n) => lamps.some((l) => l.name === n && l.planned));
        this.dimmers = names.map((name, i) => {
            const planned = c.planned.includes(name);
            const on = !planned || lamps.some((l) => l.name === name && l.on), value = on ? 100 : 0;
            const output = make('output', {for: `lamp${i}`}, `${value} %`);
            const input = make('input', {type: 'range', min: 0, max: 200, step: 5, value, id: `lamp${i}`});
            input.addEventListener('input', () => { this.dim(i, Number(input.value)); this.update(); });
            box.append(make('label', {for: `lamp${i}`}, name ? `${words(name)}${planned ? ', planned' : ''}` :
                'light that no lamp or window explains', output), input);
            return {name, planned, on, input, output};
        });
        const all = (value) => () => {
            this.dimmers.forEach((d, i) => { if (!value || d.on) this.dim(i, value); });
            this.update();
        };
        byId('on').addEventListener('click', all(100));
        byId('off').addEventListener('click', all(0));
        this.dimmers.forEach((d) => c.factors.set(d.name, Number(d.input.value) / 100));
    }

    // A blind for each window of any variant; the last one of each has no pane.
    addBlinds() {
        const names = [...new Set(this.variants.flatMap((v) => v.windows.slice(0, -1).map((w) => w.name)))];
        const box = byId('blinds'), c = this.choice;
        names.forEach((name, i) => {
            const output = make('output', {for: `blind${i}`}, '100 %');
            const input = make('input', {type: 'range', min: 0, max: 100, step: 5, value: 100, id: `blind${i}`});
            input.addEventListener('input', () => {
                c.blinds.set(name, Number(input.value) / 100);
                output.textContent = `${input.value} %`;
                input.setAttribute('aria-valuetext', `${input.value} percent of the light`);
                this.update();
            });
            box.append(make('label', {for: `blind${i}`}, words(name), output), input);
        });
        byId('windows').hidden = !names.length;
    }

    dim(i, percent) {
        const d = this.dimmers[i];
        d.input.value = percent;
        d.output.textContent = `${percent} %`;
        d.input.setAttribute('aria-valuetext', `${percent} percent`);
        this.choice.factors.set(d.name, percent / 100);
    }

    addCursor() {
        const canvas = this.plan.canvas, ways = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1],
            ArrowDown: [0, -1]};
        const say = (point) => {
            this.plan.cursor = point;
            this.plan.draw(this.plan.variant, this.plan.show);
            byId('point').textContent = point < 0 ? '' : `At this point: ${
                this.plan.show.number(this.plan.show.values[point])} ${this.plan.show.unit}.`;
        };
        canvas.addEventListener('keydown', (e) => {
            if (!ways[e.key]) return;
            e.preventDefault();
            say(this.plan.move(...ways[e.key]));
        });
        canvas.addEventListener('pointermove', (e) => {
            const r = canvas.getBoundingClientRect(), k = canvas.width / r.width / this.plan.scale;
            say(this.plan.nearest(this.plan.low[0] + (e.clientX - r.left) * k,
                this.plan.high[1] - (e.clientY - r.top) * k));
        });
    }

    // What is shown on the plan: values of a variant, or by what an edit multiplies them.
    shownValues() {
        const c = this.choice, base = this.variants[0], edited = this.variants[c.edit];
        if (!c.edit || c.show === 'before') return {variant: base, ...this.plainShow(base, base.values(c))};
        const after = edited.values(c);
        if (c.show === 'after') return {variant: edited, ...this.plainShow(edited, after)};
        const before = base.values(c), values = new Float64Array(edited.count).fill(NaN);
        for (let i = 0; i < edited.count; i++) {
            const was = base.at.get(edited.key(i));
            if (was !== undefined && before[was] > 0) values[i] = after[i] / before[was];
        }
        const percent = (v) => `${signed(Math.round(100 * (v - 1)))} %`;
        return {variant: edited, values, unit: 'than before', levels: [0.25, 0.5, 0.8, 0.9, 1.1, 1.25, 1.5, 2, 3, 4],
            colour: (v) => changeColour(Math.log2(v) / 2), text: percent, number: percent, range: null};
    }

    plainShow(variant, values) {
        const unit = variant.unit(this.choice), range = variant.ranges[unit];
        const place = (v) => v > range[0] ? Math.min(1, Math.log(v / range[0]) / Math.log(range[1] / range[0])) : 0;
        const levels = [];
        for (let k = range[0]; k <= range[1] * 1.01; k *= 10) levels.push(k, 2 * k, 3 * k, 5 * k);
        return {values, unit, range, place, text: (v) => shown(v), number: (v) => shown(v),
            levels: levels.filter((l) => l <= range[1] * 1.01), colour: (v) => rampColour(variant.ramp, place(v))};
    }

    update() {
        const c = this.choice, show = this.shownValues(), base = this.variants[0];
        const useless = c.isAbsolute() && !(base.scale > 0), isHour = c.sky === 'hour';
        for (const d of this.dimmers) d.input.disabled = useless && !d.planned;
        byId('on').disabled = useless;
        byId('no-scale').hidden = !useless;
        byId('hours').hidden = !isHour;
        byId('compare').hidden = !c.edit;
        if (isHour) this.sayHour(base.days[c.day]);
        this.plan.draw(show.variant, show);
        this.putKey(show);
        this.putTable(show.unit);
        this.relit.show(c);
    }

    sayHour(day) {
        const text = clock(day.hours[this.choice.hour]);
        byId('clock').textContent = text;
        byId('hour').setAttribute('aria-valuetext',
            `${text}, the sun is ${day.altitudes[this.choice.hour]} degrees high`);
        byId('altitude').textContent = `The sun is ${day.altitudes[this.choice.hour]}° high.`;
    }

    putKey(show) {
        const bar = byId('bar'), ticks = byId('ticks'), stops = [];
        for (let i = 0; i <= 24; i++)
            stops.push(show.range ? rampColour(show.variant.ramp, i / 24) : changeColour(i / 12 - 1));
        bar.style.background = `linear-gradient(90deg, ${stops.join(',')})`;
        const marks = show.range ? show.levels.filter((l) => !/^3/.test(String(Number(l.toPrecision(1)) * 1e6)))
            .map((l) => [show.place(l), shown(l)]) : [[0, '−75 %'], [0.25, '−50 %'], [0.5, 'as before'],
            [0.75, '+100 %'], [1, '+300 %']];
        ticks.replaceChildren(...marks.map(([at, text]) => make('span', {style: `left:${100 * at}%`}, text)));
        byId('unit').textContent = show.range ? `Colours: illuminance in ${show.unit === 'lx' ? 'lx' :
            'the unit of the photographs'}; lines are at the numbers that they bear.` :
            'Colours: by how much the edit changes the light; lines bear the change.';
    }

    putTable() {
        const c = this.choice, base = this.variants[0], edited = this.variants[c.edit];
        const unit = edited.unit(c), rows = edited.rows(edited.values(c)), was = c.edit ? base.rows(base.values(c)) : [];
        const name = (r) => r.kind === 'place' ? words(r.name) : `${words(r.name)}, work plane`;
        const head = ['', `mean (${unit})`, '95 % interval', 'least', 'most', 'uniformity'], ends = edited.ends(c);
        if (c.sky === 'overcast') head.push('daylight factor');
        if (c.edit) head.push('mean before', 'difference');
        const tableRows = rows.map((r) => {
            const cells = [shown(r.mean), `${shown(ends[0] * r.mean)} to ${shown(ends[1] * r.mean)}`, shown(r.least),
                shown(r.most), r.uniformity.toFixed(2)];
            const before = was.find((o) => o.kind === r.kind && o.name === r.name);
            if (c.sky === 'overcast') cells.push(this.lampsShine() ? '–' : `${(100 * r.mean / base.overcastLux).toFixed(2)} %`);
            if (c.edit) cells.push(before ? shown(before.mean) : '–', before ? signed(r.mean - before.mean) : '–');
            return make('tr', {}, make('th', {scope: 'row'}, name(r)), ...cells.map((t) => make('td', {}, t)));
        });
        byId('values').replaceChildren(
            make('thead', {}, make('tr', {}, ...head.map((t) => make('th', {scope: 'col'}, t)))),
            make('tbody', {}, ...tableRows));
        const first = rows[0];
        const summary = first ? `${name(first)}: mean ${shown(first.mean)}, least ${shown(first.least)}, most ${
            shown(first.most)} ${unit}` : 'no room';
        byId('said').textContent = summary;
        this.plan.canvas.setAttribute('aria-label', `Plan of the rooms. ${summary}. Arrow keys read single points.`);
    }

    // Whether a lamp adds to the sky of daylight factors.
    lampsShine() {
        const counts = this.variants[0].scale > 0;
        return this.dimmers.some((d) => (counts || d.planned) && this.choice.lamp(d.name) > 0);
    }
}

const rampColour = (ramp, place) => {
    const at = 6 * Math.round(place * (ramp.length / 6 - 1));
    return `#${ramp.slice(at, at + 6)}`;
};

// From blue, darker, over white to orange, brighter; -1 to 1. Blue and orange differ for all kinds of sight.
const changeColour = (t) => {
    const ends = t < 0 ? [20, 84, 160] : [200, 90, 10], part = Math.min(1, Math.abs(t));
    return `rgb(${ends.map((e) => Math.round(250 + part * (e - 250))).join(',')})`;
};

// ---------------------------------------------------------------------------------------------------------- pictures

class Pictures {
    constructor(variants) {
        this.variants = variants;
        this.edit = 0;
        this.links = [...document.querySelectorAll('.plain a[data-photo]')].map((a) => ({...a.dataset,
            href: a.getAttribute('href')}));
        this.place = byId('shots');
        this.states = [...new Set(this.links.map((l) => l.state))];
        if (!this.place || !this.states.length) return;
        this.select = byId('state');
        this.states.forEach((s) => this.select.append(make('option', {value: s}, words(s))));
        this.select.addEventListener('change', () => this.show());
        this.show();
    }

    choose(edit) {
        this.edit = edit;
        if (this.select) this.show();
    }

    show() {
        const state = this.select.value, name = this.edit ? this.variants[this.edit].name : '';
        const of = (change) => this.links.filter((l) => l.state === state && l.change === change);
        const image = (l, when) => make('img', {src: l.href, loading: 'lazy',
            alt: `Photograph ${l.photo}, light levels ${when}: ${words(state)}`});
        this.place.replaceChildren(...of('').map((l) => {
            const after = name && of(name).find((o) => o.photo === l.photo);
            const figure = make('figure', {}, image(l, 'as it is'));
            if (after) figure.append(image(after, `after ${words(name)}`));
            figure.append(make('figcaption', {}, `Photograph ${l.photo}${after ? `; below, after ${words(name)}` : ''}`));
            return figure;
        }));
    }
}

if (variants.length) {
    document.documentElement.classList.add('js');
    window.levelsPage = new Page(variants.map((v) => new Variant(v.data, v.name, v.relit)));
}
