// move.js - walking: where one can go, ways there, the tour, and the loop of frames.
'use strict';

const floorAt = (p) => {
    const hit = W.hit(scene.models[S.edit], p, [0, 0, -1]);
    return hit ? hit.point[2] : 0;
};
const eyeHeight = () => {
    const heights = scene.places.map((p) => p.centre[2]).sort((a, b) => a - b);
    return heights[heights.length >> 1];
};
const near = () => 0.035 * S.size;
// As far as one can walk from a place to another one.
const reach = (from, to) => {
    const way = W.add(to, from, -1), length = W.length(way);
    if (!(length > 0)) return from;
    let free = length;
    const hit = W.hit(scene.models[S.edit], from, W.scale(way, 1 / length), length + near());
    if (hit) free = Math.max(0, Math.min(free, hit.t - near()));
    return W.add(from, way, free / length);
};
const inRooms = (p) => {
    const hit = W.hit(scene.models[S.edit], p, [0, 0, -1]);
    return !!hit && hit.face.n[2] > 0.5;
};
const shortest = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));
const goTo = (centre, heading, up, seconds) => {
    const from = {...S.eye, centre: [...S.eye.centre]}, away = W.length(W.add(centre, from.centre, -1));
    const turn = heading === undefined ? 0 : shortest(heading - from.heading);
    S.tour = null;
    S.move = {
        from,
        to: {centre, turn, up: up === undefined ? from.up : up},
        start: performance.now(),
        time: 1000 * (seconds || Math.min(2.5, 0.35 + (2.2 * away) / S.size + 0.25 * Math.abs(turn)))
    };
    buttons();
    touch();
};
// Into a viewpoint, looking as its photograph does unless one keeps looking where one did.
const enter = (i, keep) => {
    if (S.above) toggleAbove();
    const p = scene.places[i], axis = p.axis || (p.axis = placeAxis(p));
    if (keep)
        goTo(p.centre);
    else
        goTo(p.centre, Math.atan2(axis[1], axis[0]), 0);
    W.say(`Photograph ${p.photo}`);
};
const placeAxis = (p) => {
    let sum = [0, 0, 0];
    for (let i = p.first; i < p.first + p.count; i++) sum = W.add(sum, scene.views[i].turn.slice(6));
    return W.unit([sum[0], sum[1], 0]);
};
const nearest = () => {
    let best = 0;
    scene.places.forEach((p, i) => {
        if (W.length(W.add(p.centre, S.eye.centre, -1)) < W.length(W.add(scene.places[best].centre, S.eye.centre, -1)))
            best = i;
    });
    return best;
};
const next = (by) => {
    const n = scene.places.length, here = nearest(),
          in_ = W.length(W.add(scene.places[here].centre, S.eye.centre, -1)) < 0.01 * S.size;
    enter((here + (in_ ? by : 0) + n) % n);
};
const goToPlan = (x, y) => {
    if (S.above) toggleAbove();
    const p = [x, y, eyeHeight()];
    if (inRooms(p))
        goTo(p);
    else
        W.say('That place is not inside a room.');
};
const pick = (x, y) => {  // px of the page
    const ratio = canvas.width / canvas.clientWidth, ray = W.unit(W.rayOf(S.camera, x * ratio, y * ratio));
    return W.hit(scene.models[S.edit], S.camera.centre, ray, Infinity, !!S.measure);
};
const pressed = (x, y) => {
    if (S.measure) return mark(x, y);
    const spot = (S.spots || []).find(([u, v, r]) => Math.hypot(x - u, (y - v) * 1.6) < Math.max(14, r * 1.2));
    if (spot) return enter(spot[3], true);
    if (S.above) return undefined;
    const hit = pick(x, y);
    if (!hit) return undefined;
    const target = [hit.point[0], hit.point[1], S.eye.centre[2]], way = W.add(target, S.eye.centre, -1);
    const off = hit.face.n[2] > 0.5 ? 0 : 0.09 * S.size, length = W.length(way);
    return goTo(reach(S.eye.centre, W.add(S.eye.centre, way, Math.max(0, length - off) / (length || 1))));
};

const step = (now) => {
    const passed = Math.min(0.1, (now - (S.last || now)) / 1000);
    S.last = now;
    if (S.move) {
        const m = S.move, t = Math.min(1, (now - m.start) / m.time), s = t * t * (3 - 2 * t);
        S.eye.centre = W.add(W.scale(m.from.centre, 1 - s), m.to.centre, s);
        S.eye.heading = m.from.heading + s * m.to.turn;
        S.eye.up = m.from.up + s * (m.to.up - m.from.up);
        if (t >= 1) S.move = null;
        S.moved = now;
        touch();
    }
    if (S.tour) {
        const frames = scene.models[S.edit].tour;
        S.tour.time += passed;
        const last = frames[frames.length - 1][0];
        if (S.tour.time >= last) {
            S.tour = null;
            buttons();
            W.say('The tour ends here.');
        } else {
            let k = frames.findIndex((f) => f[0] > S.tour.time);
            k = Math.max(1, k);
            const a = frames[k - 1], b = frames[k], t = (S.tour.time - a[0]) / (b[0] - a[0] || 1);
            const mix = (i) => a[i] + t * (b[i] - a[i]), axis = [mix(4), mix(5), mix(6)];
            S.eye = {
                centre: [mix(1), mix(2), mix(3)],
                heading: Math.atan2(axis[1], axis[0]),
                up: Math.atan2(axis[2], Math.hypot(axis[0], axis[1]))
            };
        }
        S.moved = now;
        touch();
    }
    if (S.keys.size) {
        const k = (name) => (S.keys.has(name) ? 1 : 0), turn = 1.6 * passed, far = 0.22 * S.size * passed;
        if (S.above) {
            S.above.heading += turn * (k('left') - k('right'));
            S.above.up = Math.min(-0.25, Math.max(-1.55, S.above.up + turn * (k('back') - k('forward')) * 0.7));
        } else {
            S.eye.heading += turn * (k('left') - k('right'));
            S.eye.up = Math.min(1.4, Math.max(-1.4, S.eye.up + turn * (k('up') - k('down'))));
            const c = Math.cos(S.eye.heading), s = Math.sin(S.eye.heading), on = k('forward') - k('back'),
                  side = k('sideRight') - k('sideLeft');
            if (on || side) {
                const to = W.add(S.eye.centre, [on * c + side * s, on * s - side * c, 0], far),
                      there = reach(S.eye.centre, to);
                if (inRooms(there)) S.eye.centre = there;
            }
        }
        S.moved = now;
        touch();
    }
};
const loop = (now) => {
    step(now);
    const was = S.rests, rests = now - S.moved > 150;
    S.rests = rests;
    if (!S.busy && (S.dirty || (rests && !was))) {
        S.dirty = false;
        S.frame++;
        pace(now, rests);
        fit();
        paint();
    }
    requestAnimationFrame(loop);
};
