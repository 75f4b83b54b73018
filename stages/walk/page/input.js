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
        S.move = null;
        if (S.tour) {
            S.tour = null;
            buttons();
        }
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

// Mouse and fingers: one turns, two walk and zoom, a short touch goes there.
const fingers = new Map();
const down = (e) => {
    canvas.setPointerCapture(e.pointerId);
    canvas.focus({preventScroll: true});
    fingers.set(e.pointerId, {x: e.clientX, y: e.clientY, still: true, time: performance.now()});
};
const moveFinger = (e) => {
    const f = fingers.get(e.pointerId);
    if (!f) return;
    const dx = e.clientX - f.x, dy = e.clientY - f.y;
    if (f.still && Math.hypot(dx, dy) < 5) return;
    const others = [...fingers.values()].filter((o) => o !== f);
    f.still = false;
    canvas.classList.add('turning');
    S.move = null;
    if (S.tour) {
        S.tour = null;
        buttons();
    }
    if (others.length) {
        others[0].still = false;
        const was = Math.hypot(f.x - others[0].x, f.y - others[0].y), is = Math.hypot(e.clientX - others[0].x, e.clientY - others[0].y);
        if (S.above)
            zoom(was / is);
        else {
            const c = Math.cos(S.eye.heading), s = Math.sin(S.eye.heading), far = (0.006 * (is - was) * S.size) / 6;
            const there = reach(S.eye.centre, W.add(S.eye.centre, [c, s, 0], far));
            if (inRooms(there)) S.eye.centre = there;
        }
    } else {
        const turn = S.above ? 0.006 : S.field / Math.max(canvas.clientWidth, canvas.clientHeight),
              at = S.above || S.eye;
        at.heading += turn * dx;
        at.up = S.above ? Math.min(-0.25, Math.max(-1.55, at.up - turn * dy)) :
                          Math.min(1.4, Math.max(-1.4, at.up + turn * dy));
    }
    Object.assign(f, {x: e.clientX, y: e.clientY});
    S.moved = performance.now();
    touch();
};
const up = (e) => {
    const f = fingers.get(e.pointerId);
    fingers.delete(e.pointerId);
    canvas.classList.remove('turning');
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
