// state.js - what is shown and from where; what is loaded for it.
'use strict';

const $ = (id) => document.getElementById(id);
const FIELD = 1.31, CLUTTER_VIEWS = 12, MOVING_VIEWS = 5;
// of textures of photographs that are kept: a phone ends a page that takes too much
const MOST_BYTES = matchMedia('(pointer: coarse)').matches ? 160e6 : 400e6;

W.say = (text, bad) => {
    $('told').textContent = text || '';
    $('told').classList.toggle('bad', !!bad);
};

const S = {
    // what is shown
    edit: 0,
    compare: false,
    split: 0.5,
    light: false,
    made: false,
    above: null,
    measure: null,
    tour: null,
    move: null,
    eye: {centre: [0, 0, 0], heading: 0, up: 0},
    field: FIELD,
    keys: new Set(),
    dirty: true,
    moved: 0,
    details: false,
};
let scene, painter, plan, pictures = new Set(), kinds, relitKinds;
const places = [];  // of each photograph: {texture, photo, used, meshes}
const models = [];  // of each model: {solid, vita, above, light, objects, cells}
const vita = {
    pages: []
};
let outdoors = null;
let canvas;

// Asks for a new picture.
const touch = () => {
    S.dirty = true;
};
