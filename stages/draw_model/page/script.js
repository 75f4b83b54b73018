/* script.js - the texts that people write: the model, its edits and the files of marks; with undo, and names for new
 * statements.
 *
 * A text is only ever changed as a whole, so undo restores its bytes. What a statement means is for the C code alone:
 * here its words are looked at to name new things, and to draw the pixels that it has. */
'use strict';

const HEADS = {model: 'remodel-script 1', edits: 'remodel-script 1', lights: 'remodel-lamps 1',
    things: 'remodel-marked-things 1', materials: 'remodel-marked-materials 1', objects: 'remodel-script 1'};

class Texts {
    /* texts: an object of names ("model.txt", "edits/E.txt") to their texts */
    constructor(texts) {
        this.now = {...texts};
        this.done = [];
        this.undone = [];
        this.watchers = [];
        this.isUndoing = false;
    }

    get(name) { return this.now[name] ?? ''; }
    names() { return Object.keys(this.now).sort(); }
    watch(call) { this.watchers.push(call); }

    /* typing: joins with the change before, if that was typing in the same file too */
    set(name, text, typing = false) {
        const before = this.now[name];
        if (before === text) return;
        const last = this.done[this.done.length - 1];
        if (typing && last && last.typing && last.name === name && Date.now() - last.time < 1500)
            Object.assign(last, {after: text, time: Date.now()});
        else
            this.done.push({name, before, after: text, typing, time: Date.now()});
        this.undone = [];
        this.put(name, text);
    }

    /* Changes other files as a part of the change that was made last: both are undone together. */
    follow(changes) {
        const last = this.done[this.done.length - 1];
        if (!last) return;
        const first = new Map((last.others || []).map((c) => [c.name, c.before]));
        last.others = [...(last.others || []).filter((c) => !(c.name in changes)),
            ...Object.entries(changes).map(([name, after]) => ({name, after,
                before: first.has(name) ? first.get(name) : this.now[name]}))];
        for (const [name, after] of Object.entries(changes)) this.put(name, after);
    }

    step(change, which) {
        this.isUndoing = true;
        for (const c of [...(change.others || []), change]) this.put(c.name, c[which]);
        this.isUndoing = false;
        return change.name;
    }

    put(name, text) {
        if (text === undefined) delete this.now[name];
        else this.now[name] = text;
        for (const call of this.watchers) call(name);
    }

    /* The file that changed; null: there was nothing to undo. */
    undo() {
        const change = this.done.pop();
        if (!change) return null;
        this.undone.push(change);
        return this.step(change, 'before');
    }

    redo() {
        const change = this.undone.pop();
        if (!change) return null;
        this.done.push(change);
        return this.step(change, 'after');
    }

    /* Puts a statement before a line, which counts from 1. */
    insert(name, line, statement) {
        const lines = this.get(name).split('\n');
        lines.splice(line - 1, 0, statement);
        this.set(name, lines.join('\n'));
    }

    /* Adds a statement as the last line, below the head that the file begins with. */
    add(name, statement) {
        const head = HEADS[name.split(/[/.]/)[0]];
        let text = this.get(name);
        if (!text.trim() && head) text = head + '\n';
        if (text && !text.endsWith('\n')) text += '\n';
        this.set(name, text + statement + '\n');
    }
}

const Script = {
    /* The statements of a text: {line, words}; line counts from 1. */
    statements(text) {
        return text.split('\n').map((line, i) => ({line: i + 1, words: line.split('#')[0].trim().split(/\s+/)}))
            .filter((s) => s.words[0]);
    },

    /* The names that statements give. */
    names(text) {
        const names = new Set();
        for (const {words} of Script.statements(text)) {
            if (words[0] === 'walls') for (const w of words.slice(1, words.indexOf('corner'))) names.add(w);
            else if (/^(wall|door|passage|window|skylight|hatch|box|room|thing|flat|disk|area|mark|object)$/.test(words[0])) names.add(words[1]);
            if (words[0] === 'split') names.add(words[words.length - 1]);
            if (words[0] === 'copy') names.add(words[words.indexOf('as') + 1]);
        }
        return names;
    },

    /* The lamps that a text marks. */
    lamps(text) { return Script.statements(text).map((s) => s.words).filter((w) => /^(disk|area)$/.test(w[0]) && w[1]).map((w) => w[1]); },

    /* A name that is not taken: door1, door2 ... */
    newName(kind, ...texts) {
        const taken = new Set(texts.flatMap((text) => [...Script.names(text)]));
        let n = 1;
        while (taken.has(kind + n)) n++;
        return kind + n;
    },

    /* A script in another unit: its lengths times a factor. Pixels, angles, colours and factors stay. */
    scaled(text, factor) {
        const most = {from: 2, to: 2, at: 3, by: 3, thickness: 1, foot: 1, top: 1, bottom: 1, left: 1, right: 1, front: 1,
            back: 1, floor: 1, ceiling: 1, slab: 1, glass: 1, leaf: 1, ridge: 1, off: 1, speed: 1};
        return text.split('\n').map((line) => {
            const at = line.indexOf('#'), code = at < 0 ? line : line.slice(0, at);
            const isSlope = /^\s*(slope|gable)\s/.test(code);
            let left = 0, word = 0;
            return code.replace(/\S+/g, (w) => {
                word++;
                if (!/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(w)) {
                    left = word === 2 && !/^set/.test(code.trim()) ? 0 : most[w] || (isSlope ? 1 : 0);
                    return w;
                }
                return left-- > 0 ? Script.number(factor * w, 5) : w;
            }) + (at < 0 ? '' : line.slice(at));
        }).join('\n');
    },

    /* What a text has of pixels in photos: {line, photo, kind: rectangle|line|corners, points}. */
    pixels(text) {
        const list = [];
        for (const {line, words} of Script.statements(text)) {
            const corners = [];
            for (let i = 0; i + 3 < words.length; i++) {
                if (words[i] !== 'in') continue;
                const numbers = [];
                for (let k = i + 2; k < words.length && /^[-+.0-9e]+$/.test(words[k]); k++) numbers.push(+words[k]);
                const rim = words[0] === 'disk' ? words.indexOf('rim') : -1;
                if (rim > 0 && numbers.length >= 2)
                    list.push({line, photo: words[i + 1], kind: 'line', points: [numbers.slice(0, 2),
                        [+words[rim + 1], +words[rim + 2]]]});
                else if (words[i - 1] === 'corner' && numbers.length >= 2)
                    corners.push({photo: words[i + 1], points: [numbers.slice(0, 2)]});
                else if (numbers.length >= 4) {
                    const points = [];
                    for (let k = 0; k + 1 < numbers.length; k += 2) points.push(numbers.slice(k, k + 2));
                    const isLine = /^(foot|top)$/.test(words[i - 1]) || words[0] === 'line';
                    list.push({line, photo: words[i + 1], kind: isLine || points.length > 2 ? 'line' : 'rectangle',
                        points});
                } else if (numbers.length >= 2)
                    list.push({line, photo: words[i + 1], kind: 'corners', points: [numbers.slice(0, 2)]});
            }
            for (const c of corners) list.push({line, photo: c.photo, kind: 'corners', points: c.points});
            if (/^(mark|corner|edge|point)$/.test(words[0]) && words.length >= 5 && !words.includes('in')) {
                /* of lri.txt: "corner IMAGE OPENING left bottom X Y" */
                const at = Number.isNaN(+words[3]) ? 1 : words[0] === 'point' ? 1 : 2, first = words[0] === 'point' ? 2
                    : at === 1 ? 5 : 3;
                list.push({line, photo: words[at], kind: 'corners', points: [[+words[first], +words[first + 1]]]});
            }
            if (words[0] === 'subject' && words.length >= 6) list.push({line, photo: words[1], kind: 'rectangle',
                points: [[+words[2], +words[3]], [+words[4], +words[5]]]});
            if (words[0] === 'horizon' && words.length >= 6) list.push({line, photo: words[1], kind: 'line',
                points: [[+words[2], +words[3]], [+words[4], +words[5]]]});
        }
        return list;
    },

    /* "PATH:LINE: text" of an error: {line, text}; line 0: it names none. */
    refusal(message, path) {
        const at = message.indexOf(path + ':');
        const match = at >= 0 && /^:(\d+)/.exec(message.slice(at + path.length));
        return {line: match ? +match[1] : 0, text: message};
    },

    number(value, digits = 2) { return String(+value.toFixed(digits)); },
};

if (typeof module !== 'undefined') module.exports = {Texts, Script};
