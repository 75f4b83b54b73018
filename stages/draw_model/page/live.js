/* live.js - the C code of build_model, in the page: what stages/build_model/live/live.h declares. */
'use strict';

class Live {
    /* bytes: of the module; files: a Map of paths to bytes */
    constructor(bytes, system) {
        this.system = system;
        this.instance = new WebAssembly.Instance(new WebAssembly.Module(bytes), system.imports());
        this.c = this.instance.exports;
        system.start(this.instance);
    }

    /* Calls a function with texts and numbers; a text is copied to the module's memory meanwhile. */
    call(name, ...args) {
        const texts = [], given = args.map((arg) => {
            if (typeof arg === 'number') return arg;
            const bytes = new TextEncoder().encode(arg || ''), at = this.c.live_alloc(bytes.length + 1);
            const to = new Uint8Array(this.c.memory.buffer);
            to.set(bytes, at);
            to[at + bytes.length] = 0;
            texts.push(at);
            return at;
        });
        const result = this.c[name](...given);
        for (const at of texts) this.c.live_free(at);
        return result;
    }

    textAt(at) {
        if (!at) return '';
        const all = new Uint8Array(this.c.memory.buffer);
        return new TextDecoder().decode(all.slice(at, all.indexOf(0, at)));
    }

    numbers(count) { return new Float64Array(this.c.memory.buffer, this.c.live_numbers(), count).slice(); }
    error() { return this.textAt(this.c.live_error()); }
    /* null after a failure */
    json(name) {
        const at = this.c[name]();
        return at ? JSON.parse(this.textAt(at)) : null;
    }

    /* "" or what is wrong */
    begin(files) {
        return this.call('live_begin', files.views, files.axes, files.points, files.config) ? this.error() : '';
    }

    build(files) {
        this.system.lines.length = 0;
        return this.call('live_build', files.script, files.things, files.edit, files.scene, files.base) ? this.error()
            : '';
    }

    write(folder) { return this.call('live_write', folder) ? this.error() : ''; }
    writePlan(path) { return this.call('live_write_plan', path) ? this.error() : ''; }

    edges(photo, apart) {
        const count = this.c.live_edges(photo, apart);
        return count > 0 ? this.numbers(3 * count) : new Float64Array(0);
    }

    points(photo, most) {
        const count = this.c.live_points(photo, most);
        return count > 0 ? this.numbers(3 * count) : new Float64Array(0);
    }

    /* null where the photo shows nothing */
    ray(photo, u, v) { return this.c.live_ray(photo, u, v) ? null : this.numbers(6); }
    /* The ceiling's height; a usual one in metres where it is unknown. */
    height() { return this.c.live_ceiling() || 2.5; }
    /* kind, photo and three numbers of each cell of a row: live_draft_rows */
    draftRows(photo, columns, rows, row) {
        const count = this.c.live_draft_rows(photo, columns, rows, row, 1);
        if (count < 0) throw new Error(this.error());
        return this.numbers(5 * count);
    }

    /* u, v here and there of places that two photos show */
    shared(photo, other, columns, rows) {
        const count = this.c.live_shared(photo, other, columns, rows);
        return count > 0 ? this.numbers(4 * count) : new Float64Array(0);
    }

    fillMask(photo, columns, rows, cells) {
        const at = this.c.live_mask(photo, columns, rows);
        if (at) new Uint8Array(this.c.memory.buffer, at, columns * rows).set(cells.subarray(0, columns * rows));
    }

    /* nine numbers a triangle */
    fillCorners(thing, corners) {
        const at = this.c.live_thing_corners(thing, corners.length / 9);
        if (at) new Float32Array(this.c.memory.buffer, at, corners.length).set(corners);
    }

    gone() {
        const count = this.c.live_draft_gone();
        return count > 0 ? [...this.numbers(count)] : [];
    }

    /* [{thing: its number, -1: an object, at}, ...] of what stands at a new place */
    placed() {
        const count = this.c.live_draft_placed(), n = count > 0 ? [...this.numbers(4 * count)] : [];
        return Array.from({length: Math.max(0, count)}, (_, i) => ({thing: n[4 * i], at: n.slice(4 * i + 1, 4 * i + 4)}));
    }

    /* {left, top, scale} of plan.svg */
    planPlace() {
        if (this.c.live_plan_place()) return null;
        const [left, top, scale] = this.numbers(3);
        return {left, top, scale};
    }

    isMetric() { return this.c.live_is_metric() !== 0; }
    project(photo, p) { return this.c.live_project(photo, p[0], p[1], p[2]) ? null : this.numbers(2); }
    pick(photo, u, v) {
        if (this.c.live_pick(photo, u, v)) return null;
        return {face: this.textAt(this.c.live_picked()), at: this.numbers(3)};
    }
}

if (typeof module !== 'undefined') module.exports = {Live};
