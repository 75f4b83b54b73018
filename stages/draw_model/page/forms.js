/* forms.js - statements that need no pixel, as rows of fields: joins, rooms, heights, and what changes an item. */
'use strict';

/* label, files, fields [name, what, value], make(values, app) */
const FORMS = [
    ['Join walls', SCRIPT_FILES, [['walls', 'walls in order, the first again at the end to close', (app) =>
        app.selectedWalls()]], (v) => `join ${v.walls}`],
    ['Room', SCRIPT_FILES, [['name', 'name', (app) => app.newName('room')],
        ['walls', 'walls round it', (app) => app.selectedWalls()], ['ceiling', 'ceiling, if not the usual', () => '']],
        (v) => `room ${v.name} ${v.walls}${v.ceiling ? ' ceiling ' + v.ceiling : ''}`],
    ['Extend wall', SCRIPT_FILES, [['wall', 'wall', (app) => app.selectedName('wall')],
        ['end', 'start or end', () => 'end'], ['to', 'to wall or S', (app) => app.selectedName('wall', 1)]],
        (v) => `extend ${v.wall} ${v.end} to ${v.to}`],
    ['Split wall', SCRIPT_FILES, [['wall', 'wall', (app) => app.selectedName('wall')], ['from', 'from S', () => ''],
        ['to', 'to S', () => ''], ['into', 'new wall', (app) => app.newName('wall')]],
        (v) => `split ${v.wall} from ${v.from} to ${v.to} into ${v.into}`],
    ['Heights and thickness', SCRIPT_FILES, [['what', 'ceiling, floor, thickness, slab, glass or leaf', () =>
        'ceiling'], ['value', 'number', () => '']],
        (v) => `set ${v.what} ${v.value}`],
    ['Change', SCRIPT_FILES, [['name', 'wall, box or room', (app) => app.selectedName()],
        ['how', 'such as "top 2.1" or "ceiling 2.6"', () => '']], (v) => `change ${v.name} ${v.how}`],
    ['Fill opening', SCRIPT_FILES, [['name', 'opening', (app) => app.selectedName()],
        ['with', 'leaf, glass, wall or nothing', () => 'glass']], (v) => `fill ${v.name} with ${v.with}`],
    ['Remove', SCRIPT_FILES, [['name', 'what', (app) => app.selectedName()]], (v) => `remove ${v.name}`],
    ['Clear a room', EDIT_FILES, [['what', 'room, thing or all', (app) => app.selectedName('floor') || 'all']], (v) =>
        `clear ${v.what}`],
    ['Move a thing', EDIT_FILES, [['name', 'thing', () => ''], ['by', 'DX DY', () => ''],
        ['turn', 'degrees', () => '']], (v) => `move ${v.name} by ${v.by}${v.turn ? ' turn ' + v.turn : ''}`],
    ['Lamp', EDIT_FILES, [['name', 'lamp', () => ''], ['how', '"off" or "scale R G B"', () => 'off']], (v) =>
        `lamp ${v.name} ${v.how}`],
    ['Length', {test: (f) => f === 'scale.txt'}, [['from', 'mark', () => ''], ['to', 'mark', () => ''],
        ['length', 'metres', () => '']], (v) => `length ${v.from} ${v.to} ${v.length}`],
    ['Height', {test: (f) => f === 'scale.txt'}, [['what', 'ceiling or a door', () => 'ceiling'],
        ['height', 'metres', () => '']], (v) => `height ${v.what} ${v.height}`],
    ['Thickness', {test: (f) => f === 'axes_fix.txt'}, [['a', 'mark', () => ''], ['b', 'mark', () => '']], (v) =>
        `thickness ${v.a} ${v.b}`],
    ['Any statement', {test: () => true}, [['line', 'as docs/model-script.md writes it', () => '']], (v) => v.line],
];

const CORNERS = ['left bottom', 'right bottom', 'right top', 'left top'];

class FormsPanel {
    constructor(element, app) {
        this.element = element;
        this.app = app;
        this.open = '';
    }

    openForm(label) {
        this.open = label;
        this.show();
        const field = [...this.element.querySelectorAll('form input')].find((f) => !f.value);
        if (field && label) field.focus();
    }

    show() {
        const buttons = document.createElement('div');
        this.element.replaceChildren(buttons);
        buttons.className = 'buttons';
        for (const form of FORMS.filter((f) => f[1].test(this.app.file))) {
            const button = document.createElement('button');
            button.type = 'button';
            button.textContent = form[0];
            button.setAttribute('aria-pressed', this.open === form[0]);
            button.onclick = () => {
                this.open = this.open === form[0] ? '' : form[0];
                this.show();
                const fields = [...this.element.querySelectorAll('form input')];
                const first = fields.find((f) => !f.value) || fields[0];
                if (first) first.focus();
            };
            buttons.append(button);
            if (this.open === form[0]) this.element.append(this.fields(form));
        }
        const options = document.createElement('form');
        options.onsubmit = (e) => e.preventDefault();
        if (EDIT_FILES.test(this.app.file)) options.append(field('colour', 'colour to paint', this.colour ||
            '#3355aa', 'color', (v) => { this.colour = v; }));
        if (this.app.file === 'lri.txt') this.cornerFields(options);
        else if (this.app.file === 'lights.txt') this.lampField(options);
        else if (/^(scale|axes_fix|materials)\.txt$/.test(this.app.file)) this.nameField(options);
        if (options.children.length) this.element.append(options);
    }

    /* Which lamp the next lit or unlit place, or line, is of. */
    lampField(form) {
        const lamps = Script.lamps(this.app.texts.get('lights.txt')), label = document.createElement('label'),
            choice = document.createElement('select');
        if (!lamps.length) return;
        choice.name = 'lamp';
        for (const n of lamps) choice.append(new Option(n, n, false, n === this.app.lamp()));
        choice.onchange = () => { this.name = choice.value; };
        label.append('Lit, Unlit and Cone line are of ', choice);
        form.append(label);
    }

    /* Which mark or material the next gesture is of; those that there are, are proposed. */
    nameField(form) {
        const what = this.app.file === 'materials.txt' ? 'name of the material' : 'name of the next mark, if it shall have one';
        const name = field('name', what, this.name || '', 'text', (v) => { this.name = v; });
        const known = document.createElement('datalist');
        known.id = 'known-names';
        for (const n of Script.names(this.app.texts.get(this.app.file))) known.append(new Option(n));
        name.querySelector('input').setAttribute('list', 'known-names');
        form.append(name, known);
    }

    /* Which corner of which opening the next click is. */
    cornerFields(form) {
        const opening = field('opening', 'opening', this.opening || '', 'text', (v) => { this.opening = v; });
        const names = document.createElement('datalist');
        names.id = 'openings';
        for (const o of this.app.model.openings) names.append(new Option(o.name));
        opening.querySelector('input').setAttribute('list', 'openings');
        const label = document.createElement('label'), choice = document.createElement('select');
        choice.name = 'corner';
        this.corner = this.corner || CORNERS[0];
        for (const c of CORNERS) choice.append(new Option(c, c, false, c === this.corner));
        choice.onchange = () => { this.corner = choice.value; };
        label.append('corner, seen from inside ', choice);
        const outer = field('outer', 'on the outer face', '', 'checkbox');
        outer.querySelector('input').checked = this.outer || false;
        outer.querySelector('input').onchange = (e) => { this.outer = e.target.checked; };
        form.append(opening, names, label, outer);
    }

    nextCorner() { this.corner = CORNERS[(CORNERS.indexOf(this.corner) + 1) % CORNERS.length]; }

    fields([label, , fields, make]) {
        const form = document.createElement('form');
        for (const [name, what, value] of fields) form.append(field(name, what, value(this.app)));
        const add = document.createElement('button');
        add.textContent = 'Write it';
        form.append(add);
        form.onsubmit = (e) => {
            e.preventDefault();
            const values = Object.fromEntries([...form.elements].filter((i) => i.name).map((i) =>
                [i.name, i.value.trim()]));
            this.open = '';
            this.app.write(make(values, this.app).trim().replace(/\s+/g, ' '));
        };
        form.setAttribute('aria-label', label);
        return form;
    }
}

function field(name, what, value, type = 'text', changed = null) {
    const label = document.createElement('label'), input = document.createElement('input');
    input.name = name;
    input.type = type;
    input.value = value;
    if (type === 'text') input.style.width = name === 'walls' || name === 'line' ? '18em' : '7em';
    if (changed) input.oninput = () => changed(input.value);
    label.append(what + ' ', input);
    return label;
}

/* The statements that a file of the scene's products proposes, each to take, to correct or to drop. */
class SuggestedPanel {
    /* file: that they are for */
    constructor(element, app, file, text) {
        this.element = element;
        this.app = app;
        this.file = file;
        this.left = [];
        this.after = []; /* what the suggestion says of what is missing */
        let notes = [];
        for (const line of (text || '').split('# Made by:')[0].split('\n').map((l) => l.trim())) {
            if (line.startsWith('#')) notes.push(line.replace(/^#\s*/, ''));
            else if (line && !/^remodel-/.test(line)) {
                this.left.push({statement: line, notes: this.left.length ? notes : []}); /* the first are of the file */
                notes = [];
            } else if (line) notes = [];
        }
        this.after = notes;
    }

    /* A line of the suggestion, in the unit that the page counts in. */
    line(statement) { return this.app.unit === 1 ? statement : Script.scaled(statement, this.app.unit); }

    show() {
        const box = document.createElement('details'), list = document.createElement('ol'),
            title = document.createElement('summary');
        if (this.app.file !== this.file) return;
        this.element.replaceChildren();
        if (!this.left.length && !this.after.length) return;
        title.textContent = this.left.length ? `${this.left.length} suggested statements` : 'What the suggestion says of the rest';
        box.open = this.opened ?? (!this.left.length || !Script.statements(this.app.texts.get(this.file)).length);
        box.ontoggle = () => { this.opened = box.open; };
        const all = document.createElement('button');
        all.type = 'button';
        all.textContent = 'Accept all';
        all.onclick = () => {
            const lines = this.left.splice(0).map((s) => this.line(s.statement));
            this.app.write(lines.join('\n'));
        };
        box.append(title, ...(this.left.length ? [all] : []), list);
        const say = (text) => {
            const row = document.createElement('li');
            row.className = 'note';
            row.textContent = text;
            list.append(row);
        };
        const offer = (statement, drop) => {
            const row = document.createElement('li'), text = document.createElement('input'),
                yes = document.createElement('button'), no = document.createElement('button');
            text.value = this.line(statement);
            text.setAttribute('aria-label', 'suggested statement');
            yes.type = no.type = 'button';
            yes.textContent = 'Accept';
            no.textContent = 'Drop';
            yes.onclick = () => {
                drop();
                this.app.write(text.value.trim());
            };
            no.onclick = () => {
                drop();
                this.show();
            };
            row.append(text, yes, no);
            list.append(row);
        };
        this.left.forEach(({statement, notes}, i) => {
            notes.forEach(say);
            offer(statement, () => this.left.splice(i, 1));
        });
        /* what is doubtful stands there as a comment; it can be accepted too */
        const isStatement = (note) => /^(wall|door|passage|window|room|box|join|extend|disk|area|lit|unlit|line) \S+ .*\d/.test(note);
        this.after.forEach((note, i) => {
            if (!isStatement(note)) return say(note);
            const from = i && !isStatement(this.after[i - 1]) ? i - 1 : i; /* what is said of it goes with it */
            return offer(note, () => this.after.splice(from, i + 1 - from));
        });
        this.element.append(box);
    }
}
