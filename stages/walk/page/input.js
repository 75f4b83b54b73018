// input.js - keys, mouse and fingers.
'use strict';

const held = {
    ArrowUp: 'forward',
    ArrowDown: 'back',
    ArrowLeft: 'left',
    ArrowRight: 'right',
    w: 'forward',
    s: 'back',
    a: 'sideLeft',
    d: 'sideRight',
    PageUp: 'up',
    PageDown: 'down',
    q: 'left',
    e: 'right'
};
const keyDown = (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || $('help').open || e.target.tagName === 'SELECT') return;
    const key = e.key.length === 1 ? e.key.toLowerCase() : e.key;
    if (e.target === $('divider') && (key === 'ArrowLeft' || key === 'ArrowRight')) {
        e.preventDefault();
        return split(S.split + (key === 'ArrowLeft' ? -0.03 : 0.03));
    }
    if (held[key]) {
        e.preventDefault();
        stay();
        S.keys.add(held[key]);
        if (e.shiftKey && (key === 'ArrowLeft' || key === 'ArrowRight')) {
            S.keys.delete(held[key]);
            S.keys.add(key === 'ArrowLeft' ? 'sideLeft' : 'sideRight');
        }
        return undefined;
    }
    const tool = tools.find((t) => t[2].toLowerCase() === key);
    if (tool) return run(tool);
    if (key === 'p') return next(-1);
    if (key === 'x') {
        cycle();
        buttons();
        return touch();
    }
    if (key === '[' || key === ']') return split(S.split + (key === '[' ? -0.03 : 0.03));
    if (key === '+' || key === '=' || key === '-') return zoom(key === '-' ? 1.1 : 1 / 1.1);
    if (key === 'i') {
        S.details = !S.details;
        W.say('');
        return touch();
    }
    if (key === 'r') {
        S.eye.up = 0;
        S.field = FIELD;
        S.moved = performance.now();
        return touch();
    }
    if (/^[0-9]$/.test(key) && +key < scene.models.length) {
        setEdit(+key);
        buttons();
        return touch();
    }
    if ((key === 'Enter' || key === ' ') && e.target === canvas) {
        e.preventDefault();
        return pressed(canvas.clientWidth / 2, canvas.clientHeight / 2);
    }
    if (key === 'Escape') {
        Object.assign(S, {measure: null, tour: null, move: null, compare: false, made: false});
        if (S.above) toggleAbove();
        W.say('');
        buttons();
        touch();
    }
    return undefined;
};
const keyUp = (e) => {
    const key = held[e.key.length === 1 ? e.key.toLowerCase() : e.key];
    S.keys.delete(key);
    if (key === 'left') S.keys.delete('sideLeft');
    if (key === 'right') S.keys.delete('sideRight');
};
const zoom = (by) => {
    if (S.above)
        S.above.away = Math.min(3 * S.size, Math.max(0.4 * S.size, S.above.away * by));
    else
        S.field = Math.min(1.9, Math.max(0.4, S.field * by));
    S.moved = performance.now();
    touch();
};

// Mouse and fingers. One finger turns, a short touch goes there; two fingers moved together walk, spread they zoom.
const fingers = new Map();
const WALK = 0.001;  // of the rooms' size for each pixel that both fingers move
const stay = () => {
    S.move = null;
    if (S.tour) {
        S.tour = null;
        buttons();
    }
};
const walkBy = (forward, aside) => {
    const c = Math.cos(S.eye.heading), s = Math.sin(S.eye.heading),
          to = W.add(S.eye.centre, [forward * c + aside * s, forward * s - aside * c, 0]), there = reach(S.eye.centre, to);
    if (inRooms(there)) S.eye.centre = there;
};
const turnBy = (heading, up) => {
    const at = S.above || S.eye, most = S.above ? -0.25 : 1.4, least = S.above ? -1.55 : -1.4;
    at.heading += heading;
    at.up = Math.min(most, Math.max(least, at.up + up));
};
const down = (e) => {
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({preventScroll: true});
    fingers.set(e.pointerId, {x: e.clientX, y: e.clientY, still: true});
    if (fingers.size > 1) fingers.forEach((f) => (f.still = false));
};
const moveFinger = (e) => {
    const f = fingers.get(e.pointerId), other = [...fingers.values()].find((o) => o !== f);
    if (!f) return;
    const dx = e.clientX - f.x, dy = e.clientY - f.y;
    if (f.still && Math.hypot(dx, dy) < 5) return;
    const was = other && Math.hypot(f.x - other.x, f.y - other.y);
    Object.assign(f, {x: e.clientX, y: e.clientY, still: false});
    canvas.classList.add('turning');
    stay();
    if (other) {
        const is = Math.hypot(f.x - other.x, f.y - other.y);
        if (is > 1 && was > 1) zoom(was / is);
        if (S.above)
            turnBy(0.003 * dx, -0.003 * dy);
        else  // half of it: the other finger brings the other half
            walkBy(-0.5 * WALK * S.size * dy, -0.5 * WALK * S.size * dx);
    } else {
        const turn = S.above ? 0.006 : S.field / Math.max(canvas.clientWidth, canvas.clientHeight);
        turnBy(turn * dx, S.above ? -turn * dy : turn * dy);
    }
    S.moved = performance.now();
    touch();
};
const up = (e) => {
    const f = fingers.get(e.pointerId);
    fingers.delete(e.pointerId);
    if (!fingers.size) canvas.classList.remove('turning');
    if (f && f.still && e.type === 'pointerup') {
        const box = canvas.getBoundingClientRect();
        pressed(e.clientX - box.left, e.clientY - box.top);
    }
};

const listen = () => {
    canvas.addEventListener('pointerdown', down);
    canvas.addEventListener('pointermove', moveFinger);
    canvas.addEventListener('pointerup', up);
    canvas.addEventListener('pointercancel', up);
    canvas.addEventListener('wheel', (e) => {
        e.preventDefault();
        zoom(e.deltaY > 0 ? 1.08 : 1 / 1.08);
    }, {passive: false});
    document.addEventListener('keydown', keyDown);
    document.addEventListener('keyup', keyUp);
    window.addEventListener('blur', () => S.keys.clear());
    window.addEventListener('resize', touch);
    const drag = (e) => {
        if (e.buttons) split(e.clientX / window.innerWidth);
    };
    $('divider').addEventListener('pointerdown', (e) => $('divider').setPointerCapture(e.pointerId));
    $('divider').addEventListener('pointermove', drag);
};
