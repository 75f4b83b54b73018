/* effects.c - tests of effect layers: the file, interpolation, and their effect on pixels of known position. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/film/effects.h"

#define W 77
#define H 20

static struct view a_camera(void)
{
    struct view v = {.name = "0001", .width = W, .height = H, .fx = 60, .fy = 55, .cx = 40.25, .cy = 9};
    v.cam_from_world = (struct mat3){{{0.8, 0, -0.6}, {0, 1, 0}, {0.6, 0, 0.8}}};
    v.translation = vec3_make(0.3, -0.2, 0.5);
    v.center = vec3_scale(mat3_apply(mat3_transpose(v.cam_from_world), v.translation), -1);
    return v;
}

static void make_frame(struct rendered_frame *f)
{
    struct err err = ERR_INIT;
    assert_ok(rendered_frame_resize(f, W, H, true, &err), err);
    for (int i = 0; i < W * H; i++) {
        for (int k = 0; k < 3; k++) f->rgba[4 * i + k] = (float)((i * (7 + k) + k) % 64) / 40;
        f->rgba[4 * i + 3] = 1;
        f->z[i] = i % 11 ? 1.5f + (float)(i % W) / 30 : 0;
        f->hole[i] = 0;
    }
}

static void read_text(struct effects *e, const char *text)
{
    struct err err = ERR_INIT;
    assert_ok(effects_read(e, scratch_write("effects.txt", text), NULL, &err), err);
}

static double luminance(const float *c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

/* The weight of a layer's first box by its definition, in doubles. */
static double weight_at(const struct view *v, const struct effect_layer *l, int x, int y, float z)
{
    const struct effect_box *b = l->boxes;
    double inside = 0;
    if (l->region == EFFECT_ALL) return 1;
    if (z > 0) {
        const struct vec3 p = view_unproject(v, x + 0.5, y + 0.5, z);
        const struct vec3 middle = vec3_scale(vec3_add(b->low, b->high), 0.5);
        struct mat3 box_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        if (effect_box_is_turned(b)) box_from_world = mat3_from_quat(quat_normalize(b->box_from_world));
        const struct vec3 q = mat3_apply(box_from_world, vec3_sub(p, middle));
        const double dx = fmax(fabs(q.x) - (b->high.x - b->low.x) / 2, 0);
        const double dy = fmax(fabs(q.y) - (b->high.y - b->low.y) / 2, 0);
        const double dz = fmax(fabs(q.z) - (b->high.z - b->low.z) / 2, 0), d = sqrt(dx * dx + dy * dy + dz * dz);
        inside = b->falloff > 0 ? exp(-d * d / (2 * b->falloff * b->falloff)) : d == 0;
    }
    return l->region == EFFECT_INSIDE ? inside : 1 - inside;
}

static void a_file_is_read(void **state)
{
    (void)state;
    struct effects e;

    read_text(&e, "# made by hand\n\nremodel-effects 1\n"
                  "layer grey saturation\n  region outside -1 -2 -3 1 2 3 0.25\n  key 0 1\n  key 2 0\n"
                  "layer \"warm light\" color\n\tregion all\n\tkey 1.5 1.2 1 0.8\n");
    assert_int_equal(e.layer_count, 2);
    assert_string_equal(e.layers[0].name, "grey");
    assert_true(e.layers[0].kind == EFFECT_SATURATION && e.layers[0].region == EFFECT_OUTSIDE);
    assert_true(e.layers[0].box_count == 1 && e.layers[0].key_count == 2);
    const struct effect_box *b = e.layers[0].boxes;
    assert_true(b->low.x == -1 && b->low.z == -3 && b->high.y == 2 && b->falloff == 0.25);
    assert_true(b->time == 0 && !effect_box_is_turned(b));
    assert_string_equal(e.layers[1].name, "warm light");
    assert_true(e.layers[1].kind == EFFECT_COLOR && e.layers[1].region == EFFECT_ALL);
    assert_int_equal(e.layers[1].box_count, 0);
    assert_true(e.layers[1].keys[0].time == 1.5 && e.layers[1].keys[0].value[2] == 0.8);
    effects_release(&e);
    effects_release(&e);
}

static void boxes_with_axes_and_times_are_read(void **state)
{
    (void)state;
    struct effects e;

    read_text(&e, "remodel-effects 1\nlayer a color\n"
                  "region outside 0 0 0 1 1 1 0.5 axes 2 0 0 -2\n"
                  "region outside 0 0 0 1 1 2 0 at 1.5 axes 0 0 1 0\n"
                  "region outside 0 0 0 1 1 3 0 axes 0 0 1 0 at 2\n"
                  "region outside 0 0 0 1 1 4 0 at 9\n"
                  "curve cubic\nkey 0 1 1 1\n"
                  "layer b brightness\nregion inside 0 0 0 1 1 1 0 at -0\nkey 0 1\n");
    const struct effect_box *b = e.layers[0].boxes;
    assert_int_equal(e.layers[0].box_count, 4);
    assert_true(b[0].time == 0 && b[1].time == 1.5 && b[2].time == 2 && b[3].time == 9);
    assert_true(b[0].box_from_world.w == 2 && b[0].box_from_world.z == -2 && b[0].falloff == 0.5);
    assert_true(b[1].box_from_world.y == 1 && b[2].box_from_world.y == 1 && !effect_box_is_turned(&b[3]));
    for (int i = 0; i < 4; i++) assert_true(b[i].high.z == i + 1);
    assert_true(e.layers[0].region == EFFECT_OUTSIDE && e.layers[0].curve == EFFECT_CUBIC);
    assert_true(e.layers[1].boxes[0].time == 0 && !signbit(e.layers[1].boxes[0].time));
    effects_release(&e);
}

static void bad_files_are_refused_with_file_and_line(void **state)
{
    (void)state;
#define HEAD  "remodel-effects 1\n"
#define LAYER HEAD "layer a brightness\n"
#define BOX   "region inside 0 0 0 1 1 1 0"
    static const struct {
        const char *text, *line, *words;
    } bad[] = {
        {"", "an empty file", "wanted a line \"remodel-effects ...\""},
        {"remodel-path 1\n", ":1:", "found \"remodel-path\", wanted a line \"remodel-effects ...\""},
        {"remodel-effects 2\n", ":1:", "found \"2\""},
        {HEAD "region all\n", ":2:", "wanted layer"},
        {HEAD "layer\n", ":2:", "the layer's name"},
        {HEAD "layer a\rb color\n", ":2:", "a name of 1 to 64 printable characters"},
        {HEAD "layer a hue\n", ":2:", "found \"hue\", wanted what the layer changes: saturation, brightness or color"},
        {HEAD "layer a color 1\n", ":2:", "wanted the end of the line"},
        {LAYER, ":2:", "found the end of the file, wanted a region of the layer a"},
        {LAYER "key 0 1\n", ":3:", "found \"key\", wanted region"},
        {LAYER "layer b color\n", ":3:", "wanted a region of the layer a"},
        {LAYER "region near\n", ":3:", "all, inside or outside"},
        {LAYER "region all 1\n", ":3:", "wanted the end of the line"},
        {LAYER "region inside 0 0 0 1 1\n", ":3:", "wanted z1"},
        {LAYER "region inside 0 0 0 1 -1 1 0\n", ":3:", "found \"-1\", wanted y1, a number from 0"},
        {LAYER "region inside 0 0 0 1 1 1 -2\n", ":3:", "the fall-off, a number from 0"},
        {LAYER BOX " 1\n", ":3:", "found \"1\", wanted axes QW QX QY QZ, at TIME (each once) or the end of the line"},
        {LAYER BOX " axes 1 0 0\n", ":3:", "found the end of the line, wanted qz"},
        {LAYER BOX " axes 1 0 0 nan\n", ":3:", "found \"nan\", wanted qz, a number from -1e+09 to 1e+09"},
        {LAYER BOX " axes inf 0 0 0\n", ":3:", "found \"inf\", wanted qw, a number from -1e+09 to 1e+09"},
        {LAYER BOX " axes 0 -0 0 0\n",
         ":3:", "found \"a quaternion of length 0\", wanted one of length 1: qw qx qy qz"},
        {LAYER BOX " axes 0 0 1e-7 0\n", ":3:", "found \"a quaternion of length 0\""},
        {LAYER BOX " axes 1 0 0 0 axes 1 0 0 0\n",
         ":3:", "found \"axes\", wanted axes QW QX QY QZ, at TIME (each once)"},
        {LAYER BOX " at\n", ":3:", "found the end of the line, wanted a time"},
        {LAYER BOX " at -1\n", ":3:", "found \"-1\", wanted a time, a number from 0 to 1000000"},
        {LAYER BOX " at nan\n", ":3:", "found \"nan\", wanted a time"},
        {LAYER BOX " at 1 at 2\n", ":3:", "found \"at\", wanted axes"},
        {LAYER BOX "\n" BOX "\n",
         ":4:", "found the end of the line, wanted at TIME, after 0, that of the previous region"},
        {LAYER BOX " at 2\n" BOX " at 2\n",
         ":4:", "found \"at 2\", wanted a time after 2, that of the previous region"},
        {LAYER BOX "\nregion outside 0 0 0 1 1 1 0 at 2\n",
         ":4:", "found \"outside\", wanted inside, as the layer's first region"},
        {LAYER BOX "\nregion all\n", ":4:", "found \"all\", wanted inside, as the layer's first region"},
        {LAYER BOX "\nwall\n", ":4:", "found \"wall\", wanted region, curve, key or layer"},
        {LAYER BOX "\ncurve cubic\n" BOX " at 1\n", ":5:", "found \"region\", wanted key or layer"},
        {LAYER BOX "\nkey 0 1\n" BOX " at 1\n", ":5:", "found \"region\", wanted key or layer"},
        {LAYER "region all axes 1 0 0 0\n", ":3:", "found \"axes 1 0 0 0\", wanted the end of the line"},
        {LAYER "region all at 1\n", ":3:", "found \"at 1\", wanted the end of the line"},
        {LAYER "region all\n", ":3:", "found the end of the file, wanted a key of the layer a"},
        {LAYER "region all\nregion all\n", ":4:", "wanted key or layer"},
        {LAYER "region all\nkey 0\n", ":4:", "wanted brightness"},
        {LAYER "region all\nkey 0 -1\n", ":4:", "brightness, a number from 0 to 100"},
        {LAYER "region all\nkey 0 nan\n", ":4:", "found \"nan\""},
        {LAYER "region all\nkey -1 1\n", ":4:", "a time, a number from 0"},
        {LAYER "region all\nkey 1 1\nkey 1 2\n", ":5:", "wanted a time after 1"},
        {LAYER "region all\nkey 0 1\nlayer a color\n", ":5:", "a name that no other layer has"},
        {HEAD "layer a color\nregion all\nkey 0 1 1\n", ":4:", "wanted blue"},
        {LAYER "curve cubic\n", ":3:", "wanted region"},
        {LAYER "region all\ncurve round\n", ":4:", "found \"round\", wanted linear or cubic"},
        {LAYER "region all\ncurve cubic\ncurve cubic\n", ":5:", "wanted key or layer"},
        {LAYER "region all\nkey 0 1\ncurve cubic\n", ":5:", "wanted key or layer"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct effects e;
        struct err err = ERR_INIT;
        const char *path = scratch_write("bad.txt", bad[i].text);
        assert_int_equal(effects_read(&e, path, NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, bad[i].words);
        assert_contains(err.text, bad[i].line);
        assert_contains(err.text, path);
        assert_true(!e.layers && !e.layer_count);
    }
}

static void a_written_file_reads_back_the_same(void **state)
{
    (void)state;
    struct effects e, again;
    struct err err = ERR_INIT;
    const struct provenance prov = {.stage = "plan_path", .version = "0"};
    const char *path = scratch_path("written.txt");

    read_text(&e,
              "remodel-effects 1\nlayer \"a \\\"b\\\" #\" color\nregion inside 0.1 0.2 0.3 0.4 0.7 0.9 0.123456789\n"
              "key 0.1 0.3 0.7 1.1\nkey 0.30000000000000004 1 2 3\nlayer b saturation\nregion all\nkey 0 2\n");
    assert_ok(effects_write(&e, path, &prov, &err), err);
    assert_ok(effects_read(&again, path, NULL, &err), err);
    assert_int_equal(again.layer_count, 2);
    assert_string_equal(again.layers[0].name, "a \"b\" #");
    assert_memory_equal(again.layers[0].keys, e.layers[0].keys, 2 * sizeof *e.layers[0].keys);
    assert_memory_equal(again.layers[0].boxes, e.layers[0].boxes, sizeof *e.layers[0].boxes);
    assert_true(again.layers[1].kind == EFFECT_SATURATION && again.layers[1].region == EFFECT_ALL);
    effects_release(&again);

    e.layers[1].keys[0].value[0] = NAN;
    assert_int_equal(effects_write(&e, path, &prov, &err), ST_DATA);
    assert_err(err, ST_DATA, "layer 2 of 2");
    struct err more = ERR_INIT; /* the old file is still there */
    assert_ok(effects_read(&again, path, NULL, &more), more);
    effects_release(&again);
    effects_release(&e);
}

static void written_boxes_give_the_same_bytes(void **state)
{
    (void)state;
    static const char text[] = "remodel-effects 1\n"
                               "layer a brightness\n"
                               "region inside -1 -2 -3 1 2 3 0.25\n"
                               "region inside -1 -2 -3 1 2 3 0.5 axes 0.25 -7 0.5 1000 at 0.5\n"
                               "region inside -1 -2 -3 1 2 3 0 axes 1 0 0 0 at 2\n"
                               "region inside 0 0 0 0 0 0 1000000000 at 1000000\n"
                               "curve cubic\n"
                               "key 0 1\n"
                               "layer b saturation\n"
                               "region outside 0 0 0 1 1 1 0 axes 0 0 0 -1 at 4\n"
                               "key 0 0\n";
    struct effects e;
    struct err err = ERR_INIT;
    const char *path = scratch_path("again.txt");

    read_text(&e, text);
    assert_ok(effects_write(&e, path, NULL, &err), err);
    assert_file_text(path, text);

    for (int i = 0; i < 6; i++) { /* what cannot be read is not written */
        struct effect_box *b = &e.layers[0].boxes[i < 4 ? 1 : 0], good = *b;
        if (i == 0) b->time = 0;
        if (i == 1) b->box_from_world = (struct quat){0, 1e-9, 0, 0};
        if (i == 2) b->box_from_world.x = NAN;
        if (i == 3) b->high.y = -2.5;
        if (i == 4) e.layers[0].region = EFFECT_ALL;
        if (i == 5) e.layers[0].box_count = 0;
        err = (struct err)ERR_INIT;
        assert_int_equal(effects_write(&e, path, NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, "cannot write layer 1 of 2");
        *b = good;
        e.layers[0].region = EFFECT_INSIDE;
        e.layers[0].box_count = 4;
    }
    assert_file_text(path, text);
    effects_release(&e);
}

static void a_cubic_is_smooth_and_stays_between_its_keys(void **state)
{
    (void)state;
    static const double at[] = {1, 2, 4, 4.5, 7}, want[] = {0.5, 1.5, 1, 1, 1};
    struct effects e, again;
    struct err err = ERR_INIT;
    double value[3], before = 0;
    const char *path = scratch_path("cubic.txt");

    read_text(&e, "remodel-effects 1\nlayer a brightness\nregion all\ncurve cubic\n"
                  "key 1 0.5\nkey 2 1.5\nkey 4 1\nkey 4.5 1\nkey 7 1\n");
    assert_ok(effects_write(&e, path, NULL, &err), err);
    assert_ok(effects_read(&again, path, NULL, &err), err);
    assert_int_equal(again.layers[0].curve, EFFECT_CUBIC);
    for (int i = 0; i < 5; i++) {
        double step[2];
        effect_layer_value(&again.layers[0], at[i], value);
        assert_true(value[0] == want[i]);
        for (int k = 0; k < 2; k++)
            effect_layer_value(&again.layers[0], at[i] + (k ? 1e-6 : -1e-6), value), step[k] = value[0];
        assert_true(fabs(step[1] + step[0] - 2 * want[i]) < 1e-11); /* no kink */
    }
    for (int i = 0; i <= 100; i++) {
        effect_layer_value(&e.layers[0], 1 + i / 100.0, value);
        assert_true(value[0] >= before && value[0] >= 0.5 && value[0] <= 1.5);
        before = value[0];
    }
    effects_release(&e);
    effects_release(&again);
}

static void values_are_linear_between_keys(void **state)
{
    (void)state;
    static const double want[][2] = {{-1, 0.5}, {0, 0.5}, {1, 0.5}, {1.5, 1}, {2, 1.5}, {3, 1.25}, {4, 1}, {9, 1}};
    struct effects e;
    double value[3];

    read_text(&e, "remodel-effects 1\nlayer a brightness\nregion all\nkey 1 0.5\nkey 2 1.5\nkey 4 1\n");
    for (size_t i = 0; i < sizeof want / sizeof *want; i++) {
        effect_layer_value(&e.layers[0], want[i][0], value);
        assert_true(fabs(value[0] - want[i][1]) < 1e-15);
    }
    effects_release(&e);
}

static void layers_match_their_formulas(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "layer a brightness\nregion inside 0.5 0.05 1.4 1.4 0.35 2.1 0.2\nkey 0 3\n",
        "layer a brightness\nregion outside 0.5 0.05 1.4 1.4 0.35 2.1 0.05\nkey 0 0\n",
        "layer a color\nregion inside 0.51 0.06 1.41 1.41 0.36 2.11 0\nkey 0 0.5 2 1\n",
        "layer a color\nregion all\nkey 0 0.5 2 1\n",
        "layer a saturation\nregion outside 0.5 0.05 1.4 1.4 0.35 2.1 0.3\nkey 0 0\n",
        "layer a saturation\nregion inside 0.5 0.05 1.4 1.4 0.35 2.1 0.3\nkey 0 2.5\n",
        "layer a brightness\nregion inside 0.5 0.05 1.4 1.4 0.35 2.1 0.2 axes 9 1 -2 3\nkey 0 3\n",
        "layer a color\nregion inside 0.5 0.06 1.41 1.41 0.36 2.11 0 axes 0.3 0.1 0.4 0.2\nkey 0 0.5 2 1\n",
        "layer a saturation\nregion outside 0.5 0.05 1.4 1.4 0.35 2.1 0.3 axes 0.9 0 -0.4 0 at 7\nkey 0 0\n",
    };
    const struct view v = a_camera();
    struct rendered_frame before = {0}, f = {0};

    make_frame(&before);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char text[256];
        struct effects e;
        int whole = 0, none = 0;
        snprintf(text, sizeof text, "remodel-effects 1\n%s", texts[i]);
        read_text(&e, text);
        make_frame(&f);
        effects_apply(&e, 0, &v, &f);
        for (int p = 0; p < W * H; p++) {
            const struct effect_layer *l = &e.layers[0];
            const float *c = before.rgba + 4 * p, *d = f.rgba + 4 * p;
            const double w = weight_at(&v, l, p % W, p / W, f.z[p]), y = luminance(c);
            const double darkest = fmin(c[0], fmin(c[1], c[2]));
            double s = w * (l->keys[0].value[0] - 1);
            if (s * (y - darkest) > darkest) s = darkest / (y - darkest);
            whole += w == 1;
            none += w < 1e-9;
            for (int k = 0; k < 3; k++) {
                const double factor = l->keys[0].value[l->kind == EFFECT_COLOR ? k : 0];
                const double want =
                    l->kind == EFFECT_SATURATION ? c[k] + s * (c[k] - y) : c[k] * (1 + w * (factor - 1));
                assert_true(fabs(d[k] - want) < 3e-6 * (1 + fabs(want)) && d[k] >= 0);
            }
            assert_true(d[3] == 1);
            if (l->kind == EFFECT_SATURATION) assert_true(fabs(luminance(d) - y) < 1e-6 * (1 + y));
        }
        assert_true(whole > 20 && (none > 20 || strstr(text, "all")));
        effects_release(&e);
    }
    rendered_frame_release(&before);
    rendered_frame_release(&f);
}

/* A white frame of the plane z = 2, seen from the origin: pixels are 0.01 apart there. */
#define SIDE 401
static void look_at_plane(struct view *v, struct rendered_frame *f)
{
    struct err err = ERR_INIT;
    *v = (struct view){.name = "0001", .width = SIDE, .height = SIDE, .fx = 200, .fy = 200, .cx = SIDE / 2.0};
    v->cy = v->cx;
    v->cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    assert_ok(rendered_frame_resize(f, SIDE, SIDE, true, &err), err);
    for (int i = 0; i < SIDE * SIDE; i++) {
        for (int k = 0; k < 4; k++) f->rgba[4 * i + k] = 1;
        f->z[i] = 2;
    }
}

/* The weight at the point (x, y, 2) of an applied layer that sets brightness to 0. */
static double weight_on_plane(const struct rendered_frame *f, double x, double y)
{
    const int at = (int)lround(100 * x) + SIDE / 2 + SIDE * ((int)lround(100 * y) + SIDE / 2);
    return 1 - f->rgba[4 * at];
}

static void a_box_turned_45_degrees_ends_at_its_sides(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "remodel-effects 1\nlayer a brightness\n"
        "region inside -1 -1 1 1 1 3 0 axes 0.92387953251128674 0 0 0.38268343236508977\nkey 0 0\n",
        "remodel-effects 1\nlayer a brightness\n"
        "region inside -1 -1 1 1 1 3 0.1 axes 0.92387953251128674 0 0 0.38268343236508977\nkey 0 0\n"};
    struct rendered_frame f = {0};
    struct effects e;
    struct view v;

    for (int soft = 0; soft < 2; soft++) {
        read_text(&e, texts[soft]);
        look_at_plane(&v, &f);
        effects_apply(&e, 0, &v, &f);
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double x = abs(i % SIDE - SIDE / 2) / 100.0, y = abs(i / SIDE - SIDE / 2) / 100.0;
            const double beyond = (x + y) / sqrt(2) - 1, w = 1 - f.rgba[4 * i]; /* a square on its corner */
            if (fabs(beyond) < 1e-5) continue;
            if (beyond < 0) assert_true(w == 1);
            if (beyond > (soft ? 0.6 : 0)) assert_true(w == 0);
            if (soft && beyond > 0 && fabs(x - y) < 1) /* beside a side, not a corner */
                assert_true(fabs(w - exp(-beyond * beyond / 0.02)) < 1e-5);
        }
        /* a corner of the box along the world's axes stays as it was; the turned box's own corner does not */
        assert_true(weight_on_plane(&f, 0.99, -0.99) < (soft ? 1e-3 : 1e-9));
        assert_true(weight_on_plane(&f, 0, 1.41) == 1 && weight_on_plane(&f, -1.41, 0) == 1);
        effects_release(&e);
    }
    rendered_frame_release(&f);
}

static void a_box_turns_as_its_axes_say(void **state)
{
    (void)state;
    struct rendered_frame f = {0};
    struct effects e;
    struct view v;

    /* box_from_world turns +y to +x by 30 degrees, so the long axis of the box is (cos 30, sin 30) */
    read_text(&e, "remodel-effects 1\nlayer a brightness\n"
                  "region inside -0.5 0 1 1.5 0.4 3 0 axes 0.96592582628906829 0 0 -0.25881904510252076\nkey 0 0\n");
    look_at_plane(&v, &f);
    effects_apply(&e, 0, &v, &f);
    for (int i = -9; i <= 9; i++) { /* the middle is (0.5, 0.2), the halves of the size 1 and 0.2 */
        const double x = 0.5 + i * 0.1 * cos(M_PI / 6), y = 0.2 + i * 0.1 * sin(M_PI / 6);
        assert_true(weight_on_plane(&f, x, y) == 1);
        if (abs(i) != 4) /* 0.2 / sin 30 degrees = 0.4 */
            assert_true((weight_on_plane(&f, 0.5 + i * 0.1, 0.2) == 1) == (abs(i) < 4));
    }
    effects_release(&e);
    rendered_frame_release(&f);
}

static void a_keyed_box_moves_and_softens(void **state)
{
    (void)state;
    static const double at[] = {-1, 1, 2, 3, 9};
    struct rendered_frame f = {0};
    struct effects e;
    struct view v;

    read_text(&e, "remodel-effects 1\nlayer a brightness\n"
                  "region inside -1.5 -0.5 1 -0.5 0.5 3 0 at 1\n"
                  "region inside 0.5 -0.5 1 1.5 0.5 3 0.4 axes 1 0 0 1 at 3\nkey 0 0\n");
    for (int i = 0; i < 5; i++) {
        look_at_plane(&v, &f);
        effects_apply(&e, at[i], &v, &f);
        if (i < 2) { /* before and at the first: a hard square around (-1, 0) */
            assert_true(weight_on_plane(&f, -0.51, 0.49) == 1 && weight_on_plane(&f, -1.49, -0.49) == 1);
            assert_true(weight_on_plane(&f, -0.49, 0) == 0 && weight_on_plane(&f, -1, 0.51) == 0);
        } else if (i == 2) { /* halfway: in the middle, turned 45 degrees, fall-off 0.2 */
            assert_true(weight_on_plane(&f, 0, 0.7) == 1 && weight_on_plane(&f, -0.7, 0) == 1);
            const double beyond = 1 / sqrt(2) - 0.5;
            assert_true(fabs(weight_on_plane(&f, 0.5, 0.5) - exp(-beyond * beyond / 0.08)) < 1e-5);
        } else { /* at the last and after: a square around (1, 0), turned 90 degrees, fall-off 0.4 */
            assert_true(weight_on_plane(&f, 0.51, 0.49) == 1 && weight_on_plane(&f, 1.49, -0.49) == 1);
            assert_true(fabs(weight_on_plane(&f, 0, 0.2) - exp(-0.25 / 0.32)) < 1e-5);
        }
    }
    effects_release(&e);
    rendered_frame_release(&f);
}

static void the_smallest_fall_off_is_a_hard_edge(void **state)
{
    (void)state;
    struct rendered_frame f = {0};
    struct effects e;
    struct view v;

    read_text(&e, "remodel-effects 1\nlayer a brightness\nregion inside -1 -1 1 1 1 3 1e-300\nkey 0 0\n");
    look_at_plane(&v, &f);
    effects_apply(&e, 0, &v, &f);
    assert_true(weight_on_plane(&f, 0.99, 0.99) == 1 && weight_on_plane(&f, 1.01, 0) == 0);
    effects_release(&e);
    rendered_frame_release(&f);
}

/* Applies the layers of a file's text to a frame. */
static void apply_text(const char *text, double time, struct rendered_frame *f)
{
    const struct view v = a_camera();
    struct effects e;
    read_text(&e, text);
    effects_apply(&e, time, &v, f);
    effects_release(&e);
}

static void layers_are_applied_in_order(void **state)
{
    (void)state;
    struct rendered_frame f = {0}, g = {0};

    make_frame(&f);
    make_frame(&g);
    apply_text("remodel-effects 1\nlayer tint color\nregion all\nkey 0 2 1 0.5\n"
               "layer grey saturation\nregion all\nkey 0 0\n",
               0, &f);
    for (int p = 0; p < W * H; p++) { /* tinted first, then grey: equal channels */
        const float c[3] = {2 * g.rgba[4 * p], g.rgba[4 * p + 1], 0.5f * g.rgba[4 * p + 2]};
        for (int k = 0; k < 3; k++) assert_true(fabs(f.rgba[4 * p + k] - luminance(c)) < 1e-6);
    }
    rendered_frame_release(&f);
    rendered_frame_release(&g);
}

static void identity_layers_change_no_bit(void **state)
{
    (void)state;
    static const char layers[] = "remodel-effects 1\nlayer a saturation\nregion all\nkey 1 1\nkey 2 0\n"
                                 "layer b color\nregion inside -9 -9 -9 9 9 9 1\nkey 0 1 1 1\nkey 1 1 1 1\n"
                                 "layer c brightness\nregion outside -9 -9 -9 9 9 9 1\nkey 1 1\n";
    static const char far_away[] = "remodel-effects 1\nlayer a color\nregion inside 50 50 50 60 60 60 1\nkey 0 2 3 4\n"
                                   "layer b saturation\nregion inside 50 50 50 60 60 60 1\nkey 0 0\n";
    const struct view v = a_camera();
    struct rendered_frame f = {0}, g = {0};

    make_frame(&f);
    make_frame(&g);
    effects_apply(&(struct effects){0}, 0, &v, &f);
    apply_text(layers, 0.9, &f);
    apply_text(far_away, 0, &f);
    assert_memory_equal(f.rgba, g.rgba, W * H * 4 * sizeof(float));
    apply_text(layers, 1.1, &f);
    assert_memory_not_equal(f.rgba, g.rgba, W * H * 4 * sizeof(float));
    rendered_frame_release(&f);
    rendered_frame_release(&g);
}

static void extreme_depths_and_colours_stay_finite(void **state)
{
    (void)state;
    static const float depths[] = {0, -1, 1e-40f, 1e-10f, 1e8f, 1e30f, INFINITY, NAN};
    const struct view v = a_camera();
    struct rendered_frame f = {0};
    struct effects e;

    make_frame(&f);
    for (int p = 0; p < W * H; p++) {
        f.z[p] = depths[p % 8];
        f.rgba[4 * p + p % 3] = p % 5 ? 60000 : 0;
        f.rgba[4 * p + (p + 1) % 3] = p % 7 ? 0 : 1e-30f;
    }
    read_text(&e, "remodel-effects 1\nlayer a saturation\nregion outside -1 -1 -1 1 1 1 1e-9\nkey 0 100\n"
                  "layer b color\nregion inside -1 -1 -1 1 1 1 1e9\nkey 0 100 0 1\n"
                  "layer c saturation\nregion all\nkey 0 30\n");
    effects_apply(&e, 0, &v, &f);
    for (int i = 0; i < 4 * W * H; i++) assert_true(f.rgba[i] >= 0 && isfinite(f.rgba[i]));
    effects_release(&e);
    rendered_frame_release(&f);
}

static void any_thread_count_gives_the_same_bits(void **state)
{
    (void)state;
    const struct view v = a_camera();
    const int threads = parallel_threads();
    struct rendered_frame f[2] = {{0}};
    struct effects e;

    read_text(&e, "remodel-effects 1\nlayer a saturation\nregion outside 0.5 0.05 1.4 1.4 0.35 2.1 0.3 axes 5 1 2 3\n"
                  "region outside 0 0 1 1 1 2 0.5 at 3\nkey 0 0\n");
    for (int i = 0; i < 2; i++) {
        parallel_set_threads(1 + 2 * i);
        make_frame(&f[i]);
        effects_apply(&e, 1.1, &v, &f[i]);
    }
    parallel_set_threads(threads);
    assert_memory_equal(f[0].rgba, f[1].rgba, W * H * 4 * sizeof(float));
    effects_release(&e);
    for (int i = 0; i < 2; i++) rendered_frame_release(&f[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_is_read),
        cmocka_unit_test(boxes_with_axes_and_times_are_read),
        cmocka_unit_test(bad_files_are_refused_with_file_and_line),
        cmocka_unit_test(a_written_file_reads_back_the_same),
        cmocka_unit_test(written_boxes_give_the_same_bytes),
        cmocka_unit_test(values_are_linear_between_keys),
        cmocka_unit_test(a_cubic_is_smooth_and_stays_between_its_keys),
        cmocka_unit_test(layers_match_their_formulas),
        cmocka_unit_test(a_box_turned_45_degrees_ends_at_its_sides),
        cmocka_unit_test(a_box_turns_as_its_axes_say),
        cmocka_unit_test(a_keyed_box_moves_and_softens),
        cmocka_unit_test(the_smallest_fall_off_is_a_hard_edge),
        cmocka_unit_test(layers_are_applied_in_order),
        cmocka_unit_test(identity_layers_change_no_bit),
        cmocka_unit_test(extreme_depths_and_colours_stay_finite),
        cmocka_unit_test(any_thread_count_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
