/* gestures.js - what each tool makes of the pixels that somebody sets: one statement.
 *
 * A tool has a form of gesture: `rectangle` and `line` take two pixels, `corners` as many as are set before Enter,
 * `pixel` one, `drag` two with the item under the first. make(app, pixels) returns the statement, or {error: why}. The
 * model itself says what a pixel shows (app.pick), and whether the statement holds. */
'use strict';

const TOOLS = [];

/* id, key, label, files (of which names the tool writes), form, hint, make */
function addTool(id, key, label, files, form, hint, make) { TOOLS.push({id, key, label, files, form, hint, make}); }

const SCRIPT_FILES = /^(model|edits\/.+)\.txt$/, EDIT_FILES = /^edits\//, 
    LENGTH_FILES = /^(model|edits\/.+|objects|lights|tour)\.txt$/;

/* "in PHOTO X0 Y0 X1 Y1", the upper left corner first. */
function inRectangle(app, [a, b]) {
    return `in ${app.photoId()} ${app.px(Math.min(a[0], b[0]))} ${app.px(Math.min(a[1], b[1]))} ` +
        `${app.px(Math.max(a[0], b[0]))} ${app.px(Math.max(a[1], b[1]))}`;
}

function inPixels(app, points) { return `in ${app.photoId()} ` +
    points.map((p) => `${app.px(p[0])} ${app.px(p[1])}`).join(' '); }

/* What most of a rectangle shows: the item of a kind, such as the wall "south" of the face "wall/south/in". */
function itemIn(app, [a, b], kinds) {
    const count = new Map();
    for (let i = 1; i < 6; i++)
        for (let k = 1; k < 6; k++) {
            const hit = app.pick(a[0] + (b[0] - a[0]) * i / 6, a[1] + (b[1] - a[1]) * k / 6);
            const [kind, name] = hit ? hit.face.split('/') : [];
            if (!kinds.includes(kind)) continue;
            count.set(name, (count.get(name) || 0) + 1);
        }
    const best = [...count].sort((x, y) => y[1] - x[1])[0];
    return best ? best[0] : null;
}

/* An opening in the wall that the rectangle shows; an opening that is there already leads to its wall too. */
function wallIn(app, points) {
    const wall = itemIn(app, points, ['wall']);
    if (wall) return wall;
    const opening = itemIn(app, points, ['door', 'passage', 'window', 'glass']);
    const found = opening && app.model.openings.find((o) => o.name === opening);
    return found ? found.wall : null;
}

/* Pixels of an opening, where they are a little beyond the edge of its wall moved onto it: clicks are not exact, and an
 * opening that reaches beyond is refused. */
function insideWall(app, name, points) {
    const wall = app.model.walls.find((w) => w.name === name), little = 0.03 * app.live.height(),
        inside = 0.002 * app.live.height();
    return points.map((pixel) => {
        const ray = wall && app.ray(...pixel), n = wall && [...wall.normal, 0];
        const at = ray && meetPlane(ray, n, [wall.normal[0] * wall.at, wall.normal[1] * wall.at, 0]);
        if (!at) return pixel;
        const d = wall.direction, s = wall.sign * (at[0] * d[0] + at[1] * d[1]) - wall.origin;
        const move = (v, low, high) => v > high - inside && v < high + little ? high - inside - v : v < low + inside &&
            v > low - little ? low + inside - v : 0;
        const by = wall.sign * move(s, ...wall.span), up = at[2] > wall.top - inside && at[2] < wall.top + little
            ? wall.top - inside - at[2] : 0;
        const to = by || up ? app.live.project(app.photo, [at[0] + by * d[0], at[1] + by * d[1], at[2] + up]) : null;
        return to ? [...to] : pixel;
    });
}

const NO_WALL = {error: 'No wall of the model is here yet: draw the wall first, and a room, then its openings.'};

addTool('select', 'v', 'Select', SCRIPT_FILES, 'pixel',
    'Click a part of the model; buttons below change it. Shift adds walls, for Join and Room.',
    (app, [p], more) => app.select(app.pick(...p), more));
addTool('wall', 'w', 'Wall', SCRIPT_FILES, 'rectangle',
    'Drag a rectangle on a wall, where it has texture and nothing stands before it.',
    (app, points) => `wall ${app.newName('wall')} ${inRectangle(app, points)}`);
addTool('foot', 'f', 'Wall by its foot', SCRIPT_FILES, 'line',
    'Set two pixels of the line where the wall meets the floor: a long line, near the camera.',
    (app, points) => `wall ${app.newName('wall')} foot ${inPixels(app, points)}`);
addTool('top', 't', 'Wall by its top', SCRIPT_FILES, 'line',
    'Set two pixels of the line where the wall meets the ceiling.',
    (app, points) => `wall ${app.newName('wall')} top ${inPixels(app, points)}`);
addTool('corners', 'c', 'Walls by corners', SCRIPT_FILES, 'corners',
    'Set the corners of the floor, in order round the room, in any photos; Enter twice ends. End at the first corner to close the chain.',
    (app, points, photos) => {
        const at = points.map((p, i) => `corner in ${photos[i]} ${app.px(p[0])} ${app.px(p[1])}`);
        const last = points.length - 1, near = Math.hypot(points[last][0] - points[0][0],
            points[last][1] - points[0][1]) * app.view.scale;
        const closed = points.length > 3 && photos[last] === photos[0] && near < 12;
        if (closed) at.pop();
        const names = [], count = closed ? at.length : at.length - 1;
        for (let i = 0; i < count; i++) names.push(app.newName('wall', names.map((n) => `wall ${n}`).join('\n')));
        return count ? `walls ${names.join(' ')} ${at.join(' ')}${closed ? ' closed' : ''}`
            : {error: 'A chain needs two corners or more.'};
    });
for (const [kind, key] of [['door', 'd'], ['passage', 'p'], ['window', 'n']])
    addTool(kind, key, kind[0].toUpperCase() + kind.slice(1), SCRIPT_FILES, 'rectangle',
        kind === 'window' ? 'Drag a rectangle round the window, on its wall.'
            : `Drag a rectangle round the ${kind}; it starts at the floor.`,
        (app, points) => {
            const wall = wallIn(app, points);
            return wall ? `${kind} ${app.newName(kind)} on ${wall} ${inRectangle(app, insideWall(app, wall, points))}`
                : NO_WALL;
        });
addTool('box', 'b', 'Box', SCRIPT_FILES, 'rectangle',
    'Drag from one corner of its footprint on the floor to the opposite one; then give its top.',
    (app, points) => `box ${app.newName('box')} ${inRectangle(app, points)}`);
addTool('slot', 'l', 'Skylight', SCRIPT_FILES, 'rectangle',
    'Drag a rectangle on a ceiling for a skylight, on a floor for a hatch.', (app, points) => {
    const ceiling = itemIn(app, points, ['ceiling']), floor = ceiling ? null : itemIn(app, points, ['floor']);
    if (ceiling) return `skylight ${app.newName('skylight')} on ${ceiling} ${inRectangle(app, points)}`;
    return floor ? `hatch ${app.newName('hatch')} on ${floor} ${inRectangle(app, points)}`
        : {error: 'No ceiling or floor of the model is here yet: make the room first.'};
});
addTool('adjust', 'a', 'Adjust', SCRIPT_FILES, 'rectangle',
    'Select a wall, an opening or a box, then drag its place again, in any photo.', (app, points) => {
    const item = app.selected[0];
    return item ? `adjust ${item.name} ${inRectangle(app, points)}` : {error: 'Select what to adjust first.'};
});
addTool('move', 'm', 'Move', SCRIPT_FILES, 'drag',
    'Drag a wall along its normal, an opening on its wall, a box on the floor.', (app, points) =>
        moveItem(app, points));
addTool('resize', 'r', 'Resize', SCRIPT_FILES, 'drag', 'Drag a side of an opening.', (app, points) =>
    resizeOpening(app, points));
addTool('paint', 'k', 'Paint', EDIT_FILES, 'pixel', 'Choose a colour below, then click a face.', (app, [p]) => {
    const hit = app.pick(...p);
    return hit ? `colour ${hit.face} ${app.colour()}` : {error: 'No face of the model is here.'};
});
for (const kind of ['clear', 'keep'])
    addTool(kind, kind === 'clear' ? 'e' : 'y', kind === 'clear' ? 'Clear' : 'Keep', EDIT_FILES, 'rectangle',
        `Drag from one corner of a footprint on the floor to the opposite one: ${kind === 'clear' ? 'what stands there goes' : 'what stands there stays'}.`,
        (app, points) => `${kind} ${inRectangle(app, points)}`);

/* Where a ray comes nearest to a line through a place. */
function nearestOnLine(ray, at, along) {
    const [o, d] = [ray.slice(0, 3), ray.slice(3)], dot = (x, y) => x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    const w = o.map((v, k) => v - at[k]), b = dot(d, along), det = dot(d, d) * dot(along, along) - b * b;
    return det < 1e-9 ? 0 : (dot(d, d) * dot(along, w) - b * dot(d, w)) / det;
}

/* Where a ray meets the plane n p = c; null: nowhere. */
function meetPlane(ray, n, at) {
    const o = [...ray.slice(0, 3)], d = [...ray.slice(3)], dot = (x, y) => x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    const down = dot(n, d);
    if (Math.abs(down) < 1e-6) return null;
    const t = dot(n, at.map((v, k) => v - o[k])) / down;
    return t > 0 ? o.map((v, k) => v + t * d[k]) : null;
}

function length(value) { return Script.number(value, 3); }

/* The item that a face is of: {kind, name, of} with `of` as the model lists it. */
function itemOf(app, face) {
    if (!face) return null;
    let [kind, name] = face.split('/');
    const lists = {wall: 'walls', door: 'openings', passage: 'openings', window: 'openings', glass: 'openings',
        box: 'boxes',
        floor: 'rooms', ceiling: 'rooms', skylight: 'slots', hatch: 'slots'};
    let of = (app.model[lists[kind]] || []).find((i) => i.name === name);
    if (!of && kind === 'glass') of = app.model.slots.find((i) => i.name === name);
    if (kind === 'glass' && of) kind = of.kind;
    return of ? {kind, name, of, face} : null;
}

/* How far a drag leads, as the statement `move` wants it. */
function moveItem(app, [a, b]) {
    const hit = app.pick(...a), item = itemOf(app, hit && hit.face), ray = app.ray(...b);
    if (!item || !ray) return {error: 'Begin to drag on a wall, an opening or a box of the model.'};
    const at = [...hit.at];
    if (item.kind === 'wall') {
        const n = item.of.normal;
        return `move ${item.name} by ${length(-nearestOnLine(ray, at, [n[0], n[1], 0]))}`;
    }
    if (item.of.wall) {
        const wall = app.model.walls.find((w) => w.name === item.of.wall), to = meetPlane(ray, [...wall.normal, 0], at);
        if (!to) return {error: 'The end of the drag is not on the plane of the wall.'};
        const along = wall.sign * ((to[0] - at[0]) * wall.direction[0] + (to[1] - at[1]) * wall.direction[1]),
            up = to[2] - at[2];
        const rises = Math.abs(up) > 0.01 * app.live.height() && item.kind === 'window';
        return `move ${item.name} by ${length(along)}${rises ? ' ' + length(up) : ''}`;
    }
    const to = meetPlane(ray, [0, 0, 1], at);
    if (!to || item.kind === 'floor' ||
        item.kind === 'ceiling') return {error: 'Begin to drag on a wall, an opening or a box of the model.'};
    return `move ${item.name} by ${length(to[0] - at[0])} ${length(to[1] - at[1])}`;
}

/* The side of an opening that is nearest to where the drag begins goes with it. */
function resizeOpening(app, [a, b]) {
    const rayA = app.ray(...a), rayB = app.ray(...b);
    let best = null;
    for (const o of app.model.openings) {
        const wall = app.model.walls.find((w) => w.name === o.wall);
        if (!wall || !rayA || !rayB) continue;
        const n = [...wall.normal, 0], on = [wall.normal[0] * wall.at, wall.normal[1] * wall.at, 0];
        const from = meetPlane(rayA, n, on), to = meetPlane(rayB, n, on);
        if (!from || !to) continue;
        const d = wall.direction, s = (p) => wall.sign * (p[0] * d[0] + p[1] * d[1]) - wall.origin;
        const [s0, s1] = [s(from), s(to)], lowIsLeft = wall.sign > 0;
        const sides = [[lowIsLeft ? 'left' : 'right', Math.abs(s0 - o.s[0]), o.s[0] - s1],
            [lowIsLeft ? 'right' : 'left', Math.abs(s0 - o.s[1]), s1 - o.s[1]],
            ['bottom', Math.abs(from[2] - o.z[0]), o.z[0] - to[2]],
                ['top', Math.abs(from[2] - o.z[1]), to[2] - o.z[1]]];
        const outside = Math.max(0, o.s[0] - s0, s0 - o.s[1]) + Math.max(0, o.z[0] - from[2], from[2] - o.z[1]);
        for (const [side, off, by] of sides)
            if (!best || off + outside < best.off) best = {off: off + outside, name: o.name, side, by};
    }
    return best && best.off < 0.25 * app.live.height() ? `resize ${best.name} ${best.side} ${length(best.by)}`
        : {error: 'Begin to drag at a side of an opening.'};
}

/* --------------------------------------------------------------------------------------------------------- marks */

const inFile = (name) => ({test: (file) => file === name});
addTool('mark', '', 'Mark', {test: (file) => file === 'scale.txt' || file === 'axes_fix.txt'}, 'pixel',
    'Click a place on the floor that a length begins or ends at; mark it in a second photo if it is not on the floor.',
    (app, [p]) => `mark ${app.markName('mark')} ${app.photoId()} ${app.px(p[0])} ${app.px(p[1])}${app.onFloor() ? ' floor' : ''}`);
addTool('corner', '', 'Corner', inFile('axes_fix.txt'), 'pixel',
    'Click where two walls meet the floor; in a second photo give the same name.',
    (app, [p]) => `corner ${app.markName('corner')} ${app.photoId()} ${app.px(p[0])} ${app.px(p[1])}`);
addTool('edge', '', 'Edge', inFile('axes_fix.txt'), 'pixel',
    'Click a point on a line that ends in the corner with the name below.',
    (app, [p]) => `edge ${app.markName('corner')} ${app.photoId()} ${app.px(p[0])} ${app.px(p[1])}`);
addTool('disk', '', 'Round lamp', inFile('lights.txt'), 'line', 'Set the middle of the lamp, then a point of its rim. If it hangs, add "off" and its distance from the ceiling to its line.',
    (app, [a, b]) => `disk ${app.newLamp()} in ${app.photoId()} ${app.px(a[0])} ${app.px(a[1])} rim ${app.px(b[0])} ${app.px(b[1])} beta fit`);
addTool('area', '', 'Square lamp', inFile('lights.txt'), 'corners', 'Set its four corners, in order. If it hangs, add "off" and its distance from the ceiling to its line.',
    (app, points) => points.length === 4 ? `area ${app.newLamp()} ${inPixels(app, points)}`
        : {error: 'A square lamp has four corners.'});
for (const [kind, words] of [['lit', 'that the lamp lights'], ['unlit', 'that the lamp does not light']])
    addTool(kind, '', kind[0].toUpperCase() + kind.slice(1), inFile('lights.txt'), 'rectangle',
        `Drag a rectangle ${words}, on one dull material; which lamp is below.`,
        (app, points) => app.lamp() ? `${kind} ${app.lamp()} ${inRectangle(app, points)}`
            : {error: 'Mark a lamp first: Round lamp or Square lamp.'});
addTool('cone', '', 'Cone line', inFile('lights.txt'), 'line',
    "Set a line across the edge of the lamp's cone, on one surface.",
    (app, points) => app.lamp() ? `line ${app.lamp()} ${inPixels(app, points)}`
        : {error: 'Mark a lamp first: Round lamp or Square lamp.'});
addTool('material', '', 'Region', inFile('materials.txt'), 'corners',
    'Set the corners of a region of one material; Enter twice ends.',
    (app, points) => points.length > 2 ? `material ${app.named() || app.newName('material')} ${inPixels(app, points)}`
        : {error: 'A region has three corners or more.'});
addTool('subject', '', 'Subject', inFile('subjects.txt'), 'rectangle',
    'Drag a rectangle round a subject of the films, the most important first.',
    (app, points) => `subject ${inRectangle(app, points).slice(3)}`);
for (const [kind, words] of [['hide', 'to ignore, such as somebody who walked through the picture'], ['show', 'that count after all']]) {
    addTool(kind, '', kind === 'hide' ? 'Hide' : 'Show again', inFile('masks.txt'), 'corners',
        `Set the corners round pixels ${words}; Enter twice ends. Save writes masks/PHOTO.png.`,
        (app, points) => points.length > 2 ? `${kind} ${inPixels(app, points)}`
            : {error: 'An outline has three corners or more.'});
    addTool(kind + '-box', '', kind === 'hide' ? 'Hide rectangle' : 'Show rectangle', inFile('masks.txt'), 'rectangle',
        `Drag a rectangle round pixels ${words}. Save writes masks/PHOTO.png.`,
        (app, [a, b]) => `${kind} ${inPixels(app, [a, [b[0], a[1]], b, [a[0], b[1]]])}`);
}

/* A mark of a reference image; why it cannot be one. */
function onReference(app, make) {
    if (app.photos[app.photo].isReference) return make();
    return {error: app.photos.some((p) => p.isReference) ? 'Choose a reference image first: they are below the photos.'
        : 'This scene has no reference images yet: make lri makes them (LRI=FOLDER); then make draw again.'};
}
addTool('lri-corner', '', 'Corner of an opening', inFile('lri.txt'), 'pixel',
    'Name the opening below and say which corner; click it in a reference image. The next corner follows by itself.',
    (app, [p]) => onReference(app, () => {
        const opening = (app.forms.opening || '').trim();
        if (!opening) return {error: 'Give the name of a door, passage or window of the model below.'};
        const statement = `corner ${app.photoId()} ${opening} ${app.forms.corner} ${app.px(p[0])} ${app.px(p[1])}${app.forms.outer ? ' outer' : ''}`;
        app.forms.nextCorner();
        return statement;
    }));
addTool('lri-in', '', 'Taken in this opening', inFile('lri.txt'), 'pixel',
    'Name the opening below; click the reference image that was taken in it, looking straight out.',
    (app) => onReference(app, () => (app.forms.opening || '').trim() ? `in ${app.photoId()} ${app.forms.opening.trim()} looking out`
        : {error: 'Give the name of a door, passage or window of the model below.'}));
addTool('horizon', '', 'Horizon', inFile('lri.txt'), 'line', 'Set two pixels of the horizon, far apart.',
    (app, points) => onReference(app, () => `horizon ${inPixels(app, points).slice(3)}`));
addTool('thing', '', 'Thing', inFile('things.txt'), 'pixel', 'Click a piece of furniture, away from its edges.',
    (app, [p]) => `thing ${app.newName('thing')} ${inPixels(app, [p])}`);
addTool('flat', '', 'Flat thing', inFile('things.txt'), 'corners',
    'Set the outline of a rug or a poster; Enter twice ends.',
    (app, points) => points.length > 2 ? `flat ${app.newName('flat')} ${inPixels(app, points)}`
        : {error: 'An outline has three corners or more.'});
