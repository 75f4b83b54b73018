// tools.js - what buttons do, and the words of the page.
'use strict';

const toggleMeasure = () => {
    S.measure = S.measure ? null : {points: [], text: ''};
    W.say(
        S.measure ?
            'Choose a point: its surface is measured. Choose a second one: the distance. With the keyboard, turn until the cross is on it and press Enter.' :
            '');
};
const toggleAbove = () => {
    const model = scene.models[S.edit], size = S.size;
    S.move = S.tour = null;
    S.above = S.above ? null : {
        heading: Math.PI / 2,
        up: -1.0,
        away: 1.35 * size,
        target: [0, 1, 2].map((k) => 0.5 * (model.low[k] + model.high[k]))
    };
    W.say(S.above ? 'From above, without ceilings. Drag to turn, click a circle to go there.' : '');
};
const toggleTour = () => {
    const frames = scene.models[S.edit].tour;
    S.move = null;
    if (S.above) toggleAbove();
    S.tour = S.tour ? null : {time: 0};
    W.say(
        S.tour ? `The tour takes ${Math.round(frames[frames.length - 1][0])} seconds. Press T to stop.` :
                 'The tour stops here.');
};
const setEdit = (m) => {
    S.edit = m;
    if (!scene.models[m].edit) S.compare = S.light = false;
    if (!scene.models[m].light) S.light = false;
    S.tour = null;
    modelOf(m);
    plan.show(scene.models[m]);
    W.say(
        scene.models[m].edit ? `${title(m)}${scene.models[m].about ? `: ${scene.models[m].about}` : ''}` :
                                                                     'The rooms as they are.');
};
const title = (m) => (scene.models[m].edit ? scene.models[m].edit.replace(/[-_]/g, ' ') : 'as they are');
const cycle = () => {  // keep the eye where it is possible
    setEdit((S.edit + 1) % scene.models.length);
};
const tools = [
    [
        'compare', 'Compare', 'B', 'compare before and after',
        () => {
            S.compare = !S.compare;
            W.say(S.compare ? 'Left: before. Right: after. Drag the bar, or move it with [ and ].' : '');
        },
        () => S.compare, () => S.edit > 0
    ],
    [
        'light', 'New light', 'L', 'show the light that the change makes',
        () => {
            S.light = !S.light;
            W.say(S.light ? 'In the light that the change makes.' : 'In the light of the photographs.');
        },
        () => S.light, () => scene.models[S.edit].light
    ],
    [
        'tour', 'Tour', 'T', 'walk along the route of the film', toggleTour, () => !!S.tour,
        () => scene.models[S.edit].tour.length > 1
    ],
    ['above', 'From above', 'O', 'look into the rooms from above', toggleAbove, () => !!S.above],
    ['measure', 'Measure', 'M', 'measure distances and surfaces', toggleMeasure, () => !!S.measure],
    [
        'made', 'Origin', 'C', 'show what each place comes from, as colours',
        () => {
            S.made = !S.made;
        },
        () => S.made
    ],
    ['next', 'Next photo', 'N', 'go to the next photograph', () => next(1), null],
    ['help', 'Help', 'H', 'show all keys', () => $('help').showModal(), null],
];
const run = (tool) => {
    if (tool[6] && !tool[6]())
        return W.say(
            tool[0] === 'light' ? 'For this change the new light was not computed: run make relight, then make walk.' :
                tool[0] === 'tour' ? 'This scene has no tour: run make tour-path, then make walk.' :
                                     'Choose a change first.');
    tool[4]();
    S.moved = performance.now();
    buttons();
    return touch();
};
const buttons = () => {
    for (const t of tools) {
        const b = $(`tool-${t[0]}`);
        if (t[5]) b.setAttribute('aria-pressed', !!t[5]());
        b.setAttribute('aria-disabled', !!(t[6] && !t[6]()));
    }
    const compare = S.compare && S.edit > 0;
    $('edit').value = S.edit;
    $('divider').hidden = $('before').hidden = $('after').hidden = !compare;
    $('divider').style.left = `${100 * S.split}%`;
    $('divider').setAttribute('aria-valuenow', Math.round(100 * S.split));
    $('after').textContent = compare ? title(S.edit) : '';
    $('legend').hidden = !S.made;
    canvas.classList.toggle('measuring', !!S.measure);
};
const split = (x) => {
    S.split = Math.min(0.98, Math.max(0.02, x));
    buttons();
    touch();
};

const build = () => {
    $('tools').innerHTML = tools
                               .map(
                                   (t) => `<button id="tool-${t[0]}" title="${t[3]}"${
                                       t[5] ? ' aria-pressed="false"' : ''}>${t[1]}<kbd>${t[2]}</kbd></button>`)
                               .join('');
    tools.forEach((t) => $(`tool-${t[0]}`).addEventListener('click', () => {
        run(t);
        if (t[0] !== 'help') canvas.focus({preventScroll: true});
    }));
    $('more').addEventListener(
        'click', () => $('more').setAttribute('aria-expanded', $('tools').classList.toggle('open')));
    $('edit').innerHTML = scene.models.map((m, i) => `<option value="${i}">${W.escape(title(i))}</option>`).join('');
    $('edit').addEventListener('change', () => {
        setEdit(+$('edit').value);
        buttons();
        touch();
        canvas.focus({preventScroll: true});
    });
    $('choice').hidden = scene.models.length < 2;
    const words = {
        photo: 'the photograph itself',
        original: 'original: from the photograph of this viewpoint',
        warped: 'warped: from another photograph',
        guessed: 'synthesised: no photograph shows it',
        colour: 'a colour for a new surface',
        outdoors: 'what lies outdoors',
        clutter: 'furniture, by its depth in the photographs'
    };
    const box = (rgb, text, word) =>
        `<div><i class="hatch ${word}" style="background-color:rgb(${rgb.join()})"></i>${text}</div>`;
    $('legend').innerHTML = '<b>Where the picture comes from</b>' +
        scene.made.filter((k) => words[k.word]).map((k) => box(k.rgb, words[k.word], k.word)).join('') +
        box([255, 205, 40], 'over it: another light', 'relit');
    $('help').innerHTML = `<h2>Walk through ${W.escape(scene.name)}</h2><table>
<tr><td>drag, <kbd>←</kbd> <kbd>→</kbd>, <kbd>PgUp</kbd> <kbd>PgDn</kbd></td><td>look around</td></tr>
<tr><td>click, <kbd>↑</kbd> <kbd>↓</kbd>, <kbd>A</kbd> <kbd>D</kbd></td><td>go there; walk; step aside. On a touch screen: one finger turns, a touch goes there, two fingers moved together walk, spread they zoom.</td></tr>
<tr><td>circles on the floor, blue dots on the plan, <kbd>N</kbd> <kbd>P</kbd></td><td>go where a photograph was taken: there you see it as it is</td></tr>
<tr><td>wheel, <kbd>+</kbd> <kbd>-</kbd>, <kbd>R</kbd></td><td>nearer, wider, back to normal</td></tr>
<tr><td><kbd>0</kbd> to <kbd>9</kbd>, <kbd>X</kbd></td><td>the rooms as they are, or after a change; the next change</td></tr>
${tools.map((t) => `<tr><td><kbd>${t[2]}</kbd></td><td>${t[3]}</td></tr>`).join('')}
<tr><td><kbd>Enter</kbd></td><td>go to, or measure, what is in the middle of the picture</td></tr>
<tr><td><kbd>Esc</kbd></td><td>back to walking</td></tr>
<tr><td><kbd>I</kbd></td><td>what drawing takes</td></tr></table>
<form method="dialog"><button>Close</button></form>`;
    listen();
};
