/* draw.js - the page: what is shown, and what keys, buttons and the pointer do.
 *
 * Each change of a text is built by the C code at once; what it refuses is said beside the photo, marked at its line and
 * at its pixels. The last model that could be built stays in sight. */
'use strict';

const el = (id) => document.getElementById(id);

const NOTHING = {walls: [], openings: [], slots: [], boxes: [], rooms: [], things: [], faces: [], vertices: []};

class App {
    constructor(scene, code) {
        const system = new WasiFiles(), encode = new TextEncoder();
        this.scene = scene;
        this.path = `scenes/${scene.name}/`;
        const texts = {};
        for (const [name, text] of Object.entries(scene.files)) {
            if (name.startsWith(this.path) && !name.endsWith('.obj')) texts[name.slice(this.path.length)] = text;
            else if (name) system.files.set(name, encode.encode(text));
        }
        texts['model.txt'] ??= '';
        this.system = system;
        this.live = new Live(bytesFromBase64(code), system);
        this.texts = new Texts(texts);
        this.view = new PhotoView(el('canvas'));
        this.picture = new PhotoPicture(this.view, this.live);
        this.solid = new SolidPicture(el('solid'));
        this.model = NOTHING;
        this.file = 'model.txt';
        this.tool = TOOLS.find((t) => t.id === (Script.statements(texts['model.txt']).length > 1 ? 'select' : 'wall'));
        this.points = [];
        this.pointPhotos = [];
        this.selected = [];
        this.refused = null;
        this.unit = 1; /* of the page's own axes, in what the page counts in now: metres if scale.txt says how many */
        this.hasPoints = scene.files['out/points'] !== undefined;
        this.marks = new Marks(this);
    }

    start() {
        const failed = this.begin(false);
        if (failed) return this.refuse(failed);
        const references = Object.entries(remodel.references).map(([id, [width, height]]) => ({id, width, height,
            isReference: true}));
        this.photos = [...this.live.json('live_photos'), ...references];
        this.photo = 0;
        this.pictures = new Photos(this.photos, () => this.draw());
        this.masks = new Masks(this.scene.masks, this.pictures, this.texts, () => this.draw());
        this.draft = new Draft(this.live, this.pictures, this.scene, () => this.showDraft());
        document.title = `Draw ${this.scene.name}`;
        el('title').textContent = this.scene.name;
        this.forms = new FormsPanel(el('forms'), this);
        this.suggested = [['model.txt', 'out/model/suggested.txt'], ['lights.txt', 'out/lights/candidates.txt']]
            .map(([file, from]) => new SuggestedPanel(el('suggested'), this, file, this.scene.files[from]));
        this.store = new Store(this.scene.name, this.texts, this.masks);
        this.listPhotos();
        this.listen();
        const kept = this.store.restore();
        if (kept.length) this.say(`Taken back from this browser, not saved yet: ${kept.join(', ')}.`);
        if (this.store.changedSince.length) this.say(`Changed on disk meanwhile: ${this.store.changedSince.join(', ')}. Undo shows that.`);
        this.texts.watch((name) => this.changed(name));
        this.openFile('model.txt');
        this.openPhoto(0);
        this.loadPoints();
    }

    /* ------------------------------------------------------------------------------------------------------- scale */

    /* The page was made without a scale, and scale.txt gives one now. */
    isScaledHere() { return this.ownAxes !== undefined && this.unit !== 1; }

    /* Counts in metres as soon as scale.txt says how long something is, as make axes will; scripts follow. */
    rescale(texts) {
        const path = 'out/model/axes.txt', own = this.ownAxes ?? new TextDecoder().decode(this.system.files.get(path));
        if (!/^scale \S+ unknown$/m.test(own) || this.waiting) return;
        const ratio = this.marks.metres(), to = ratio ? this.unit * ratio : 1, by = to / this.unit;
        if (Math.abs(by - 1) < 1e-7) return;
        this.ownAxes = own;
        const all = (numbers) => numbers.split(' ').map((n) => n === 'none' ? n : n * to).join(' ');
        const now = to === 1 ? own : own.replace(/^(translation|ceiling|thickness|error floor|error ceiling) (.*)$/gm, (_, key, n) => `${key} ${all(n)}`)
            .replace(/^scale .*$/m, `scale ${to} metres`).replace(/^error scale none$/m, 'error scale 0');
        this.system.files.set(path, new TextEncoder().encode(now));
        this.unit = to;
        if (this.ply) this.system.files.set('out/points/points.ply', this.ply);
        const failed = this.begin(!!this.ply);
        this.system.files.delete('out/points/points.ply');
        if (failed) return this.refuse(failed);
        this.draft.giveThings(to);
        this.picture.forget();
        if (!texts) return;
        const changes = {};
        for (const name of this.texts.names().filter((n) => LENGTH_FILES.test(n))) {
            const text = Script.scaled(this.texts.get(name), by);
            if (text !== this.texts.get(name)) changes[name] = text;
        }
        this.texts.follow(changes);
        this.say(ratio ? `The model is in metres now: 1 unit was ${to.toFixed(4)} m.${Object.keys(changes).length
            ? ` Lengths in ${Object.keys(changes).join(', ')} were multiplied by ${by.toFixed(4)}.` : ''}`
            : 'The model is in units without a scale again.');
    }

    /* What a model of rooms usually has and this one lacks; each line leads to where it is given. */
    showNext() {
        const has = (file, words) => Script.statements(this.texts.get(file)).some((s) => words.test(s.words[0]));
        const go = (file, form) => () => {
            this.openFile(file);
            this.forms.openForm(form);
        };
        const list = [];
        if (/^(model|scale|lights)\.txt$/.test(this.file)) {
            if (!has('model.txt', /^walls?$/)) list.push(['Walls', this.suggested[0].left.length ? 'accept what is suggested below, or drag rectangles' : 'drag rectangles']);
            else if (!has('model.txt', /^room$/)) list.push(['Rooms', 'Join walls, then Room']);
            else if (!has('model.txt', /^(door|passage|window)$/)) list.push(['Doors and windows', 'choose one above, and drag round it']);
            if (!this.live.isMetric() && !has('scale.txt', /^(length|height)$/)) list.push(['Scale', 'give the height of the ceiling, or a length', go('scale.txt', 'Height')]);
            if (!has('lights.txt', /^(disk|area)$/)) list.push(['Lamps', 'for pictures in new light', go('lights.txt', '')]);
        }
        el('next').replaceChildren(...list.map(([what, how, act]) => {
            const item = document.createElement('li'), name = document.createElement(act ? 'button' : 'b');
            name.textContent = what;
            if (act) name.type = 'button', name.onclick = act;
            item.append(name, `: ${how}`);
            return item;
        }));
        if (list.length) el('next').prepend('Not there yet');
    }

    begin(points) {
        return this.live.begin({views: 'out/views', axes: 'out/model/axes.txt', points: points
            ? 'out/points/points.ply' : '',
            config: this.system.files.has('out/build_model.cfg') ? 'out/build_model.cfg' : ''});
    }

    /* ------------------------------------------------------------------------------------------------------ points */

    loadPoints() {
        this.say('The points are being read; walls by rectangles wait for them.');
        this.waiting = true;
        remodel.points = async (packed) => {
            this.waiting = false;
            if (packed) {
                const ply = plyOfPoints(packed, await unpack(packed.parts));
                if (/^scale \S+ unknown$/m.test(new TextDecoder().decode(this.system.files.get('out/model/axes.txt')))) this.ply = ply; /* for a scale */
                this.system.files.set('out/points/points.ply', ply);
                const failed = this.begin(true);
                if (failed) return this.refuse(failed);
                this.system.files.delete('out/points/points.ply');
                this.say('Ready.');
                if (packed.every > 1) this.thinned = `Walls by rectangles use one point of ${packed.every} here; make model uses all, and may place them some mm elsewhere.`;
            } else
                this.say('This scene has no points: draw walls by their feet or by corners.');
            await this.draft.takeThings(this.photos.map((p) => p.id));
            this.picture.forget();
            this.build();
            this.rescale(false);
            if (this.unit !== 1) this.changed();
            this.ready = true;
        };
        const script = document.createElement('script');
        script.src = 'points.js';
        script.onerror = () => remodel.points(null);
        document.body.append(script);
    }

    /* ------------------------------------------------------------------------------------------------------- texts */

    openFile(name) {
        this.file = name;
        this.points = [];
        if (!SCRIPT_FILES.test(name)) this.selected = [];
        if (!this.tool.files.test(name)) this.tool = TOOLS.find((t) => t.files.test(name)) || TOOLS[0];
        const marks = ['scale.txt', 'axes_fix.txt', 'lights.txt', 'materials.txt', 'things.txt', 'subjects.txt',
            'masks.txt', 'lri.txt'], says = {'masks.txt': 'masks of photos', 'lri.txt': 'lri.txt (reference images)'};
        const edits = this.texts.names().filter((n) => EDIT_FILES.test(n));
        const others = this.texts.names().filter((n) => n !== 'model.txt' && !EDIT_FILES.test(n) &&
            !marks.includes(n) && /^(objects|tour)\.txt$/.test(n));
        el('file').replaceChildren();
        for (const [title, names] of [['Model', ['model.txt']], ['Edits', edits], ['Marks', marks],
            ['Others', others]]) {
            const group = document.createElement('optgroup');
            group.label = title;
            for (const n of names) group.append(new Option(says[n] || n, n, false, n === name));
            if (names.length) el('file').append(group);
        }
        el('file').value = name;
        this.listTools();
        this.showText();
        this.build();
        this.forms.show();
        this.showSuggested();
        if (name === 'lri.txt' && !this.photos[this.photo].isReference && this.photos.some((p) =>
            p.isReference)) this.openPhoto(this.photos.findIndex((p) => p.isReference));
    }

    changed(name) {
        if (name === 'scale.txt') this.rescale(!this.texts.isUndoing);
        this.showText();
        this.build();
        this.showSuggested();
    }

    showSuggested() {
        el('suggested').replaceChildren();
        for (const panel of this.suggested) panel.show();
        this.showNext();
    }

    showText() {
        const text = el('text'), now = this.texts.get(this.file);
        if (text.value !== now) text.value = now;
        el('undo').disabled = !this.texts.done.length;
        el('redo').disabled = !this.texts.undone.length;
        const unsaved = this.store.unsaved();
        el('saved').textContent = unsaved.length ? `not saved: ${unsaved.join(', ')}` : 'saved';
    }

    showNumbers() {
        const current = this.currentLine(), refused = this.refused ? this.refused.line : 0;
        el('numbers').innerHTML = this.texts.get(this.file).split('\n').map((_, i) =>
            i + 1 === refused ? `<b>✕ ${i + 1}</b>` : i + 1 === current ? `<i>▸ ${i + 1}</i>` : i + 1).join('\n');
        el('numbers').scrollTop = el('text').scrollTop;
    }

    currentLine() {
        const text = el('text');
        return document.activeElement === text || this.showLine
            ? text.value.slice(0, text.selectionStart).split('\n').length : 0;
    }

    /* Writes one statement, or several lines, below what the file has. */
    write(statement) {
        this.texts.add(this.file, statement);
        el('text').scrollTop = el('text').scrollHeight;
        this.forms.show();
    }

    /* ------------------------------------------------------------------------------------------------------- model */

    build() {
        const put = (name, text) => this.system.files.set(this.path + name, new TextEncoder().encode(text));
        for (const name of this.texts.names()) put(name, this.texts.get(name));
        const isEdit = EDIT_FILES.test(this.file);
        this.draft.stop();
        this.draft.ready = false;
        el('compare').hidden = !isEdit;
        const files = {script: this.path + 'model.txt',
            things: this.texts.get('things.txt') ? this.path + 'things.txt' : '',
            edit: isEdit ? this.path + this.file : '', scene: isEdit ? this.path.slice(0, -1) : ''};
        this.refused = null;
        el('refusal').hidden = el('remedy').hidden = true;
        const empty = !Script.statements(this.texts.get('model.txt')).filter((s) =>
            s.words[0] !== 'remodel-script').length;
        if (this.waiting || empty) {
            if (empty) this.showNothing();
            this.showMarks();
            this.draw();
            return;
        }
        const failed = this.live.build(files);
        this.notes();
        /* a script that only sets defaults is a beginning */
        if (/the script describes no solid/.test(failed)) this.showNothing();
        else if (failed) this.refuse(failed);
        else {
            this.showModel();
            if (isEdit) this.beginDraft(files);
        }
        this.showMarks();
        this.draw();
    }

    /* The draft begins a little after the last change, so that typing stays quick. */
    beginDraft(files) {
        const failed = this.draft.begin(files);
        if (failed) this.draft.about = `Without a draft: ${failed}`;
        clearTimeout(this.draftTimer);
        this.draftTimer = setTimeout(() => this.makeDraft(), 120);
        this.showDraft();
    }

    makeDraft() {
        if (this.draft.ready && !this.photos[this.photo].isReference) this.draft.make(this.photo);
    }

    showDraft() {
        el('draft-note').textContent = this.draft.about || 'The draft is being made.';
        this.draw();
    }

    showMarks() {
        this.marks.read();
        this.marks.draw(el('plan'));
        el('meant').replaceChildren(...this.marks.sentences.map((text) => {
            const item = document.createElement('li');
            item.textContent = text;
            return item;
        }));
    }

    showNothing() {
        this.model = NOTHING;
        this.selected = [];
        this.picture.forget();
        el('plan').innerHTML = '<p>The plan appears with the first wall.</p>';
        this.solid.draw(this.model);
    }

    showModel() {
        this.model = this.live.json('live_model') || this.model;
        this.picture.forget();
        this.selected = this.selected.filter((s) => this.model.faces.some((f) => f.name === s.face));
        if (!this.live.writePlan('plan.svg')) el('plan').innerHTML = new TextDecoder().decode(this.system.files.get('plan.svg'));
        this.solid.draw(this.model, this.selected[0] && this.selected[0].name);
    }

    /* Says what the C code refused, in its words, and where. */
    refuse(message) {
        const path = this.path + this.file, other = this.path + 'model.txt';
        this.refused = Script.refusal(message, path);
        if (!this.refused.line && this.file !== 'model.txt' &&
            message.includes(other + ':')) this.refused.text = message;
        el('refusal').textContent = message.split(this.path).join('');
        el('refusal').hidden = false;
        el('undo-it').hidden = !this.texts.done.length;
        this.offer(message);
    }

    /* Without a scale lengths of homes mean nothing; a guess by the ceiling's height is offered. */
    offer(message) {
        const wanted = /write "set (thickness|slab|glass|leaf) NUMBER" before/.exec(message), line = this.refused.line;
        el('remedy').hidden = false;
        el('remedy-button').hidden = !wanted || !line;
        if (!wanted || !line) return;
        const share = {thickness: 0.06, slab: 0.06, glass: 0.008, leaf: 0.016}[wanted[1]];
        const statement = `set ${wanted[1]} ${Script.number(share * this.live.height(), 4)}`;
        el('remedy-button').textContent = `Write "${statement}" before it: ${100 * share} % of the ceiling's height, a guess`;
        el('remedy-button').onclick = () => this.texts.insert(this.file, line, statement);
    }

    notes() {
        const lines = this.system.lines.map((l) => l.replace(/^build_model: /, ''));
        if (this.thinned && /^wall \S+ in /m.test(this.texts.get(this.file))) lines.push(this.thinned);
        el('notes').textContent = lines.join('\n') || this.said || '';
    }

    say(text) {
        this.said = text;
        el('notes').textContent = text;
    }

    pick(u, v) { return this.live.pick(this.photo, u, v); }
    ray(u, v) { return this.live.ray(this.photo, u, v); }
    photoId() { return this.photos[this.photo].id; }
    px(value) { return Script.number(value, 2); }
    colour() { return (this.forms.colour || '#3355aa').match(/\w\w/g).map((h) => parseInt(h, 16) / 255)
        .map((v) => Script.number(v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4, 3)).join(' '); }
    named() { return (this.forms.name || '').trim(); }
    /* The lamp that the next mark is of: the one that was chosen, else the last one. */
    lamp() {
        const lamps = Script.lamps(this.texts.get('lights.txt'));
        return lamps.includes(this.named()) ? this.named() : lamps[lamps.length - 1];
    }
    newLamp() { return this.forms.name = this.newName('lamp'); }
    markName(kind) { return this.named() || this.newName(kind); }
    onFloor() { return this.file === 'scale.txt'; }

    newName(kind, more = '') { return Script.newName(kind, ...this.texts.names().map((n) => this.texts.get(n)), more); }

    select(hit, more) {
        const item = itemOf(this, hit && hit.face);
        this.selected = item ? more ? [...this.selected, item] : [item] : [];
        this.solid.draw(this.model, this.selected[0] && this.selected[0].name);
        this.forms.show();
        if (item && item.of.line && this.file === 'model.txt') this.goToLine(item.of.line);
        this.hint();
        return null;
    }

    selectedWalls() { return this.selected.filter((s) => s.kind === 'wall').map((s) => s.name).join(' '); }
    selectedName(kind, at = 0) {
        const item = this.selected.filter((s) => !kind || s.kind === kind)[at];
        return item ? item.name : '';
    }

    goToLine(line) {
        const text = el('text'), start = text.value.split('\n').slice(0, line - 1).join('\n').length +
            (line > 1 ? 1 : 0);
        text.setSelectionRange(start, start);
        text.scrollTop = Math.max(0, (line - 4) * 18);
        this.showLine = true;
        this.showNumbers();
    }

    /* ------------------------------------------------------------------------------------------------------ photos */

    listPhotos() {
        const title = (text) => {
            const e = document.createElement('span');
            e.className = 'group';
            e.textContent = text;
            return e;
        };
        this.buttons = this.photos.map((p, i) => {
            const button = document.createElement('button'), image = document.createElement('img');
            button.type = 'button';
            image.src = this.pictures.small(p.id);
            image.alt = '';
            const face = this.faceOf(i);
            button.append(image, face ? face.turn : p.id);
            if (face) button.setAttribute('aria-label', `${p.id}: panorama ${face.of}, ${face.turn}`);
            button.onclick = () => this.openPhoto(i);
            return button;
        });
        const first = this.photos.findIndex((p) => p.isReference);
        el('photos').replaceChildren(...this.buttons);
        /* faces of one panorama were taken from one place */
        this.photos.forEach((p, i) => {
            const of = (k) => (this.photos[k] && this.faceOf(k) || {}).of;
            if (of(i) && of(i) !== of(i - 1)) this.buttons[i].before(title(of(i)));
            else if (i && !of(i) && of(i - 1) && !p.isReference) this.buttons[i].before(title('Photos'));
        });
        if (first >= 0) this.buttons[first].before(title('Reference images'));
    }

    /* {of: the panorama, turn: where it looks} of a photo that is cut out of a panorama, by its name, or one of several
     * NAME_PART that were taken from one place; null of others */
    faceOf(i) {
        const {id} = this.photos[i], face = /^(.+)_yaw(\d{3})$/.exec(id), turn = face && +face[2];
        if (!face || turn % 60 || turn > 300) {
            const part = /^(.+)_([^_]+)$/.exec(id), from = part && this.placeOf(i);
            const isBeside = (k) => this.photos[k] && !this.photos[k].isReference && this.photos[k].id.startsWith(part[1] + '_') &&
                away(from, this.placeOf(k) || [Infinity, 0, 0]) < 1e-6 * this.live.height();
            return from && (isBeside(i - 1) || isBeside(i + 1)) ? {of: part[1], turn: part[2]} : null;
        }
        return {of: face[1], turn: !turn ? 'ahead' : turn <= 180 ? `${turn}° right` : `${360 - turn}° left`};
    }

    /* Where a photo was taken; null: it has no camera. */
    placeOf(i) {
        const p = this.photos[i], ray = !p.isReference && this.live.ray(i, p.width / 2, p.height / 2);
        return ray ? [...ray].slice(0, 3) : null;
    }

    openPhoto(i) {
        this.photo = i;
        if (this.tool.form !== 'corners') this.points = [];
        this.buttons.forEach((b, k) => b.setAttribute('aria-pressed', k === i));
        this.buttons[i].scrollIntoView({block: 'nearest'});
        this.view.setPhoto(this.photos[i].width, this.photos[i].height);
        this.cursor = this.view.size.map((s) => s / 2);
        if (this.draft.ready) {
            this.draft.picture = null;
            this.draft.about = '';
            this.showDraft();
            this.makeDraft();
        }
        this.draw();
    }

    draw() {
        if (!this.photos) return;
        const id = this.photoId(), current = this.currentLine(), refused = this.refused ? this.refused.line : 0,
            drawn = [];
        for (const p of Script.pixels(this.texts.get(this.file))) {
            if (p.photo.split('@')[0] !== id) continue;
            const isRefused = p.line === refused;
            if (!el('show-drawn').checked && !isRefused && p.line !== current) continue;
            drawn.push({...p, refused: isRefused, current: p.line === current, label: isRefused
                ? `refused, line ${p.line}` : p.line === current ? `line ${p.line}` : ''});
        }
        const here = this.points.filter((_, k) => this.pointPhotos[k] === id);
        const gesture = here.length ? {kind: this.tool.form === 'rectangle' ? 'rectangle' : 'line',
            points: this.cursor && here.length === this.points.length ? [...here, this.cursor] : here} : null;
        const known = !this.photos[this.photo].isReference, overlay = this.file === 'masks.txt' &&
            this.masks.overlay(id);
        this.picture.draw({image: this.pictures.image(id), photo: this.photo, drawn, gesture,
            mask: overlay && overlay.canvas, draft: EDIT_FILES.test(this.file) && this.draft.picture,
            split: el('split').value / 100,
            lines: this.scene.lines[id] || [],
            cursor: this.cursor, snapped: this.snapped,
            shown: {edges: known && el('show-edges').checked && this.model.faces.length,
                points: known && el('show-points').checked,
                lines: el('show-lines').checked, floor: known && el('show-floor').checked}});
        el('where').textContent = this.cursor ? `${id}  ${this.px(this.cursor[0])} ${this.px(this.cursor[1])}` : id;
        this.showNumbers();
    }

    /* ---------------------------------------------------------------------------------------------------- gestures */

    listTools() {
        el('tools').replaceChildren(...TOOLS.filter((t) => t.files.test(this.file)).map((t) => {
            const button = document.createElement('button');
            button.type = 'button';
            button.textContent = t.label;
            button.id = 'tool-' + t.id;
            if (t.key) button.title = `key ${t.key}`;
            button.setAttribute('aria-pressed', t === this.tool);
            button.onclick = () => this.chooseTool(t);
            return button;
        }));
        this.hint();
    }

    chooseTool(tool) {
        this.tool = tool;
        this.points = [];
        this.listTools();
        this.draw();
    }

    hint() {
        const what = this.selected.length ? ` Selected: ${this.selected.map((s) => `${s.kind === 'floor' ||
            s.kind === 'ceiling' ? 'room' : s.kind} ${s.name}`).join(', ')}.` : '';
        el('hint').textContent = this.tool.hint + what;
    }

    /* The nearest corner or edge of the model, or straight edge of the photo, within 8 px of the screen. */
    snap(at, isOff) {
        this.snapped = false;
        if (isOff || !el('snap').checked) return at;
        let best = 8 / this.view.scale, found = null;
        const consider = (p, weight) => {
            const d = Math.hypot(p[0] - at[0], p[1] - at[1]) * weight;
            if (d < best) best = d, found = p;
        };
        /* an opening that reaches the edge of its wall is refused */
        const toModel = !/^(door|passage|window|slot)$/.test(this.tool.id) && !this.photos[this.photo].isReference;
        if (el('show-edges').checked && this.model.faces.length && toModel) {
            const dots = this.picture.edges(this.photo);
            for (let i = 0; i < dots.length; i += 3) if (dots[i + 2] & 1) consider([dots[i], dots[i + 1]], 1.5);
            for (const p of this.corners()) consider(p, 0.7);
        }
        for (const l of this.scene.lines[this.photoId()] || [])
            for (let i = 0; i + 3 < l.length; i += 2) {
                const a = [l[i], l[i + 1]], b = [l[i + 2], l[i + 3]], d = [b[0] - a[0], b[1] - a[1]];
                const t = Math.min(1, Math.max(0, ((at[0] - a[0]) * d[0] + (at[1] - a[1]) * d[1]) / (d[0] * d[0] +
                    d[1] * d[1] || 1)));
                consider([a[0] + t * d[0], a[1] + t * d[1]], 1);
            }
        this.snapped = found !== null;
        return found ? [...found] : at;
    }

    corners() {
        return this.picture.keep('corners' + this.photo, () =>
            this.model.vertices.map((p) => this.live.project(this.photo, p)).filter((p) => p));
    }

    setPoint(at, more = false) {
        const tool = this.tool, corner = this.view.clamp(at);
        if (tool.form === 'pixel') return this.finish([corner], more);
        const last = this.points[this.points.length - 1];
        if (tool.form === 'corners' && last && Math.hypot(last[0] - corner[0],
            last[1] - corner[1]) * this.view.scale < 2 && this.points.length > 1)
            return this.finish(this.points);
        this.points.push(corner);
        this.pointPhotos[this.points.length - 1] = this.photoId();
        if (this.points.length === (tool.id === 'area' ? 4 : tool.form === 'corners' ? Infinity : 2)) return this.finish(this.points);
        this.draw();
    }

    finish(points, more) {
        const photos = [...this.pointPhotos], made = this.tool.make(this, points, this.tool.form === 'pixel' ? more
            : photos);
        this.points = [];
        this.pointPhotos = [];
        if (made && made.error) this.complain(made.error);
        else if (made) this.write(made);
        this.draw();
    }

    /* A gesture that makes no statement. */
    complain(text) {
        el('refusal').textContent = text;
        el('refusal').hidden = false;
        el('remedy').hidden = true;
    }

    listen() {
        const canvas = el('canvas');
        let from = null, pan = null, grip = false;
        canvas.addEventListener('pointerdown', (e) => {
            canvas.focus();
            canvas.setPointerCapture(e.pointerId);
            if (e.button === 1 || e.button === 2 || e.altKey) {
                pan = [e.clientX, e.clientY];
                return;
            }
            this.showLine = false;
            if (this.isOnGrip(e)) {
                grip = true;
                return;
            }
            from = [e.clientX, e.clientY];
            this.cursor = this.snap(this.view.toPhoto(e), e.ctrlKey);
            this.setPoint(this.cursor, e.shiftKey);
        });
        canvas.addEventListener('pointermove', (e) => {
            if (pan) {
                this.view.pan(e.clientX - pan[0], e.clientY - pan[1]);
                pan = [e.clientX, e.clientY];
                this.draw();
                return;
            }
            if (grip) {
                el('split').value = 100 * this.view.toPhoto(e)[0] / this.view.size[0];
                this.draw();
                return;
            }
            canvas.style.cursor = this.isOnGrip(e) ? 'ew-resize' : '';
            this.cursor = this.snap(this.view.toPhoto(e), e.ctrlKey);
            this.draw();
        });
        canvas.addEventListener('pointerup', (e) => {
            grip = false;
            const moved = from && Math.hypot(e.clientX - from[0], e.clientY - from[1]) > 4;
            from = pan = null;
            if (!moved || !this.points.length || this.tool.form === 'corners') return;
            this.cursor = this.snap(this.view.toPhoto(e), e.ctrlKey);
            this.setPoint(this.cursor);
        });
        canvas.addEventListener('contextmenu', (e) => e.preventDefault());
        canvas.addEventListener('wheel', (e) => {
            e.preventDefault();
            this.view.zoom(e.deltaY < 0 ? 1.2 : 1 / 1.2, ...this.view.toPhoto(e));
            this.draw();
        }, {passive: false});
        canvas.addEventListener('keydown', (e) => this.canvasKey(e));
        document.addEventListener('keydown', (e) => this.pageKey(e));
        el('text').addEventListener('input', () => this.texts.set(this.file, el('text').value, true));
        el('text').addEventListener('scroll', () => { el('numbers').scrollTop = el('text').scrollTop; });
        for (const type of ['keyup', 'click', 'focus', 'blur'])
            el('text').addEventListener(type, () => { this.showLine = false; this.draw(); });
        el('file').onchange = () => this.openFile(el('file').value);
        el('new-edit').onclick = () => this.newEdit();
        el('undo').onclick = el('undo-it').onclick = () => this.undo();
        el('redo').onclick = () => this.redo();
        el('save').onclick = () => this.save();
        el('help-button').onclick = () => this.help();
        el('zoom-in').onclick = () => this.zoom(1.5);
        el('zoom-out').onclick = () => this.zoom(1 / 1.5);
        el('zoom-all').onclick = () => { this.view.showAll(); this.draw(); };
        el('plan-larger').onclick = () => this.enlargePlan();
        el('split').oninput = () => this.draw();
        for (const id of ['show-edges', 'show-points', 'show-floor', 'show-lines', 'show-drawn',
            'snap']) el(id).onchange = () => this.draw();
        new ResizeObserver(() => {
            if (this.view.whole) this.view.showAll();
            this.draw();
        }).observe(el('stage'));
        new ResizeObserver(() => this.solid.draw(this.model, this.selected[0] &&
            this.selected[0].name)).observe(el('solid'));
    }

    /* The pointer is on the grip of the border, which lies at the foot of the photo. */
    isOnGrip(e) {
        if (!EDIT_FILES.test(this.file) || !this.draft.picture) return false;
        const r = el('canvas').getBoundingClientRect(), [x, y] = this.picture.grip(el('split').value / 100);
        return Math.hypot(e.clientX - r.left - x, e.clientY - r.top - y) < 14;
    }

    zoom(factor) {
        this.view.zoom(factor, ...this.cursor);
        this.view.reveal(...this.cursor);
        this.draw();
    }

    canvasKey(e) {
        const by = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[e.key];
        if (by) {
            const step = e.shiftKey ? 20 : e.ctrlKey ? 0.1 : 1;
            this.cursor = this.view.clamp(this.cursor.map((v, k) => v + step * by[k]));
            this.snapped = false;
            this.view.reveal(...this.cursor);
        } else if (e.key === 'Enter')
            this.setPoint(this.cursor, e.shiftKey);
        else if (e.key === 'Escape') {
            this.points = [];
            this.pointPhotos = [];
        } else if (e.key === '+' || e.key === '=')
            this.zoom(1.5);
        else if (e.key === '-')
            this.zoom(1 / 1.5);
        else if (e.key === '0')
            this.view.showAll();
        else
            return;
        e.preventDefault();
        this.draw();
    }

    pageKey(e) {
        const control = e.ctrlKey || e.metaKey, key = e.key.toLowerCase(),
            inText = /^(INPUT|TEXTAREA|SELECT)$/.test(e.target.tagName) && e.target.type !== 'checkbox';
        if (!control && !e.altKey && !inText && /^[[\]]$/.test(key) && !el('compare').hidden) this.moveBorder(key === '[' ? -5 : 5);
        else if (!control && !e.altKey && !inText && key === '.') this.enlargePlan();
        else if (control && key === 's') this.save();
        else if (control && key === 'z' && !e.shiftKey) this.undo();
        else if (control && (key === 'y' || (key === 'z' && e.shiftKey))) this.redo();
        else if (!control && !e.altKey && !inText && e.key === '?') this.help();
        else if (!control && !e.altKey && !inText && (key === 'pagedown' || key === 'pageup'))
            this.openPhoto((this.photo + (key === 'pagedown' ? 1 : this.photos.length - 1)) % this.photos.length);
        else {
            const tool = !control && !e.altKey && !inText && TOOLS.find((t) => t.key && t.key === key &&
                t.files.test(this.file));
            if (!tool) return;
            this.chooseTool(tool);
            el('canvas').focus();
        }
        e.preventDefault();
    }

    enlargePlan() {
        const on = el('pictures').classList.toggle('larger');
        el('plan-larger').setAttribute('aria-pressed', on);
        this.showMarks();
    }

    moveBorder(by) {
        el('split').value = +el('split').value + by;
        this.draw();
    }

    undo() { this.after(this.texts.undo()); }
    redo() { this.after(this.texts.redo()); }
    after(name) {
        this.points = [];
        if (name && name !== this.file && (this.texts.now[name] !== undefined ||
            name === 'model.txt')) this.openFile(name);
        else if (name && this.texts.now[this.file] === undefined &&
            EDIT_FILES.test(this.file)) this.openFile('model.txt');
    }

    async save() {
        try {
            this.say(await this.store.save());
        } catch (e) {
            this.say(e.name === 'AbortError' ? 'Not saved: no folder was chosen.' : `Not saved: ${e.message}`);
        }
        this.showText();
    }

    newEdit() {
        const dialog = el('ask'), form = document.createElement('form'), ok = document.createElement('button');
        form.method = 'dialog';
        ok.textContent = 'Begin it';
        const name = field('name', 'Name of the edit, of letters, digits, _ and -:', '');
        form.append(name, ' ', ok);
        dialog.replaceChildren(form);
        form.onsubmit = () => {
            const given = form.elements.name.value.trim();
            if (!/^[A-Za-z0-9_][A-Za-z0-9_-]*$/.test(given)) return this.complain(`"${given}" is not a name: use letters, digits, _ and -.`);
            const file = `edits/${given}.txt`;
            if (this.texts.now[file] === undefined) this.texts.set(file, 'remodel-script 1\n');
            this.openFile(file);
        };
        dialog.showModal();
    }

    help() {
        const keys = [['arrows', 'move the cursor by a pixel of the photo; Shift: by 20, Ctrl: by 0.1'],
            ['Enter', 'sets a corner, as a click does; twice ends a chain'],
            ['Ctrl', 'held while clicking: without snapping'], ['Escape', 'begins the gesture again'], ['PageUp PageDown', 'other photos'],
                ['+ - 0', 'larger, smaller, the whole photo; the wheel does the same, Alt and drag moves it'],
            ['[ ]', 'of an edit: move the border between the photo and the draft of the edited room'],
            ['.', 'the plan larger'], ['Ctrl+Z Ctrl+Y', 'undo, redo'], ['Ctrl+S', 'save'], ['Tab', 'from part to part']];
        const tools = TOOLS.filter((t) => t.key).map((t) => [t.key, `${t.label}: ${t.hint}`]);
        const rows = [...keys, ...tools].map(([k, what]) =>
            `<tr><td><kbd>${k}</kbd></td><td>${what}</td></tr>`).join('');
        el('help').innerHTML = `<h2>How to draw</h2><p>Choose a photo on the left and a tool above it. Each gesture writes one statement into the script on the right, and the model is built at once.
            Begin with the walls, then <b>Join walls</b> and <b>Room</b>, then doors and windows;
                or accept what is suggested. What is refused says why: undo it, or correct its line.</p>
            <table>${rows}</table><form method="dialog"><button>Close</button></form>`;
        el('help').showModal();
    }
}

const app = new App(remodel.scene, remodel.code);
app.start();
