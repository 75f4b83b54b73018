/* keyframed_film.c - a film of keyframed shots and planned moves.
 *
 * Each shot becomes curves over its own time (motion_curves.c) that are sampled at the frames. A planned move is read
 * as one key per frame, so it can be slowed down, reversed and joined like any other shot.
 *
 * Frames: a shot of keys over S seconds has round(S fps) + 1 of them, both ends included; a planned move has its own
 * number; a join of S seconds adds round(S fps) - 1 between the two shots. */
#include "stages/plan_path/keyframed_film.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/math/monotone.h"
#include "common/product/product.h"
#include "stages/plan_path/keyframes.h"
#include "stages/plan_path/motion_curves.h"

enum { MAX_FRAMES = 1000000, MAX_LAYER_KEYS = 50000 };

struct camera_state { /* the film's camera at one time; focal lengths as logarithms */
    struct vec3 position;
    struct quat rotation; /* world_from_cam */
    double lens[LENS_CHANNELS];
};

struct timed_shot {
    int first, frames; /* first frame in the film, number of frames */
    double duration;   /* from the first frame to the last, s */
    struct motion motion;
    struct curve lens[LENS_CHANNELS]; /* without keys: `constant` applies */
    double constant[LENS_CHANNELS];
};

static void timed_shot_release(struct timed_shot *s)
{
    motion_release(&s->motion);
    for (int i = 0; i < LENS_CHANNELS; i++) curve_release(&s->lens[i]);
}

static bool is_focal(int channel) { return channel == LENS_FX || channel == LENS_FY; }

static enum status fit_shot(struct timed_shot *s, const struct film_key *keys, int count,
                            const struct film_settings *film, bool rest, struct err *err)
{
    const struct view *lens = &film->lens;
    const double constant[LENS_CHANNELS] = {log(lens->fx), log(lens->fy), lens->cx, lens->cy, 0, 0};
    if (motion_init(&s->motion, count, err)) return err->status;
    for (int i = 0; i < count; i++) {
        s->motion.distance.time[i] = keys[i].time;
        s->motion.position[i] = keys[i].position;
        s->motion.rotation[i] = keys[i].rotation;
    }
    motion_fit(&s->motion, rest);
    for (int n = 0; n < LENS_CHANNELS; n++) {
        struct curve *c = &s->lens[n];
        s->constant[n] = constant[n];
        if (curve_init(c, count, err)) return err->status;
        c->count = 0;
        for (int i = 0; i < count; i++) {
            if (!keys[i].keyed[n]) continue;
            c->time[c->count] = keys[i].time;
            c->value[c->count++] = is_focal(n) ? log(keys[i].lens[n]) : keys[i].lens[n];
        }
        curve_fit(c, rest);
    }
    return ST_OK;
}

static void shot_at(const struct timed_shot *s, double time, struct camera_state *out)
{
    motion_at(&s->motion, time, &out->position, &out->rotation);
    for (int n = 0; n < LENS_CHANNELS; n++)
        out->lens[n] = s->lens[n].count ? curve_at(&s->lens[n], time) : s->constant[n];
}

/* The last frame shows the last key, even if the key's time is between two frames. */
static double frame_time(const struct timed_shot *s, int frame, double fps)
{
    return frame >= s->frames - 1 ? s->duration : fmin(frame / fps, s->duration);
}

/* The camera at t, 0 to 1, of the join of `seconds` from the end of one shot to the start of the next. */
static void join_at(const struct timed_shot *from, const struct timed_shot *to, double seconds, double t,
                    struct camera_state *out)
{
    struct camera_state a, b;
    struct vec3 va, vb, wa, wb;
    shot_at(from, from->duration, &a);
    shot_at(to, 0, &b);
    motion_rates(&from->motion, true, &va, &wa);
    motion_rates(&to->motion, false, &vb, &wb);
    out->position =
        motion_position_between(a.position, b.position, vec3_scale(va, seconds), vec3_scale(vb, seconds), t);
    out->rotation =
        motion_rotation_between(a.rotation, b.rotation, vec3_scale(wa, seconds), vec3_scale(wb, seconds), t);
    /* a pinhole has no focus: both ends use that of the other shot */
    if (!(a.lens[LENS_FOCUS] > 0)) a.lens[LENS_FOCUS] = b.lens[LENS_FOCUS];
    if (!(b.lens[LENS_FOCUS] > 0)) b.lens[LENS_FOCUS] = a.lens[LENS_FOCUS];
    for (int n = 0; n < LENS_CHANNELS; n++) {
        const struct curve *ca = &from->lens[n], *cb = &to->lens[n];
        const double mean = (b.lens[n] - a.lens[n]) / seconds;
        const double ma = monotone_limit(ca->count ? ca->slope[ca->count - 1] : 0, mean);
        const double mb = monotone_limit(cb->count ? cb->slope[0] : 0, mean);
        out->lens[n] = monotone_value(a.lens[n], b.lens[n], seconds, ma, mb, t);
    }
}

static void set_frame(struct path_frame *f, const struct camera_state *s, const struct view *lens)
{
    struct view *v = &f->camera;
    v->width = lens->width;
    v->height = lens->height;
    v->fx = exp(s->lens[LENS_FX]);
    v->fy = exp(s->lens[LENS_FY]);
    v->cx = s->lens[LENS_CX];
    v->cy = s->lens[LENS_CY];
    v->cam_from_world = mat3_transpose(mat3_from_quat(s->rotation));
    v->center = s->position;
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, s->position), -1);
    f->aperture = s->lens[LENS_APERTURE];
    f->focus = f->aperture > 0 ? s->lens[LENS_FOCUS] : 0;
}

/* ---------------------------------------------------------------------------------------------------- planned moves */

struct planned_move {
    struct camera_path path;
    struct effects layers;
};

static enum status read_planned_move(struct planned_move *m, const struct film_shot *shot,
                                     const struct film_settings *film, struct provenance *prov, struct err *err)
{
    char folder[FILE_PATH], effects[FILE_PATH];
    if (!film->moves)
        return err_set(err, ST_DATA,
                       "the move %s cannot be found: there is no folder of planned moves; give it with --moves.",
                       shot->effect);
    if (file_path(folder, film->moves, shot->effect, "", err) ||
        product_path_in(effects, folder, PRODUCT_EFFECTS, NULL, err))
        return err->status;
    const bool has_effects = !access(effects, F_OK);
    if (camera_path_read(&m->path, folder, prov, err) || (has_effects && effects_read(&m->layers, effects, prov, err)))
        return err->status;
    const struct view *first = &m->path.frames[0].camera;
    if (first->width == film->lens.width && first->height == film->lens.height) return ST_OK;
    return err_set(
        err, ST_DATA,
        "the move %s has frames of %d x %d, and the film of %d x %d; give both the same size: width, height and "
        "max_side of [sample_validity] apply to moves, those of [plan_path] to this film.",
        shot->effect, first->width, first->height, film->lens.width, film->lens.height);
}

/* The move's frames as keys over `duration` seconds. The caller frees *keys. */
static enum status move_keys(struct film_key **keys, const struct planned_move *m, bool reversed, double duration,
                             struct err *err)
{
    const int n = m->path.frame_count;
    *keys = calloc((size_t)n, sizeof **keys);
    if (!*keys) return err_nomem(err, "keys", (size_t)n * sizeof **keys);
    for (int i = 0; i < n; i++) {
        const struct path_frame *f = &m->path.frames[reversed ? n - 1 - i : i];
        const struct view *v = &f->camera;
        struct film_key *key = &(*keys)[i];
        *key = (struct film_key){.time = n > 1 ? duration * i / (n - 1) : 0, .position = v->center};
        key->rotation = quat_from_mat3(mat3_transpose(v->cam_from_world));
        const double lens[LENS_CHANNELS] = {v->fx, v->fy, v->cx, v->cy, f->aperture, f->focus};
        for (int k = 0; k < LENS_CHANNELS; k++) {
            key->lens[k] = lens[k];
            key->keyed[k] = k != LENS_FOCUS || (f->aperture > 0 && f->focus > 0); /* a pinhole has no focus */
        }
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ shots */

struct film_sources { /* what a film is computed from */
    struct film_script script;
    struct planned_move *moves; /* one per shot; empty for shots of keys */
    struct timed_shot *shots;
    int shot_count, frame_count;
};

static enum status too_long(const char *file, int line, struct err *err)
{
    return err_set(err, ST_DATA, "%s:%d: found a film of more than %d frames up to here, wanted a shorter one.", file,
                   line, MAX_FRAMES);
}

/* Sets up a shot of the script after those before it. */
static enum status place_shot(struct film_sources *sources, int index, const char *file,
                              const struct film_settings *film, struct provenance *prov, struct err *err)
{
    const struct film_shot *from = &sources->script.shots[index];
    struct timed_shot *s = &sources->shots[index];
    struct planned_move *m = &sources->moves[index];
    struct film_key *made = NULL, *keys = from->keys;
    int count = from->key_count;
    double frames, gap = fmax(1, round(from->join * film->fps));
    if (from->effect) {
        if (read_planned_move(m, from, film, prov, err)) return err_context(err, "%s:%d", file, from->line);
        count = m->path.frame_count;
        frames = round((from->seconds > 0 ? from->seconds : count / m->path.fps) * film->fps);
        frames = fmax(count > 1 ? 2 : 1, frames); /* a move keeps both of its ends */
        s->duration = (frames - 1) / film->fps;
        if (frames > MAX_FRAMES) return too_long(file, from->line, err);
        if (move_keys(&made, m, from->reversed, s->duration, err)) return err->status;
        keys = made;
    } else {
        s->duration = keys[count - 1].time;
        frames = round(s->duration * film->fps) + 1;
    }
    const double first = index ? sources->frame_count - 1 + gap : 0;
    if (first + frames > MAX_FRAMES) too_long(file, from->line, err);
    if (!err->status) {
        s->first = (int)first;
        s->frames = (int)frames;
        sources->frame_count = s->first + s->frames;
        fit_shot(s, keys, count, film, film->rest && !from->effect, err);
    }
    free(made);
    return err->status;
}

static void fill_frames(struct camera_path *path, const struct film_sources *sources, const struct film_settings *film)
{
    for (int i = 0; i < sources->shot_count; i++) {
        const struct timed_shot *s = &sources->shots[i], *before = i ? s - 1 : NULL;
        const int from = before ? before->first + before->frames - 1 : 0;
        struct camera_state state;
        for (int f = from + 1; before && f < s->first; f++) {
            join_at(before, s, (s->first - from) / film->fps, (double)(f - from) / (s->first - from), &state);
            set_frame(&path->frames[f], &state, &film->lens);
        }
        for (int f = 0; f < s->frames; f++) {
            shot_at(s, frame_time(s, f, film->fps), &state);
            set_frame(&path->frames[s->first + f], &state, &film->lens);
        }
    }
}

/* ----------------------------------------------------------------------------------------------------------- layers */

/* Appends a key, and drops the previous one if it is between two equal ones. */
static void append_key(struct effect_layer *layer, const struct effect_key *key)
{
    struct effect_key *end = layer->keys + layer->key_count;
    const size_t size = sizeof key->value;
    if (layer->key_count > 1 && !memcmp(end[-1].value, key->value, size) && !memcmp(end[-2].value, key->value, size))
        end[-1] = *key;
    else
        layer->keys[layer->key_count++] = *key;
}

/* The same for a box. */
static void append_box(struct effect_layer *layer, const struct effect_box *box)
{
    struct effect_box *end = layer->boxes + layer->box_count;
    bool same = layer->box_count > 1;
    for (int i = 1; same && i <= 2; i++) {
        struct effect_box before = end[-i];
        before.time = box->time;
        same = !memcmp(&before, box, sizeof before);
    }
    if (same)
        end[-1] = *box;
    else
        layer->boxes[layer->box_count++] = *box;
}

/* Fills the keys of a move's layer over the film's time: its value at the shot's frames, and no change at the
 * neighbouring frame of the shot before and of the shot after, so that it fades in and out over joins. A box that
 * changes follows the shot's frames too; over joins it stays as it is at the shot's end. */
static void retime_layer(struct effect_layer *made, const struct effect_layer *layer,
                         const struct film_sources *sources, int index, double fps)
{
    const struct timed_shot *s = &sources->shots[index];
    const struct camera_path *move = &sources->moves[index].path;
    const double duration = (move->frame_count - 1) / move->fps;
    const bool reversed = sources->script.shots[index].reversed;
    const int step = 1 + s->frames / MAX_LAYER_KEYS; /* a file limits the number of keys */
    const double identity[3] = {1, 1, 1};
    struct effect_key key;
    struct effect_box box;

    if (index) {
        key.time = (s[-1].first + s[-1].frames - 1) / fps;
        memcpy(key.value, identity, sizeof key.value);
        append_key(made, &key);
    }
    for (int f = 0; f < s->frames; f++) {
        if (f > 0 && f < s->frames - 1 && f % step) continue;
        const double t = s->frames > 1 ? f / (s->frames - 1.0) : 0, time = duration * (reversed ? 1 - t : t);
        key.time = (s->first + f) / fps;
        effect_layer_value(layer, time, key.value);
        append_key(made, &key);
        if (layer->box_count < 2) continue;
        effect_layer_box(layer, time, &box);
        box.time = key.time;
        append_box(made, &box);
    }
    if (layer->box_count == 1) {
        made->boxes[0] = layer->boxes[0];
        made->boxes[0].time = 0;
        made->box_count = 1;
    }
    if (index + 1 < sources->shot_count) {
        key.time = s[1].first / fps;
        memcpy(key.value, identity, sizeof key.value);
        append_key(made, &key);
    }
}

/* Appends a layer of the move of shot `index`, named after both. */
static enum status add_move_layer(struct effects *to, const struct effect_layer *layer,
                                  const struct film_sources *sources, int index, double fps, struct err *err)
{
    const size_t keys = (size_t)sources->shots[index].frames + 2;
    const size_t boxes = layer->box_count > 1 ? keys - 2 : 1;
    struct effect_layer made = {.kind = layer->kind, .region = layer->region};
    char name[128];
    snprintf(name, sizeof name, "%d:%.58s", index + 1, layer->name);
    made.name = strdup(name);
    made.keys = calloc(keys, sizeof *made.keys);
    made.boxes = calloc(boxes, sizeof *made.boxes);
    if (!made.name || !made.keys || !made.boxes)
        err_nomem(err, "a layer", keys * sizeof *made.keys + boxes * sizeof *made.boxes);
    if (!err->status && !array_append(&to->layers, (size_t)to->layer_count, sizeof *to->layers, "effect layers", err)) {
        retime_layer(&made, layer, sources, index, fps);
        to->layers[to->layer_count++] = made;
        return ST_OK;
    }
    effect_layer_release(&made);
    return err->status;
}

static enum status collect_layers(struct effects *layers, struct film_sources *sources, const char *file, double fps,
                                  struct err *err)
{
    struct effects *own = &sources->script.layers;
    int count = own->layer_count;
    for (int i = 0; i < sources->shot_count; i++) count += sources->moves[i].layers.layer_count;
    if (count > MAX_EFFECT_LAYERS)
        return err_set(err, ST_DATA, "%s: found %d effect layers, including those of its moves, wanted at most %d.",
                       file, count, MAX_EFFECT_LAYERS);
    for (int i = 0; i < sources->shot_count; i++)
        for (int k = 0; k < sources->moves[i].layers.layer_count; k++)
            if (add_move_layer(layers, &sources->moves[i].layers.layers[k], sources, i, fps, err)) return err->status;
    for (int i = 0; i < own->layer_count; i++)
        for (int k = 0; k < layers->layer_count; k++)
            if (!strcmp(layers->layers[k].name, own->layers[i].name))
                return err_set(err, ST_DATA,
                               "%s: found a layer %s, the name of a layer of one of its moves, wanted another name.",
                               file, own->layers[i].name);
    return effects_append(layers, own, err);
}

/* --------------------------------------------------------------------------------------------------------- the path */

static enum status place_shots(struct film_sources *sources, const char *file, const struct film_settings *film,
                               struct provenance *prov, struct err *err)
{
    if (keyframes_read(&sources->script, file, film->set, film->ups, &film->lens, film->up, prov, err))
        return err->status;
    const size_t n = (size_t)sources->script.shot_count;
    sources->shots = calloc(n, sizeof *sources->shots);
    sources->moves = calloc(n, sizeof *sources->moves);
    if (!sources->shots || !sources->moves) return err_nomem(err, "shots", n * sizeof *sources->shots);
    for (sources->shot_count = 0; sources->shot_count < (int)n; sources->shot_count++)
        if (place_shot(sources, sources->shot_count, file, film, prov, err)) return err->status;
    if (sources->frame_count > 1) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s:%d: found a single key, wanted a film of two frames or more; repeat the key to hold it.", file,
                   sources->script.shots[0].line);
}

static void sources_release(struct film_sources *sources)
{
    for (int i = 0; i < sources->script.shot_count; i++) {
        if (sources->shots) timed_shot_release(&sources->shots[i]);
        if (!sources->moves) continue;
        camera_path_release(&sources->moves[i].path);
        effects_release(&sources->moves[i].layers);
    }
    free(sources->shots);
    free(sources->moves);
    keyframes_release(&sources->script);
}

static enum status add_scores(struct camera_path *path, const struct film_sources *sources, double fps, struct err *err)
{
    for (int i = 0; i < sources->shot_count; i++) {
        char name[32];
        snprintf(name, sizeof name, "shot_%d", i + 1);
        if (camera_path_add_score(path, name, sources->shots[i].first / fps, "s", err)) return err->status;
    }
    return ST_OK;
}

enum status keyframed_path(struct camera_path *path, struct effects *layers, const char *file,
                           const struct film_settings *film, struct provenance *prov, struct err *err)
{
    struct film_sources sources = {0};
    if (!place_shots(&sources, file, film, prov, err))
        camera_path_init(path, film->name, film->fps, sources.frame_count, err);
    if (!err->status) {
        fill_frames(path, &sources, film);
        add_scores(path, &sources, film->fps, err);
    }
    if (!err->status) collect_layers(layers, &sources, file, film->fps, err);
    sources_release(&sources);
    if (!err->status) return ST_OK;
    camera_path_release(path);
    effects_release(layers);
    return err->status;
}
