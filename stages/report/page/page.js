// page.js - sliders between a photograph and what a change makes of it.
//
// Without this script each picture shows both halves, and the list below it links to all pictures. The script turns
// that list into a choice of the change and of its light, and lets the line move by pointer and by keys.
'use strict';

const make = (name, attributes, ...inside) => {
    const e = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
    e.append(...inside);
    return e;
};

class Room {
    constructor(figure, number) {
        const find = (s) => figure.querySelector(s);
        Object.assign(this, {figure, number, frame: find('.ba'), after: find('.after'), label: find('.right'),
            line: find('input[type=range]'), says: find('.says'), light: 'new', real: false});
        this.looks = [...figure.querySelectorAll('.looks > li')].map((li) => {
            const link = (name) => li.querySelector(`a.${name}`), text = (name) => li.querySelector(`.${name}`);
            return {change: li.dataset.change, name: li.dataset.name, made: li.dataset.made, ratio: li.dataset.ratio,
                day: link('day').getAttribute('href'), says: text('day-says').textContent,
                lit: link('new') && link('new').getAttribute('href'),
                litSays: link('new') && text('new-says').textContent};
        });
        this.look = this.looks[0];
        this.addControls();
        this.line.addEventListener('input', () => this.moveLine());
        this.moveLine();
        this.show();
    }

    addControls() {
        const id = (name) => `${name}${this.number}`, changed = (e, act) => e.addEventListener('change', act);
        const row = make('div', {class: 'choose'});
        this.select = make('select', {id: id('change')},
            ...this.looks.map((l) => make('option', {value: l.change}, l.name)));
        changed(this.select, () => this.choose(this.select.value));
        row.append(make('label', {}, 'Change ', this.select));
        this.lights = {};
        const lights = make('fieldset', {class: 'light'}, make('legend', {}, 'Light'));
        for (const [value, words] of [['day', 'old'], ['new', 'new']]) {
            const input = this.lights[value] = make('input', {type: 'radio', name: id('light'), value});
            changed(input, () => this.setLight(value));
            lights.append(make('label', {}, input, ` ${words}`));
        }
        this.box = make('input', {type: 'checkbox'});
        changed(this.box, () => { this.real = this.box.checked; this.show(); });
        if (this.looks.some((l) => l.lit)) row.append(lights);
        row.append(make('label', {class: 'real'}, this.box, ' show what is real'));
        this.frame.after(row);
        this.over = make('img', {class: 'over', alt: '', hidden: ''});
        this.after.after(this.over);
    }

    choose(change) {
        const look = this.looks.find((l) => l.change === change);
        if (!look) return false;
        this.look = look;
        this.show();
        return true;
    }

    setLight(light) {
        this.light = light;
        this.show();
    }

    // A change that was never lit has one light.
    show() {
        const look = this.look, lit = this.light === 'new' && look.lit, over = lit ? look.ratio : look.made;
        const light = look.lit ? (lit ? ', new light' : ', old light') : '';
        this.select.value = look.change;
        this.lights.new.disabled = !look.lit;
        this.lights[lit ? 'new' : 'day'].checked = true;
        if (this.after.getAttribute('src') !== (lit || look.day)) this.after.src = lit || look.day;
        this.after.alt = `${this.figure.dataset.photo} after the change: ${look.name}${light}`;
        this.label.textContent = look.name + light;
        this.says.textContent = lit ? look.litSays : look.says;
        this.box.disabled = !over;
        this.over.hidden = !(this.real && over);
        if (this.real && over) this.over.src = over;
        this.over.alt = lit ? 'how the light changes, in grey' : 'what each part comes from, in colours';
    }

    moveLine() {
        this.frame.style.setProperty('--p', `${this.line.value}%`);
        this.line.setAttribute('aria-valuetext', `${Math.round(this.line.value)} % of the width is before the change`);
    }
}

// One choice for all pictures; those that do not show the change are hidden.
const addChoiceForAll = (rooms, section) => {
    const changes = new Map(rooms.flatMap((r) => r.looks.map((l) => [l.change, l.name])));
    const about = new Map([...document.querySelectorAll('.about > div')].map(
        (e) => [e.dataset.change, e.querySelector('dd').textContent]));
    const count = make('p', {role: 'status'}), lit = rooms.some((r) => r.looks.some((l) => l.lit));
    const select = make('select', {id: 'change-all'}, make('option', {value: ''}, 'each picture its own'),
        ...[...changes].sort((a, b) => a[1].localeCompare(b[1])).map(([c, n]) => make('option', {value: c}, n)));
    select.addEventListener('change', () => {
        let shown = 0;
        for (const room of rooms) {
            room.figure.hidden = select.value !== '' && !room.choose(select.value);
            if (!select.value) room.choose(room.looks[0].change);
            shown += !room.figure.hidden;
        }
        count.textContent = !select.value ? '' :
            `${about.get(select.value) || ''} ${shown} of these ${rooms.length} photographs show it.`;
    });
    const row = make('div', {class: 'choose all'});
    if (changes.size > 1) row.append(make('label', {}, 'Show in all pictures: ', select));
    if (lit) {
        const lights = make('fieldset', {class: 'light'}, make('legend', {}, 'Light'));
        for (const [value, words] of [['day', 'old'], ['new', 'new']]) {
            const input = make('input', {type: 'radio', name: 'light-all', value});
            input.checked = value === 'new';
            input.addEventListener('change', () => rooms.forEach((r) => r.setLight(value)));
            lights.append(make('label', {}, input, ` ${words}`));
        }
        row.append(lights);
    }
    section.before(row, count);
};

const rooms = [...document.querySelectorAll('figure.room')].map((figure, i) => new Room(figure, i));
if (rooms.length) {
    document.documentElement.classList.add('js');
    if (rooms.length > 1) addChoiceForAll(rooms, document.querySelector('.rooms'));
}
