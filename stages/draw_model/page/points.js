/* points.js - the scene's points: what draw_points.c packed becomes the file that the C code reads. */
'use strict';

function bytesFromBase64(text) {
    const binary = atob(text), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
    return bytes;
}

/* What zlib compressed, in parts of base64. */
async function unpack(parts) {
    const stream = new Blob(parts.map(bytesFromBase64)).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/* points.ply of positions in steps, folded normals and confidences. */
function plyOfPoints({count, cell, step, low}, planes) {
    const types = ['double x', 'double y', 'double z', 'float nx', 'float ny', 'float nz', 'uchar red', 'uchar green',
        'uchar blue', 'ushort views', 'float confidence'], RECORD = 45;
    const head = new TextEncoder().encode('ply\nformat binary_little_endian 1.0\ncomment remodel-points 1\n' +
        `comment cell ${cell}\nelement vertex ${count}\n${types.map((t) => `property ${t}\n`).join('')}end_header\n`);
    const bytes = new Uint8Array(head.length + RECORD * count), view = new DataView(bytes.buffer), at = [0, 0, 0];
    bytes.set(head);
    for (let i = 0, to = head.length; i < count; i++, to += RECORD) {
        for (let k = 0; k < 3; k++) {
            const from = 3 * k * count + i;
            const zigzag = planes[from] | planes[from + count] << 8 | planes[from + 2 * count] << 16;
            at[k] += (zigzag >>> 1) ^ -(zigzag & 1);
            view.setFloat64(to + 8 * k, low[k] + step * at[k], true);
        }
        let x = planes[9 * count + i] / 127 - 1, y = planes[10 * count + i] / 127 - 1;
        const z = 1 - Math.abs(x) - Math.abs(y);
        if (z < 0) [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
        const size = Math.hypot(x, y, z);
        view.setFloat32(to + 24, x / size, true);
        view.setFloat32(to + 28, y / size, true);
        view.setFloat32(to + 32, z / size, true);
        view.setUint16(to + 39, 1, true);
        view.setFloat32(to + 41, planes[11 * count + i] / 255, true);
    }
    return bytes;
}

if (typeof module !== 'undefined') module.exports = {plyOfPoints};
