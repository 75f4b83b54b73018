// load.js - data that scripts beside the page hand over with walk_take(name, value); pictures out of it.
'use strict';
W.waiting = new Map();

window.walk_take = (name, value) => {
    const waiting = W.waiting.get(name);
    if (waiting) waiting.take(value);
};

// Loads NAME.js once it is asked for. A file that is missing gives null, and a line in the page.
W.load = (name) => {
    if (W.waiting.has(name)) return W.waiting.get(name).value;
    const entry = {};
    entry.value = new Promise((take) => {
        entry.take = take;
        const script = document.createElement('script');
        script.src = `${encodeURIComponent(name)}.js`;
        script.onload = () => script.remove();
        script.onerror = () => {
            W.say(`${name}.js is missing beside this page. Copy the whole folder, or run make walk again.`, true);
            take(null);
        };
        document.head.append(script);
    });
    W.waiting.set(name, entry);
    return entry.value;
};
// Lets the text of a file go after its pictures were made.
W.forget = (name) => W.waiting.delete(name);

W.bytes = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
W.unpack = async (base64) => {
    const stream = new Blob([W.bytes(base64)]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
};
W.picture = (base64) => createImageBitmap(
    new Blob([W.bytes(base64)], {type: 'image/webp'}), {premultiplyAlpha: 'none', colorSpaceConversion: 'none'});
// The bytes of a picture.
W.pixels = (picture) => {
    const c = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
    c.drawImage(picture, 0, 0);
    return c.getImageData(0, 0, picture.width, picture.height);
};
