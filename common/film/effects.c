/* effects.c - effect layers: reading, writing, applying.
 *
 * Effects of [Colburn 2014, 3.6.1]: the weight of a box is the Gaussian of the distance to its surface. Unlike the
 * thesis, saturation is limited per pixel so that no channel becomes negative, and layers work on scene-linear colour.
 *
 * Applying is vectorised over strips of a row. A pixel's position relative to the box is depth * ray, linear in x and
 * y, so each axis costs one multiplication and one addition. The box's place and axes at the frame's time are part of
 * the ray, which is prepared once per frame: a box that turns or moves costs as much as one that does not. */
#include "common/film/effects.h"

#include <assert.h>
#include <ctype.h>
#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/image/luminance.h"
#include "common/math/lanes.h"
#include "common/product/product.h"

#define MAX_KEYS   100000
#define MAX_NAME   64
#define MAX_VALUE  100.0
#define MAX_TIME   1e6
#define MIN_LENGTH 1e-6 /* of a quaternion */

static const char *const kind_names[] = {"saturation", "brightness", "color"};
static const char *const region_names[] = {"all", "inside", "outside"};
static const char *const curve_names[] = {"linear", "cubic"};

static bool name_is_valid(const char *name)
{
    for (const char *c = name; *c; c++)
        if (iscntrl((unsigned char)*c)) return false;
    return *name && strlen(name) <= MAX_NAME;
}

static int value_count(enum effect_kind kind) { return kind == EFFECT_COLOR ? 3 : 1; }

static double quat_length(struct quat q) { return sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z); }

enum status effects_append(struct effects *e, struct effects *from, struct err *err)
{
    const int count = e->layer_count + from->layer_count;
    if (!from->layer_count) return ST_OK;
    if (count > MAX_EFFECT_LAYERS)
        return err_set(err, ST_DATA, "found %d effect layers for one film, at most %d are allowed; remove some.", count,
                       MAX_EFFECT_LAYERS);
    for (int i = e->layer_count; i < count; i++) /* makes room */
        if (array_append(&e->layers, (size_t)i, sizeof *e->layers, "effect layers", err)) return err->status;
    memcpy(e->layers + e->layer_count, from->layers, (size_t)from->layer_count * sizeof *e->layers);
    e->layer_count = count;
    free(from->layers);
    *from = (struct effects){0};
    return ST_OK;
}

void effects_release(struct effects *e)
{
    if (!e) return;
    for (int i = 0; i < e->layer_count; i++) effect_layer_release(&e->layers[i]);
    free(e->layers);
    *e = (struct effects){0};
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_word(struct textfile *t, const char *what, const char *const names[3], int *which,
                             struct err *err)
{
    char *word;
    if (textfile_word(t, what, &word, err)) return err->status;
    for (*which = 0; *which < 3; ++*which)
        if (!strcmp(word, names[*which])) return ST_OK;
    return textfile_error(t, err, word, "%s: %s, %s or %s", what, names[0], names[1], names[2]);
}

/* The line that the last layer still needs; NULL if it is complete. */
static const char *missing_line(const struct effects *e, bool has_region)
{
    if (!e->layer_count) return NULL;
    if (!has_region) return "region";
    return e->layers[e->layer_count - 1].key_count ? NULL : "key";
}

static enum status read_layer(struct textfile *t, struct effects *e, bool has_region, struct err *err)
{
    const char *missing = missing_line(e, has_region);
    char *name;
    int kind = 0;

    if (missing)
        return textfile_error(t, err, "layer", "a %s of the layer %s", missing, e->layers[e->layer_count - 1].name);
    if (textfile_word(t, "the layer's name", &name, err)) return err->status;
    if (!name_is_valid(name)) return textfile_error(t, err, name, "a name of 1 to %d printable characters", MAX_NAME);
    for (int i = 0; i < e->layer_count; i++)
        if (!strcmp(e->layers[i].name, name)) return textfile_error(t, err, name, "a name that no other layer has");
    if (e->layer_count == MAX_EFFECT_LAYERS)
        return textfile_error(t, err, name, "the end of the file, after %d layers", MAX_EFFECT_LAYERS);
    if (read_word(t, "what the layer changes", kind_names, &kind, err) || textfile_end(t, err)) return err->status;

    if (array_append(&e->layers, (size_t)e->layer_count, sizeof *e->layers, "effect layers", err)) return err->status;
    char *copy = strdup(name);
    if (!copy) return err_nomem(err, "a layer's name", strlen(name) + 1);
    e->layers[e->layer_count++] = (struct effect_layer){.name = copy, .kind = (enum effect_kind)kind};
    return ST_OK;
}

static enum status read_axes(struct textfile *t, struct quat *q, struct err *err)
{
    static const char *const names[] = {"qw", "qx", "qy", "qz"};
    double *const to[] = {&q->w, &q->x, &q->y, &q->z};

    for (int i = 0; i < 4; i++)
        if (textfile_number(t, names[i], -MAX_EFFECT_COORDINATE, MAX_EFFECT_COORDINATE, to[i], err)) return err->status;
    if (quat_length(*q) > MIN_LENGTH) return ST_OK;
    return textfile_error(t, err, "a quaternion of length 0", "one of length 1: qw qx qy qz");
}

/* Reads what may follow a box's fall-off. previous: the layer's box before this one; NULL: none. */
static enum status read_box_options(struct textfile *t, struct effect_box *box, const struct effect_box *previous,
                                    struct err *err)
{
    bool has_axes = false, has_time = false;
    char *word;

    while (!err->status && textfile_more(t)) {
        if (textfile_word(t, "axes or at", &word, err)) break;
        if (!has_axes && !strcmp(word, "axes")) {
            read_axes(t, &box->box_from_world, err);
            has_axes = true;
        } else if (!has_time && !strcmp(word, "at")) {
            textfile_number(t, "a time", 0, MAX_TIME, &box->time, err);
            has_time = true;
        } else {
            textfile_error(t, err, word, "axes QW QX QY QZ, at TIME (each once) or the end of the line");
        }
    }
    if (err->status || !previous || box->time > previous->time) return err->status;
    if (!has_time)
        return textfile_error(t, err, NULL, "at TIME, after %.9g, that of the previous region", previous->time);
    char found[32];
    snprintf(found, sizeof found, "at %.9g", box->time);
    return textfile_error(t, err, found, "a time after %.9g, that of the previous region", previous->time);
}

static enum status read_region(struct textfile *t, struct effect_layer *l, struct err *err)
{
    static const char *const corners[] = {"x0", "y0", "z0", "x1", "y1", "z1"};
    struct effect_box box = {0};
    double *const to[] = {&box.low.x, &box.low.y, &box.low.z, &box.high.x, &box.high.y, &box.high.z};
    int region = 0;
    if (read_word(t, "a region", region_names, &region, err)) return err->status;
    if (l->box_count && l->region != (enum effect_region)region)
        return textfile_error(t, err, region_names[region], "%s, as the layer's first region", region_names[l->region]);
    l->region = (enum effect_region)region;
    if (l->region == EFFECT_ALL) return ST_OK;
    for (int i = 0; !err->status && i < 6; i++)
        textfile_number(t, corners[i], i < 3 ? -MAX_EFFECT_COORDINATE : *to[i - 3], MAX_EFFECT_COORDINATE, to[i], err);
    if (!err->status && !textfile_number(t, "the fall-off", 0, MAX_EFFECT_COORDINATE, &box.falloff, err))
        read_box_options(t, &box, l->box_count ? &l->boxes[l->box_count - 1] : NULL, err);
    if (err->status) return err->status;
    if (l->box_count == MAX_KEYS) return textfile_error(t, err, "region", "at most %d regions in a layer", MAX_KEYS);
    if (array_append(&l->boxes, (size_t)l->box_count, sizeof *l->boxes, "regions of a layer", err)) return err->status;
    box.time += 0.0; /* -0 becomes 0, which is written as no time */
    l->boxes[l->box_count++] = box;
    return ST_OK;
}

static enum status read_curve(struct textfile *t, struct effect_layer *l, struct err *err)
{
    char *word;
    if (textfile_word(t, "linear or cubic", &word, err)) return err->status;
    if (!strcmp(word, curve_names[EFFECT_LINEAR])) return ST_OK;
    l->curve = EFFECT_CUBIC;
    return strcmp(word, curve_names[EFFECT_CUBIC]) ? textfile_error(t, err, word, "linear or cubic") : ST_OK;
}

static enum status read_key(struct textfile *t, struct effect_layer *l, struct err *err)
{
    static const char *const colors[] = {"red", "green", "blue"};
    const int values = value_count(l->kind);
    struct effect_key key = {0};
    char *word;
    if (textfile_word(t, "a time in seconds", &word, err)) return err->status;
    if (textfile_number_of(t, word, "a time", 0, MAX_TIME, &key.time, err)) return err->status;
    if (l->key_count && !(key.time > l->keys[l->key_count - 1].time))
        return textfile_error(t, err, word, "a time after %.9g, that of the previous key",
                              l->keys[l->key_count - 1].time);
    for (int i = 0; !err->status && i < values; i++)
        textfile_number(t, values == 1 ? kind_names[l->kind] : colors[i], 0, MAX_VALUE, &key.value[i], err);
    if (err->status) return err->status;
    if (l->key_count == MAX_KEYS) return textfile_error(t, err, word, "at most %d keys in a layer", MAX_KEYS);
    if (array_append(&l->keys, (size_t)l->key_count, sizeof *l->keys, "keys of a layer", err)) return err->status;
    l->keys[l->key_count++] = key;
    return ST_OK;
}

enum status effects_read_layers(struct effects *e, struct textfile *t, struct err *err)
{
    bool has_region = false;

    *e = (struct effects){0};
    while (!err->status && textfile_next(t)) {
        struct effect_layer *l = e->layer_count ? &e->layers[e->layer_count - 1] : NULL;
        char *word;
        /* a box may be followed by more of them, up to the curve or the first key */
        const bool more = has_region && l->region != EFFECT_ALL && l->curve == EFFECT_LINEAR && !l->key_count;
        if (textfile_word(t, "layer, region, curve or key", &word, err)) break;
        if (!strcmp(word, "layer")) {
            read_layer(t, e, has_region, err);
            has_region = false;
        } else if (l && (!has_region || more) && !strcmp(word, "region")) {
            read_region(t, l, err);
            has_region = true;
        } else if (l && has_region && !l->key_count && l->curve == EFFECT_LINEAR && !strcmp(word, "curve")) {
            read_curve(t, l, err);
        } else if (l && has_region && !strcmp(word, "key")) {
            read_key(t, l, err);
        } else {
            textfile_error(t, err, word,
                           !l            ? "layer"
                           : !has_region ? "region"
                           : more        ? "region, curve, key or layer"
                                         : "key or layer");
        }
        if (!err->status) textfile_end(t, err);
    }
    const char *missing = missing_line(e, has_region);
    if (!err->status && missing)
        err_set(err, ST_DATA, "%s:%d: found the end of the file, wanted a %s of the layer %s.", t->path, t->line,
                missing, e->layers[e->layer_count - 1].name);
    if (err->status) effects_release(e);
    return err->status;
}

enum status effects_read(struct effects *e, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};

    *e = (struct effects){0};
    if (!product_open(&t, NULL, PRODUCT_EFFECTS, path, prov, err)) effects_read_layers(e, &t, err);
    textfile_release(&t);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static bool within(double value, double min, double max) { return value >= min && value <= max; }

static bool box_is_valid(const struct effect_box *b)
{
    const struct quat q = b->box_from_world;
    const double numbers[] = {b->low.x, b->low.y, b->low.z, b->high.x, b->high.y, b->high.z, q.w, q.x, q.y, q.z};
    bool valid = within(b->time, 0, MAX_TIME) && within(b->falloff, 0, MAX_EFFECT_COORDINATE);

    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        valid = valid && within(numbers[i], -MAX_EFFECT_COORDINATE, MAX_EFFECT_COORDINATE);
    return valid && b->low.x <= b->high.x && b->low.y <= b->high.y && b->low.z <= b->high.z &&
           (!effect_box_is_turned(b) || quat_length(q) > MIN_LENGTH);
}

/* Whether effects_read would accept this layer. */
static bool layer_is_valid(const struct effects *e, int index)
{
    const struct effect_layer *l = &e->layers[index];
    bool valid = l->name && name_is_valid(l->name) && within(l->key_count, 1, MAX_KEYS);

    for (int i = 0; valid && i < index; i++) valid = strcmp(e->layers[i].name, l->name) != 0;
    valid = valid && (l->region == EFFECT_ALL ? !l->box_count : within(l->box_count, 1, MAX_KEYS));
    for (int i = 0; valid && i < l->box_count; i++)
        valid = box_is_valid(&l->boxes[i]) && (!i || l->boxes[i].time > l->boxes[i - 1].time);
    for (int i = 0; valid && i < l->key_count; i++) {
        valid = within(l->keys[i].time, 0, MAX_TIME) && (!i || l->keys[i].time > l->keys[i - 1].time);
        for (int k = 0; k < value_count(l->kind); k++) valid = valid && within(l->keys[i].value[k], 0, MAX_VALUE);
    }
    return valid;
}

static void write_box(const struct effect_box *b, const char *region, FILE *to)
{
    const struct quat q = b->box_from_world;
    fprintf(to, "region %s %.17g %.17g %.17g %.17g %.17g %.17g %.17g", region, b->low.x, b->low.y, b->low.z, b->high.x,
            b->high.y, b->high.z, b->falloff);
    if (effect_box_is_turned(b)) fprintf(to, " axes %.17g %.17g %.17g %.17g", q.w, q.x, q.y, q.z);
    if (b->time > 0) fprintf(to, " at %.17g", b->time);
    fprintf(to, "\n");
}

static void write_layer(const struct effect_layer *l, const char *name, FILE *to)
{
    fprintf(to, "layer %s %s\n", name, kind_names[l->kind]);
    if (l->region == EFFECT_ALL) fprintf(to, "region all\n");
    for (int i = 0; i < l->box_count; i++) write_box(&l->boxes[i], region_names[l->region], to);
    if (l->curve != EFFECT_LINEAR) fprintf(to, "curve %s\n", curve_names[l->curve]);
    for (int i = 0; i < l->key_count; i++) {
        fprintf(to, "key %.17g", l->keys[i].time);
        for (int k = 0; k < value_count(l->kind); k++) fprintf(to, " %.17g", l->keys[i].value[k]);
        fprintf(to, "\n");
    }
}

enum status effects_write(const struct effects *e, const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};

    if (e->layer_count > MAX_EFFECT_LAYERS)
        return err_set(err, ST_DATA, "%s: cannot write %d effect layers, at most %d are allowed.", path, e->layer_count,
                       MAX_EFFECT_LAYERS);
    for (int i = 0; i < e->layer_count; i++)
        if (!layer_is_valid(e, i))
            return err_set(
                err, ST_DATA,
                "%s: cannot write layer %d of %d: its name is invalid or taken, or a number is out of range.", path,
                i + 1, e->layer_count);
    if (product_begin(&f, PRODUCT_EFFECTS, path, prov, err)) return err->status;
    const locale_t before = uselocale(scan_c_locale());
    for (int i = 0; !err->status && i < e->layer_count; i++) {
        char name[2 * MAX_NAME + 3];
        if (!textfile_quote(e->layers[i].name, name, sizeof name, err)) write_layer(&e->layers[i], name, f.fp);
    }
    uselocale(before);
    if (!err->status) return outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- applying */

#define STRIP        64   /* pixels of a row processed together */
#define MAX_DEPTH    1e9f /* depths beyond this are outside every box */
#define MAX_EXPONENT 16   /* exp(-x) beyond this counts as 0: about 1e-7, below the precision of half floats */

struct active_layer { /* a layer at one time, prepared for one camera */
    const struct effect_layer *layer;
    float change[3];  /* value - 1 */
    double center[3]; /* the camera's centre relative to the box's, along the box's axes */
    double ray[3][3]; /* likewise: steps of a pixel's ray in x and in y, and the ray of pixel (0, 0), at depth 1 */
    double half[3];   /* half the box's size */
    float per_square; /* -1 / (2 falloff^2 ln 2): exponent of 2 per squared distance; 0 for a hard edge */
};

struct effects_pass {
    const struct active_layer *layers;
    int count;
    struct rendered_frame *frame;
};

static struct active_layer prepare_layer(const struct effect_layer *l, const double value[3], double time,
                                         const struct view *v)
{
    struct active_layer a = {.layer = l};
    struct effect_box box;

    for (int k = 0; k < 3; k++) a.change[k] = (float)(value[l->kind == EFFECT_COLOR ? k : 0] - 1);
    if (l->region == EFFECT_ALL) return a;
    effect_layer_box(l, time, &box);
    const bool turned = effect_box_is_turned(&box);
    const struct mat3 box_from_world = mat3_from_quat(turned ? box.box_from_world : (struct quat){1, 0, 0, 0});
    /* columns: the camera's axes along the box's */
    const struct mat3 r = mat3_multiply(box_from_world, mat3_transpose(v->cam_from_world));
    const struct vec3 half = vec3_scale(vec3_sub(box.high, box.low), 0.5);
    const struct vec3 at = mat3_apply(box_from_world, vec3_sub(v->center, vec3_add(box.low, half)));
    const double halves[] = {half.x, half.y, half.z}, center[] = {at.x, at.y, at.z};
    for (int k = 0; k < 3; k++) {
        a.half[k] = halves[k];
        a.center[k] = center[k];
        a.ray[0][k] = r.m[k][0] / v->fx;
        a.ray[1][k] = r.m[k][1] / v->fy;
        a.ray[2][k] = r.m[k][2] + (0.5 - v->cx) * a.ray[0][k] + (0.5 - v->cy) * a.ray[1][k];
    }
    /* finite, so that it is 0 at distance 0 for the smallest fall-off too */
    if (box.falloff > 0) a.per_square = (float)fmax(-1 / (2 * box.falloff * box.falloff * M_LN2), -FLT_MAX);
    return a;
}

/* 2^x for -30 < x <= 0, with an error below 2e-7. */
static inline f32x8 exp2_of(f32x8 x)
{
    const i32x8 whole = i32x8_truncate(x - 0.5f); /* truncation towards 0, so this rounds to the nearest */
    const f32x8 f = (x - f32x8_from_i32(whole)) * (float)M_LN2;
    const f32x8 series =
        1 + f * (1 + f * (1 / 2.0f + f * (1 / 6.0f + f * (1 / 24.0f + f * (1 / 120.0f + f / 720.0f)))));
    return series * (f32x8)((whole + 127) << 23);
}

/* Weights of a strip of a row from its depths. */
static void strip_weights(float *weights, const struct active_layer *a, const float *z, int x, int y, int count)
{
    const bool outside = a->layer->region == EFFECT_OUTSIDE;
    const f32x8 step = {0, 1, 2, 3, 4, 5, 6, 7};
    float start[3];

    for (int k = 0; k < 3; k++) start[k] = (float)(a->ray[2][k] + y * a->ray[1][k] + x * a->ray[0][k]);
    for (int i = 0; i < count; i += 8) {
        f32x8 depth, square = {0};
        memcpy(&depth, z + i, sizeof depth);
        const i32x8 known = (depth > 0) & (depth < MAX_DEPTH);
        for (int k = 0; k < 3; k++) {
            const f32x8 at = (float)a->center[k] + depth * (start[k] + ((float)i + step) * (float)a->ray[0][k]);
            const f32x8 beyond = f32x8_abs(at) - (float)a->half[k];
            const f32x8 d = f32x8_where(beyond > 0, beyond);
            square += d * d;
        }
        f32x8 exponent = square * a->per_square;
        /* a hard edge has exponent 0 everywhere: the distance alone decides */
        const i32x8 affected =
            known & (a->per_square < 0 ? exponent > -(float)MAX_EXPONENT / (float)M_LN2 : square == 0);
        exponent = f32x8_where(affected, exponent);
        const f32x8 inside = f32x8_where(affected, exp2_of(exponent)), weight = outside ? 1 - inside : inside;
        memcpy(weights + i, &weight, sizeof weight);
    }
}

static void strip_scale(float *rgba, const float *weights, const float change[3], int count)
{
    const f32x4 by = {change[0], change[1], change[2], 0};
    for (int i = 0; i < count; i++) {
        f32x4 c;
        memcpy(&c, rgba + 4 * i, sizeof c);
        c *= 1 + weights[i] * by; /* change is not below -1 */
        memcpy(rgba + 4 * i, &c, sizeof c);
    }
}

static void strip_saturate(float *rgba, const float *weights, float change, int count)
{
    for (int i = 0; i < count; i++) {
        float *c = rgba + 4 * i;
        const float y = luminance_of(c);
        const float dark = c[0] < c[1] ? (c[0] < c[2] ? c[0] : c[2]) : (c[1] < c[2] ? c[1] : c[2]);
        float by = weights[i] * change;
        if (by == 0) continue;
        /* keeps dark + by (dark - y) at 0 or above */
        if (by * (y - dark) > dark) by = dark / (y - dark);
        for (int k = 0; k < 3; k++) {
            const float v = c[k] + by * (c[k] - y);
            c[k] = v > 0 ? v : 0;
        }
    }
}

static void effect_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct effects_pass *p = ctx;
    const int w = p->frame->width;
    (void)thread;

    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < w; x += STRIP) {
            const int count = w - x < STRIP ? w - x : STRIP;
            const size_t at = (size_t)y * (size_t)w + (size_t)x;
            float weights[STRIP], z[STRIP] = {0};
            memcpy(z, p->frame->z + at, (size_t)count * sizeof *z);
            for (int i = 0; i < p->count; i++) {
                const struct active_layer *a = &p->layers[i];
                if (a->layer->region == EFFECT_ALL)
                    for (int k = 0; k < STRIP; k++) weights[k] = 1;
                else
                    strip_weights(weights, a, z, x, y, count);
                if (a->layer->kind == EFFECT_SATURATION)
                    strip_saturate(p->frame->rgba + 4 * at, weights, a->change[0], count);
                else
                    strip_scale(p->frame->rgba + 4 * at, weights, a->change, count);
            }
        }
}

void effects_apply(const struct effects *e, double time, const struct view *camera, struct rendered_frame *frame)
{
    struct active_layer active[MAX_EFFECT_LAYERS];
    struct effects_pass pass = {active, 0, frame};

    assert(e->layer_count <= MAX_EFFECT_LAYERS);
    for (int i = 0; i < e->layer_count; i++) {
        double value[3];
        effect_layer_value(&e->layers[i], time, value);
        if (value[0] == 1 && (e->layers[i].kind != EFFECT_COLOR || (value[1] == 1 && value[2] == 1))) continue;
        active[pass.count++] = prepare_layer(&e->layers[i], value, time, camera);
    }
    if (pass.count) parallel_for((size_t)frame->height, 16, effect_rows, &pass);
}
