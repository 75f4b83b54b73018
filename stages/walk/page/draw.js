// draw.js - draws the rooms with WebGL 2.
//
// A picture of the rooms is made in a buffer of sRGB: the faces under the textures of two
// viewpoints, then under the texture of all faces where these have none, then what lies outdoors, then the change of
// light of an edit. The stencil says which pixels have their colour: 1: of the first viewpoint, 2: done. The alpha of
// the buffer is the share of the first viewpoint where that has a texel, so that the second one blends to it. Furniture
// is drawn from several photographs into a buffer of half floats: first its depth, then the mean of what they show near
// that depth. In a viewpoint the photograph itself covers all.
'use strict';

// Furniture and samples of a pixel are summed as squares of sRGB, which are nearly linear in light: the way there and
// back is exact and quick, where textures of sRGB take half of the time when software draws.
// White stands for more light than a picture holds, a lamp or the sky: it stays white where something covers part of it.
const LINEAR = `vec3 linear(vec3 c) { return c * c * (min(min(c.r, c.g), c.b) > .992 ? 3. : 1.); }
`;
// Patterns over the colours of origin, so that nobody needs to tell colours apart: as the legend has them in walk.css.
const HATCH = `float hatch(int k) {
    vec2 p = mod(gl_FragCoord.xy, 14.);
    bool on = k == 0 ? mod(p.x - p.y + 14., 14.) < 3. : k == 2 ? length(p - 7.) < 1.5 : k == 3 ? mod(p.x + p.y, 14.) < 3. :
        k == 4 ? length(p - 7.) < 4. : k == 5 ? min(p.x, p.y) < 2. : k == 6 ? p.y < 3. : k == 7 ? p.x < 3. : false;
    return on ? .6 : 1.;
}
`;
W.squared = (linear) =>
    linear.map((x) => Math.min(1, x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055) ** 2);

// Furniture of a view, with what the other views say of it: see clutter_blend.c of render_model. A view whose nearest
// surface is behind a point, or that shows the model's own surface there, denies it, one with furniture there confirms
// it; one whose view of it is hidden has no vote. A thing that was found from many views is denied only by views that
// look through it. vote: the weight of this view, and how opaque the point is.
W.WITNESSES = 12;
W.VOTE = `layout(location=0) in vec3 p; layout(location=1) in vec2 place; layout(location=3) in float slack;
uniform mat4 clip, moved, toView[12]; uniform vec4 stands[12], sizes[12]; uniform vec3 eye; uniform int own, count;
uniform float spacing; uniform highp sampler2DArray sight; uniform int lit; uniform vec3 low, high;
uniform highp sampler3D volume; uniform vec2 sure;
out vec2 uv, vote; out vec3 light;
void main() {
    uv = place;
    vec4 there = moved * vec4(p, 1.);
    gl_Position = clip * there;
    light = lit == 1 ? pow(textureLod(volume, (there.xyz - low) / (high - low), 0.).rgb, vec3(.9)) : vec3(1);
    vec3 a = eye - p;
    float la = length(a), agreeing = 0., confirmed = 0., denied = 0., tolerance = .015 + fract(slack);
    vote = vec2(0);
    for (int k = 0; k < count; k++) {
        vec3 q = (toView[k] * vec4(p, 1.)).xyz, b = stands[k].xyz - p;
        vec2 at = q.xy / q.z, size = sizes[k].xy;
        if (q.z <= 0. || at.x < 0. || at.y < 0. || at.x >= size.x || at.y >= size.y) continue;
        vec4 s = texelFetch(sight, ivec3(at / spacing + .5, k), 0);
        float beyond = s.x > 0. ? 1. / (q.z * s.x) - 1. : 0., lb = length(b);
        bool mine = k == own;
        if (!mine && (s.x <= 0. || beyond < -tolerance)) continue;
        float penalty = length(a / la - b / lb) + .1 * max(0., lb / la - 1.);
        vec2 off = min(at, size - at);
        float weight = stands[k].w * clamp(min(off.x, off.y) / (.05 * max(size.x, size.y)), .001, 1.) /
            (.0064 + penalty * penalty);
        float here = mine ? 1. : (1. - smoothstep(tolerance, 2. * tolerance, beyond)) * (slack >= 1. ? 1. : s.z);
        confirmed += weight * s.y * here;
        agreeing += weight * here;
        denied += weight * s.y * (1. - here);
        if (mine) vote.x = weight;
    }
    if (agreeing > 0.)
        vote.y = smoothstep(sure.x, sure.y, agreeing / (agreeing + denied)) * smoothstep(.2, .45, confirmed / agreeing);
    vote.x *= .01;
}`;

W.shaders = {
    // faces
    solid: [
        `layout(location=0) in vec3 p; uniform mat4 clip; void main() { gl_Position = clip * vec4(p, 1.); }`,
        `void main() {}`
    ],
    face: [
        `layout(location=0) in vec3 p; layout(location=1) in vec3 uvw; layout(location=2) in vec4 rect;
        uniform mat4 clip; uniform vec2 size; out vec3 at; flat out vec4 box;
        void main() { gl_Position = clip * vec4(p, 1.); at = vec3(uvw.xy / size, uvw.z); box = (rect + vec4(.5, .5, -.5, -.5)) / size.xyxy; }`,
        `in vec3 at; flat in vec4 box; uniform sampler2D page; uniform float alpha, least; out vec4 colour;
        void main() {
            vec4 t = texture(page, clamp(at.xy / at.z, box.xy, box.zw));
            if (t.a < least) discard;
            colour = vec4(t.rgb, alpha);
        }`
    ],
    // a surface of one colour: rect holds it
    plain: [
        `layout(location=0) in vec3 p; layout(location=2) in vec4 rect; uniform mat4 clip; flat out vec4 box;
        void main() { gl_Position = clip * vec4(p, 1.); box = rect; }`,
        `flat in vec4 box; uniform int made; uniform vec3 kinds[9]; out vec4 colour;
        void main() { colour = vec4(sqrt(made == 1 ? kinds[5] * hatch(5) : box.rgb), 1.); }`
    ],
    // the same as face, in colours of origin, or as factors of light
    origin: [
        `layout(location=0) in vec3 p; layout(location=1) in vec3 uvw; layout(location=2) in vec4 rect;
        uniform mat4 clip; out vec3 at; flat out vec4 box;
        void main() { gl_Position = clip * vec4(p, 1.); at = uvw; box = rect; }`,
        `in vec3 at; flat in vec4 box; uniform sampler2D page; uniform vec2 size; uniform float alpha, least, most; uniform int made;
        uniform vec3 kinds[9]; out vec4 colour;
        void main() {
            vec2 uv = clamp(at.xy / at.z, box.xy + .5, box.zw - .5);
            vec4 t = texture(page, uv / size);
            if (t.a < least) discard;
            if (most == 1.) {
                t.rgb = linear(t.rgb);
                float a = texelFetch(page, ivec2(uv), 0).a;
                int of = a > .9 ? 2 : a > .6 ? 3 : a > .4 || a < .02 ? 4 : 5;
                vec3 k = kinds[of];
                colour = vec4(sqrt(mix(k, k * dot(t.rgb, vec3(.2126, .7152, .0722)) * 2., .5) * hatch(of)), alpha);
            } else {  // half of the factor of sRGB: twice the product is taken
                t.rgb = pow(t.rgb, vec3(2.2)) * most;
                bool changes = abs(dot(t.rgb, vec3(1. / 3.)) - 1.) > .03;
                vec3 factor = made == 0 ? pow(t.rgb, vec3(.45)) : changes ? sqrt(kinds[0] * hatch(0)) : vec3(1);
                colour = vec4(.5 * factor, 1.);
            }
        }`
    ],
    // what lies outdoors: in panes, or everywhere
    sky: [
        `layout(location=0) in vec3 p; uniform mat4 clip; uniform vec3 centre; out vec3 along;
        void main() { along = p - centre; gl_Position = (clip * vec4(p, 1.)).xyww; }`,
        `in vec3 along; uniform sampler2D page; uniform int made; uniform vec3 kinds[9]; out vec4 colour;
        void main() {
            vec2 uv = vec2(atan(along.y, along.x) / 6.2831853 + .5, .5 - atan(along.z, length(along.xy)) / 3.1415927);
            colour = vec4(textureLod(page, uv, 0.).rgb, 1.);
            if (made == 1) colour.rgb = sqrt(mix(kinds[6], linear(colour.rgb), .3) * hatch(6));
        }`
    ],
    blank: [
        `layout(location=0) in vec3 p; void main() { gl_Position = vec4(p.xy, 1., 1.); }`,
        `out vec4 colour; void main() { colour = vec4(0); }`
    ],
    // a photograph in its viewpoint
    photo: [
        `layout(location=0) in vec3 p; uniform mat4 clip; uniform mat3 turn; uniform vec3 centre; uniform vec4 lens; uniform vec2 size;
        out vec2 uv;
        void main() {
            uv = p.xy; vec3 d = vec3((p.xy * size - lens.zw) / lens.xy, 1.);
            gl_Position = (clip * vec4(centre + turn * d, 1.)).xyww;
        }`,
        `in vec2 uv; uniform sampler2D page; uniform float alpha; uniform int made, change; uniform vec3 kinds[9]; out vec4 colour;
        void main() {
            vec4 t = texture(page, uv);
            if (t.a < .03) discard;
            colour = vec4(t.rgb, alpha);
            if (made == 1) {
                int k = change == 1 ? int(texelFetch(page, ivec2(uv * vec2(textureSize(page, 0))), 0).a * 17. - 6.6667 + .5) : 1;
                colour.rgb = sqrt(mix(kinds[clamp(k, 0, 8)], linear(t.rgb), .3) * hatch(k));
            }
        }`
    ],
    // furniture
    clutter: [
        W.VOTE, `in vec2 uv, vote; in vec3 light; uniform sampler2D page; uniform int made; uniform vec3 kinds[9];
        layout(location=0) out vec4 colour; layout(location=1) out vec4 all;
        void main() {
            vec4 t = texture(page, uv);
            float a = clamp((t.a * 255. - 15.) / 240., 0., 1.);
            if (a < .02) discard;
            all = vec4(vote.x);
            a *= vote.y;
            t.rgb = linear(t.rgb) * light;
            vec3 c = made == 1 ? mix(kinds[7], kinds[7] * dot(t.rgb, vec3(.2126, .7152, .0722)) * 2., .5) * hatch(7) : t.rgb;
            a *= vote.x;
            colour = vec4(c * a, a);
        }`
    ],
    clutterDepth: [
        W.VOTE, `in vec2 uv; in vec2 vote; uniform sampler2D page;
        void main() {
            if (clamp((texture(page, uv).a * 255. - 15.) / 240., 0., 1.) * vote.y < .5) discard;
        }`
    ],
    object: [
        `layout(location=0) in vec3 p; layout(location=1) in vec3 n; uniform mat4 clip; out vec3 normal;
        void main() { normal = n; gl_Position = clip * vec4(p, 1.); }`,
        `in vec3 normal; uniform vec3 albedo; uniform int made; uniform vec3 kinds[9]; out vec4 colour;
        void main() { colour = vec4(sqrt(made == 1 ? kinds[5] * hatch(5) : albedo * (.75 + .25 * normalize(normal).z)), 1.); }`
    ],
    // the buffers laid together: pixel by pixel, or with more or fewer pixels than the canvas
    show: [
        `layout(location=0) in vec3 p; void main() { gl_Position = vec4(p.xy, 0., 1.); }`,
        `uniform sampler2D shell; out vec4 colour;
        void main() {
            vec3 c = texelFetch(shell, ivec2(gl_FragCoord.xy), 0).rgb;
            colour = vec4(min(min(c.r, c.g), c.b) > .992 ? vec3(1) : c, 1.);
        }`
    ],
    showFurniture: [
        `layout(location=0) in vec3 p; void main() { gl_Position = vec4(p.xy, 0., 1.); }`,
        `uniform sampler2D shell, clutter, all; out vec4 colour;
        void main() {
            ivec2 at = ivec2(gl_FragCoord.xy);
            vec3 c = linear(texelFetch(shell, at, 0).rgb);
            vec4 f = texelFetch(clutter, at, 0);
            if (f.a > 0.) c = mix(c, f.rgb / f.a, min(1., f.a / texelFetch(all, at, 0).r));
            colour = vec4(sqrt(clamp(c, 0., 1.)), 1.);
        }`
    ],
    showScaled: [
        `layout(location=0) in vec3 p; out vec2 uv; uniform vec2 part;
        void main() { gl_Position = vec4(p.xy, 0., 1.); uv = (p.xy * .5 + .5) * part; }`,
        `in vec2 uv; uniform sampler2D shell, clutter, all; uniform int furniture, four; out vec4 colour;
        void main() {
            vec3 c;
            if (four == 1) {  // samples of a pixel
                ivec2 at = 2 * ivec2(gl_FragCoord.xy);
                c = vec3(0);
                for (int k = 0; k < 4; k++) c += .25 * linear(texelFetch(shell, at + ivec2(k & 1, k >> 1), 0).rgb);
            } else
                c = linear(texture(shell, uv).rgb);
            if (furniture == 1) {
                vec4 f = texture(clutter, uv);
                if (f.a > 0.) c = mix(c, f.rgb / f.a, min(1., f.a / texture(all, uv).r));
            }
            colour = vec4(sqrt(clamp(c, 0., 1.)), 1.);
        }`
    ],
};

W.integers = new Set(['made', 'kind', 'furniture', 'change', 'shell', 'clutter', 'own', 'count', 'sight', 'all', 'lit', 'volume', 'four']);  // uniforms

class Painter {
    constructor(canvas) {
        const gl =
            canvas.getContext('webgl2', {alpha: false, antialias: false, depth: false, preserveDrawingBuffer: true});
        if (!gl)
            throw new Error(
                'This browser has no WebGL 2, which the rooms are drawn with. Try another browser, or allow its hardware acceleration.');
        this.gl = gl;
        this.floats = gl.getExtension('EXT_color_buffer_float') || gl.getExtension('EXT_color_buffer_half_float');
        this.programs = {};
        for (const name in W.shaders) this.programs[name] = this.compile(name);
        this.square = this.buffer(new Float32Array([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]), [[0, 3]]);
        this.unit = this.buffer(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0]), [[0, 3]]);
        this.empty = this.texture(new ImageData(1, 1));
        this.counts = {};
        this.texels = new Map();  // of each texture
    }
    compile(name) {
        const gl = this.gl, program = gl.createProgram(), head = (i) => `#version 300 es
precision highp float; precision highp int;
${i ? LINEAR : ''}${i && W.shaders[name][1].includes('hatch(') ? HATCH : ''}`;
        W.shaders[name].forEach((text, i) => {
            const shader = gl.createShader(i ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
            gl.shaderSource(shader, head(i) + text);
            gl.compileShader(shader);
            if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
                throw new Error(`${name}: ${gl.getShaderInfoLog(shader)}`);
            gl.attachShader(program, shader);
        });
        gl.linkProgram(program);
        if (!gl.getProgramParameter(program, gl.LINK_STATUS))
            throw new Error(`${name}: ${gl.getProgramInfoLog(program)}`);
        const places = {};
        for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
            const key = gl.getActiveUniform(program, i).name.replace('[0]', '');
            places[key] = gl.getUniformLocation(program, key);
        }
        return {program, places};
    }
    // layout: [[location, numbers], ...] of a corner
    buffer(data, layout, elements) {
        const gl = this.gl, array = gl.createVertexArray(), stride = 4 * layout.reduce((sum, l) => sum + l[1], 0);
        const numbers = gl.createBuffer();
        gl.bindVertexArray(array);
        gl.bindBuffer(gl.ARRAY_BUFFER, numbers);
        gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
        let at = 0;
        for (const [place, count] of layout) {
            gl.enableVertexAttribArray(place);
            gl.vertexAttribPointer(place, count, gl.FLOAT, false, stride, at);
            at += 4 * count;
        }
        let index = null;
        if (elements) {
            index = gl.createBuffer();
            gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, index);
            gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, elements, gl.STATIC_DRAW);
        }
        gl.bindVertexArray(null);
        return {array, data: numbers, index, count: elements ? elements.length : (4 * data.length) / stride};
    }
    texture(picture) {
        const gl = this.gl, t = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, t);
        gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
        gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
        const made = {texture: t, size: [picture.width, picture.height], bytes: 4 * picture.width * picture.height};
        if (picture.close) picture.close();
        return made;
    }
    // Colours in space: {size, low, high, texels}.
    volume(v) {
        const gl = this.gl, t = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_3D, t);
        gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGBA16F, ...v.size, 0, gl.RGBA, gl.FLOAT, v.texels);
        for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
            gl.texParameteri(gl.TEXTURE_3D, side, gl.CLAMP_TO_EDGE);
        gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
        gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
        return {texture: t, low: v.low, high: v.high};
    }
    drop(t) {
        if (t) this.gl.deleteTexture(t.texture);
    }
    dropBuffer(b) {
        if (!b) return;
        this.gl.deleteVertexArray(b.array);
    }
    resize(width, height) {
        if (this.width === width && this.height === height) return;
        const gl = this.gl;
        for (const b of this.targets || []) {
            gl.deleteFramebuffer(b.frame);
            gl.deleteTexture(b.colour);
            if (b.all) gl.deleteTexture(b.all);
        }
        if (this.depth) gl.deleteRenderbuffer(this.depth);
        Object.assign(this, {width, height});
        this.depth = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, this.depth);
        gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH24_STENCIL8, width, height);
        this.targets = [gl.RGBA8, this.floats ? gl.RGBA16F : gl.RGBA8].map((format) => {
            const colour = gl.createTexture(), frame = gl.createFramebuffer();
            gl.bindTexture(gl.TEXTURE_2D, colour);
            gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
            gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
            gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, colour, 0);
            gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_STENCIL_ATTACHMENT, gl.RENDERBUFFER, this.depth);
            return {colour, frame};
        });
        // of furniture: the weights of all that was drawn in a pixel
        const all = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, all);
        gl.texStorage2D(gl.TEXTURE_2D, 1, this.floats ? gl.R16F : gl.R8, width, height);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT1, gl.TEXTURE_2D, all, 0);
        gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
        this.targets[1].all = all;
    }
    use(name, values) {
        const gl = this.gl, {program, places} = this.programs[name];
        gl.useProgram(program);
        this.set(name, values);
        return places;
    }
    set(name, values) {
        const gl = this.gl, places = this.programs[name].places;
        for (const key in values) {
            const v = values[key], at = places[key];
            if (at === undefined) continue;
            if (key === 'kinds')
                gl.uniform3fv(at, v);
            else if (key === 'toView')
                gl.uniformMatrix4fv(at, false, v);
            else if (key === 'stands' || key === 'sizes')
                gl.uniform4fv(at, v);
            else if (W.integers.has(key))
                gl.uniform1i(at, v);
            else if (typeof v === 'number')
                gl.uniform1f(at, v);
            else if (v.length === 2)
                gl.uniform2fv(at, v);
            else if (v.length === 3)
                gl.uniform3fv(at, v);
            else if (v.length === 4)
                gl.uniform4fv(at, v);
            else if (v.length === 9)
                gl.uniformMatrix3fv(at, false, v);
            else
                gl.uniformMatrix4fv(at, false, v);
        }
    }
    bind(t) {
        this.gl.bindTexture(this.gl.TEXTURE_2D, t.texture);
        this.seen.set(t, t.bytes);
    }
    draw(buffer, first, count, strip) {
        const gl = this.gl;
        gl.bindVertexArray(buffer.array);
        if (buffer.index)
            gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 4 * first);
        else
            gl.drawArrays(strip ? gl.TRIANGLE_STRIP : gl.TRIANGLES, first, count);
        this.counts.calls++;
        this.counts.triangles += count / 3;
    }
    // Draws the parts of a mesh that have rule r, of kind `place`, or all. values: of the program that draws them.
    faces(program, set, r, values, all) {
        let used = '';
        for (const d of set.draws) {
            if (d.rule !== r || (!all && d.kind !== 'place')) continue;
            const page = set.pages[d.page], name = d.kind === 'colour' ? 'plain' : program;
            if (!page && name !== 'plain') continue;
            if (used !== name) this.use(used = name, values);
            if (name !== 'plain') {
                this.bind(page);
                this.set(name, {least: d.kind === 'edge' ? 0 : 0.02, size: page.size});
            }
            this.draw(set.buffer, d.first, d.count);
        }
    }
    /* p: what to draw:
     *   camera, box (x y width height of the canvas), part (of its pixels along each side: less while it must be
     * quick), solid, sets: [first, second] viewpoint or null, share, vita, rules, outdoors, panes (where it is seen; null: anywhere), light: {set, most},
     * clutter: {draws: [{texture, buffer, first, count, moved, own, eye}], witnesses}, grid,
     * sure: shares of the votes from which on furniture begins to show, and is whole, photos: [{view, texture, alpha, change}], objects,
     * made (0, or 1: colours of origin), kinds, near, far */
    paint(p) {
        const gl = this.gl, {camera} = p, clip = W.clipMatrix(camera, p.near, p.far),
              values = {clip, made: p.made, kinds: p.kinds, most: 1};
        this.seen = this.seen || new Map();
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets[0].frame);
        const {width, height} = gl.canvas, part = p.part || 1;
        const wide = Math.round(part * width), high = Math.round(part * height);
        const box = p.box.map((x) => Math.round(part * x));
        gl.viewport(0, 0, wide, high);
        gl.enable(gl.SCISSOR_TEST);
        gl.scissor(...box);
        gl.activeTexture(gl.TEXTURE0);
        gl.enable(gl.DEPTH_TEST);
        gl.depthMask(true);
        gl.stencilMask(255);
        gl.colorMask(true, true, true, true);
        gl.clearColor(0, 0, 0, 0);
        gl.clear(gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
        this.blank();
        gl.enable(gl.CULL_FACE);
        // what hides what
        gl.depthFunc(gl.LESS);
        gl.colorMask(false, false, false, false);
        gl.enable(gl.POLYGON_OFFSET_FILL);
        gl.polygonOffset(1, 2);
        this.use('solid', {clip});
        this.draw(p.solid, 0, p.solid.count);
        gl.disable(gl.POLYGON_OFFSET_FILL);
        gl.colorMask(true, true, true, true);
        gl.depthMask(false);
        gl.depthFunc(gl.LEQUAL);
        // faces
        gl.enable(gl.STENCIL_TEST);
        const [a, b] = p.sets, program = p.made ? 'origin' : 'face';
        for (let r = 0; r < p.rules; r++) {
            gl.disable(gl.BLEND);
            gl.stencilFunc(gl.EQUAL, 0, 255);
            gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
            if (a) this.faces(program, a, r, {...values, alpha: 1 - p.share});
            if (b && (p.share > 0.004 || !a)) {
                if (a && !r) {
                    gl.enable(gl.BLEND);
                    gl.blendFuncSeparate(gl.ONE_MINUS_DST_ALPHA, gl.DST_ALPHA, gl.ONE, gl.ZERO);
                    gl.stencilFunc(gl.GREATER, 2, 255);
                    gl.stencilOp(gl.KEEP, gl.KEEP, gl.REPLACE);
                }
                this.faces(program, b, r, {...values, alpha: 1});
            }
            gl.disable(gl.BLEND);
            gl.stencilFunc(gl.EQUAL, 0, 255);
            gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
            this.faces(program, p.vita, r, {...values, alpha: 1}, true);
        }
        if (p.light) {  // once in each pixel
            gl.stencilMask(128);
            gl.stencilFunc(gl.NOTEQUAL, 128, 128);
            gl.stencilOp(gl.KEEP, gl.KEEP, gl.REPLACE);
            gl.enable(gl.BLEND);
            gl.blendFunc(gl.DST_COLOR, gl.SRC_COLOR);
            this.faces('origin', p.light.set, 0, {
                ...values,
                alpha: 1,
                most: p.light.most,
                made: p.made ? 2 : 0,
                kinds: p.made ? p.relitKinds : p.kinds
            });
            gl.disable(gl.BLEND);
        }
        gl.disable(gl.STENCIL_TEST);
        gl.disable(gl.CULL_FACE);
        if (p.objects) {
            gl.depthMask(true);
            for (const o of p.objects) {
                this.use('object', {...values, albedo: o.albedo});
                this.draw(o.buffer, 0, o.buffer.count);
            }
            gl.depthMask(false);
        }
        if (p.outdoors) {
            this.bind(p.outdoors);
            this.use('sky', {...values, centre: camera.centre});
            if (p.panes) {
                gl.enable(gl.CULL_FACE);
                if (p.panes.count) this.draw(p.panes, 0, p.panes.count);
                gl.disable(gl.CULL_FACE);
            } else
                this.draw(this.around(camera), 0, 4, true);
        }
        if (p.clutter.draws.length) this.paintClutter(p, values);
        gl.disable(gl.DEPTH_TEST);
        gl.activeTexture(gl.TEXTURE1);
        gl.bindTexture(gl.TEXTURE_2D, this.targets[1].colour);
        gl.activeTexture(gl.TEXTURE3);
        gl.bindTexture(gl.TEXTURE_2D, this.targets[1].all);
        gl.activeTexture(gl.TEXTURE0);
        if (p.photos.length) this.paintPhotos(p, values);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.viewport(0, 0, width, height);
        gl.scissor(...p.box);
        gl.bindTexture(gl.TEXTURE_2D, this.targets[0].colour);
        const furniture = p.clutter.draws.length && !p.photos.length ? 1 : 0, sources = {shell: 0, clutter: 1, all: 3};
        if (part === 1)
            this.use(furniture ? 'showFurniture' : 'show', sources);
        else
            this.use('showScaled', {
                ...sources,
                part: [wide / this.width, high / this.height],
                furniture,
                four: part === 2 ? 1 : 0
            });
        this.draw(this.square, 0, 4, true);
    }
    // Makes all colours of bytes 0: software draws a square in half the time in which it clears them.
    blank() {
        const gl = this.gl;
        gl.disable(gl.CULL_FACE);
        gl.disable(gl.DEPTH_TEST);
        this.use('blank', {});
        this.draw(this.square, 0, 4, true);
        gl.enable(gl.DEPTH_TEST);
    }
    // A square far before a camera that covers its picture.
    around(camera) {
        const gl = this.gl, b = this.far || (this.far = this.buffer(new Float32Array(12), [[0, 3]]));
        const corners = [[0, camera.height], [camera.width, camera.height], [0, 0], [camera.width, 0]];
        gl.bindBuffer(gl.ARRAY_BUFFER, b.data);
        gl.bufferSubData(
            gl.ARRAY_BUFFER, 0,
            new Float32Array(corners.flatMap(([x, y]) => W.add(camera.centre, W.rayOf(camera, x, y)))));
        return b;
    }
    // The views that vote on furniture: what each sees, a layer of a texture, and where it stands.
    witnesses(list) {
        const gl = this.gl, high = [0, 1].map((k) => Math.max(...list.map((w) => w.size[k])));
        const toView = new Float32Array(16 * W.WITNESSES), stands = new Float32Array(4 * W.WITNESSES),
              sizes = new Float32Array(4 * W.WITNESSES);
        gl.activeTexture(gl.TEXTURE2);
        if (!this.sight || this.sight.size.some((x, k) => x < high[k])) {
            if (this.sight) gl.deleteTexture(this.sight.texture);
            this.sight = {texture: gl.createTexture(), size: high, layers: []};
            gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.sight.texture);
            gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGBA16F, ...high, W.WITNESSES);
            gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
            gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        }
        gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.sight.texture);
        list.forEach((w, k) => {
            const {view} = w, r = view.turn, [fx, fy, cx, cy] = view.lens;
            if (this.sight.layers[k] !== w.number)
                gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, k, ...w.size, 1, gl.RGBA, gl.FLOAT, w.sight);
            this.sight.layers[k] = w.number;
            const rows = [0, 3, 6].map((i) => [r[i], r[i + 1], r[i + 2], -W.dot(r.slice(i, i + 3), view.centre)]);
            for (let c = 0; c < 4; c++)
                toView.set([fx * rows[0][c] + cx * rows[2][c], fy * rows[1][c] + cy * rows[2][c], rows[2][c], 0],
                    16 * k + 4 * c);
            stands.set([...view.centre, w.fade], 4 * k);
            sizes.set([view.width, view.height, 0, 0], 4 * k);
        });
        gl.activeTexture(gl.TEXTURE0);
        return {toView, stands, sizes, count: list.length, sight: 2};
    }
    paintClutter(p, values) {
        const gl = this.gl, votes = this.witnesses(p.clutter.witnesses), volume = p.light && p.light.volume;
        gl.activeTexture(gl.TEXTURE4);
        gl.bindTexture(gl.TEXTURE_3D, volume ? volume.texture : null);
        gl.activeTexture(gl.TEXTURE0);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets[1].frame);
        gl.clear(gl.COLOR_BUFFER_BIT);
        for (const pass of [0, 1]) {
            gl.colorMask(pass, pass, pass, pass);
            gl.depthMask(!pass);
            if (pass) {
                gl.enable(gl.BLEND);
                gl.blendFunc(gl.ONE, gl.ONE);
            }
            // near the first surface counts as on it: as if it were 7 % nearer
            const nearer = pass ? 1.07 : 1, clip = W.clipMatrix(p.camera, p.near * nearer, p.far * nearer);
            const name = pass ? 'clutter' : 'clutterDepth';
            this.use(name, {
                ...values,
                ...votes,
                clip,
                spacing: p.grid,
                sure: p.sure,
                lit: volume && pass ? 1 : 0,
                volume: 4,
                low: volume ? volume.low : [0, 0, 0],
                high: volume ? volume.high : [1, 1, 1]
            });
            for (const c of p.clutter.draws) {
                if (!c.count) continue;
                this.bind(c.texture);
                this.set(name, {moved: c.moved, own: c.own, eye: c.eye});
                this.draw(c.buffer, c.first, c.count);
            }
        }
        gl.disable(gl.BLEND);
    }
    // Over everything, furniture too: that is laid over the faces first.
    paintPhotos(p, values) {
        const gl = this.gl;
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets[0].frame);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
        if (p.clutter.draws.length) {
            gl.bindTexture(gl.TEXTURE_2D, this.targets[1].colour);
            this.use('lay', {
                shell: 0,
                all: 3,
                part: [gl.getParameter(gl.VIEWPORT)[2] / this.width, gl.getParameter(gl.VIEWPORT)[3] / this.height]
            });
            this.draw(this.square, 0, 4, true);
        }
        for (const photo of p.photos) {
            this.bind(photo.texture);
            const v = photo.view;
            this.use('photo', {
                ...values,
                turn: v.turn,
                centre: p.camera.centre,
                lens: v.lens,
                size: [v.width, v.height],
                alpha: photo.alpha,
                change: photo.change ? 1 : 0
            });
            this.draw(this.unit, 0, 4, true);
        }
        gl.disable(gl.BLEND);
    }
}
W.shaders.lay = [
    W.shaders.showScaled[0], `in vec2 uv; uniform sampler2D shell, all; out vec4 colour;
    void main() {
        vec4 f = texture(shell, uv);
        if (f.a <= 0.) discard;
        colour = vec4(sqrt(f.rgb / f.a), min(1., f.a / texture(all, uv).r));
    }`
];
W.Painter = Painter;
