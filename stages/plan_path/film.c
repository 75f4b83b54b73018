/* film.c - see film.h.
 *
 * A planned move is read as keys, a frame each, so that it can be slowed down, turned round and joined like any other
 * shot. Time is cut into frames: a shot of keys over S seconds has round(S fps) + 1 of them, both ends included; a
 * planned move as many as it has; a join of S seconds puts round(S fps) - 1 between the two shots' ends. */
#include "stages/plan_path/film.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/file_path.h"
#include "common/math/monotone.h"
#include "stages/plan_path/keyframes.h"
#include "stages/plan_path/spline.h"

enum { FRAMES_MOST = 1000000, LAYER_KEYS = 50000 };

struct state { /* a film's camera at a moment; focal lengths as logarithms */
    struct vec3 place;
    struct quat turn; /* world_from_cam */
    double number[FILM_NUMBERS];
};

struct laid_shot {
    int first, frames; /* of the film's */
    double span;       /* seconds from its first frame to its last */
    struct motion motion;
    struct curve number[FILM_NUMBERS]; /* no key: `steady` holds */
    double steady[FILM_NUMBERS];
};

static void shot_release(struct laid_shot *s)
{
    motion_release(&s->motion);
    for (int i = 0; i < FILM_NUMBERS; i++) curve_release(&s->number[i]);
}

static bool is_focal(int number) { return number == FILM_FX || number == FILM_FY; }

static enum status make_shot(struct laid_shot *s, const struct film_key *keys, int count, const struct film *film,
                             bool rest, struct err *err)
{
    const struct view *lens = &film->lens;
    const double steady[FILM_NUMBERS] = {log(lens->fx), log(lens->fy), lens->cx, lens->cy, 0, 0};
    if (motion_init(&s->motion, count, err)) return err->status;
    for (int i = 0; i < count; i++) {
        s->motion.along.time[i] = keys[i].time;
        s->motion.place[i] = keys[i].place;
        s->motion.turn[i] = keys[i].turn;
    }
    motion_fit(&s->motion, rest);
    for (int n = 0; n < FILM_NUMBERS; n++) {
        struct curve *c = &s->number[n];
        s->steady[n] = steady[n];
        if (curve_init(c, count, err)) return err->status;
        c->count = 0;
        for (int i = 0; i < count; i++) {
            if (!keys[i].has[n]) continue;
            c->time[c->count] = keys[i].time;
            c->value[c->count++] = is_focal(n) ? log(keys[i].number[n]) : keys[i].number[n];
        }
        curve_fit(c, rest);
    }
    return ST_OK;
}

static void shot_at(const struct laid_shot *s, double time, struct state *out)
{
    motion_at(&s->motion, time, &out->place, &out->turn);
    for (int n = 0; n < FILM_NUMBERS; n++)
        out->number[n] = s->number[n].count ? curve_at(&s->number[n], time) : s->steady[n];
}

/* The last frame shows the last key, wherever between two frames that one is. */
static double frame_time(const struct laid_shot *s, int frame, double fps)
{
    return frame >= s->frames - 1 ? s->span : fmin(frame / fps, s->span);
}

/* At the part t of the way from the end of one shot to the start of the next, which is `seconds` long. */
static void join_at(const struct laid_shot *from, const struct laid_shot *to, double seconds, double t,
                    struct state *out)
{
    struct state a, b;
    struct vec3 va, vb, wa, wb;
    shot_at(from, from->span, &a);
    shot_at(to, 0, &b);
    motion_rates(&from->motion, true, &va, &wa);
    motion_rates(&to->motion, false, &vb, &wb);
    out->place = place_between(a.place, b.place, vec3_scale(va, seconds), vec3_scale(vb, seconds), t);
    out->turn = turn_between(a.turn, b.turn, vec3_scale(wa, seconds), vec3_scale(wb, seconds), t);
    /* a pinhole is in focus everywhere: the focus is the other's */
    if (!(a.number[FILM_FOCUS] > 0)) a.number[FILM_FOCUS] = b.number[FILM_FOCUS];
    if (!(b.number[FILM_FOCUS] > 0)) b.number[FILM_FOCUS] = a.number[FILM_FOCUS];
    for (int n = 0; n < FILM_NUMBERS; n++) {
        const struct curve *ca = &from->number[n], *cb = &to->number[n];
        const double mean = (b.number[n] - a.number[n]) / seconds;
        const double ma = monotone_limit(ca->count ? ca->slope[ca->count - 1] : 0, mean);
        const double mb = monotone_limit(cb->count ? cb->slope[0] : 0, mean);
        out->number[n] = monotone_value(a.number[n], b.number[n], seconds, ma, mb, t);
    }
}

static void set_frame(struct path_frame *f, const struct state *s, const struct view *lens)
{
    struct view *v = &f->camera;
    v->width = lens->width;
    v->height = lens->height;
    v->fx = exp(s->number[FILM_FX]);
    v->fy = exp(s->number[FILM_FY]);
    v->cx = s->number[FILM_CX];
    v->cy = s->number[FILM_CY];
    v->cam_from_world = mat3_transpose(mat3_from_quat(s->turn));
    v->center = s->place;
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, s->place), -1);
    f->aperture = s->number[FILM_APERTURE];
    f->focus = f->aperture > 0 ? s->number[FILM_FOCUS] : 0;
}

/* --------------------------------------------------------------------------------------------------- planned moves */

struct move { /* a planned move, read */
    struct camera_path path;
    struct effects layers;
};

static enum status read_move(struct move *m, const struct film_shot *shot, const struct film *film,
                             struct provenance *prov, struct err *err)
{
    static const char *const files[] = {"path.txt", "path/cameras.txt", "path/images.txt", "effects.txt"};
    char folder[FILE_PATH], effects[FILE_PATH], as[FILE_PATH];
    if (!film->moves)
        return err_set(err, ST_DATA, "the move %s cannot be found: there is no folder of planned moves.", shot->effect);
    if (file_path(folder, film->moves, shot->effect, "", err) || file_path(effects, folder, "effects.txt", "", err) ||
        file_path(as, "parallax", shot->effect, "", err))
        return err->status;
    const bool has_effects = !access(effects, F_OK);
    if (camera_path_read(&m->path, folder, err) || (has_effects && effects_read(&m->layers, effects, err)))
        return err->status;
    for (int i = 0; prov && i < 3 + has_effects; i++)
        if (provenance_add_in(prov, as, folder, files[i], "", NULL, err)) return err->status;
    const struct view *first = &m->path.frames[0].camera;
    if (first->width == film->lens.width && first->height == film->lens.height) return ST_OK;
    return err_set(err, ST_DATA,
                   "the move %s has frames of %d x %d, and the film of %d x %d; give both one size: width, height and "
                   "max_side of [sample_validity] are the moves', those of [plan_path] this film's.",
                   shot->effect, first->width, first->height, film->lens.width, film->lens.height);
}

/* Its frames as keys over `span` seconds. */
static enum status move_keys(struct film_key **keys, const struct move *m, bool reversed, double span, struct err *err)
{
    const int n = m->path.frame_count;
    *keys = calloc((size_t)n, sizeof **keys);
    if (!*keys) return err_nomem(err, "keys", (size_t)n * sizeof **keys);
    for (int i = 0; i < n; i++) {
        const struct path_frame *f = &m->path.frames[reversed ? n - 1 - i : i];
        const struct view *v = &f->camera;
        struct film_key *key = &(*keys)[i];
        *key = (struct film_key){.time = n > 1 ? span * i / (n - 1) : 0, .place = v->center};
        key->turn = quat_from_mat3(mat3_transpose(v->cam_from_world));
        const double numbers[FILM_NUMBERS] = {v->fx, v->fy, v->cx, v->cy, f->aperture, f->focus};
        for (int k = 0; k < FILM_NUMBERS; k++) {
            key->number[k] = numbers[k];
            key->has[k] = k != FILM_FOCUS || (f->aperture > 0 && f->focus > 0); /* a pinhole's focus says nothing */
        }
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- the film */

struct reel { /* what a film is made from */
    struct film_script script;
    struct move *moves; /* a shot each; empty for keys */
    struct laid_shot *shots;
    int shot_count, frame_count;
};

static enum status too_long(const char *file, int line, struct err *err)
{
    return err_set(err, ST_DATA, "%s:%d: found a film of more than %d frames here, wanted fewer seconds.", file, line,
                   FRAMES_MOST);
}

/* A shot of the script; its place in the film is behind the ones before. */
static enum status lay_shot(struct reel *reel, int index, const char *file, const struct film *film,
                            struct provenance *prov, struct err *err)
{
    const struct film_shot *from = &reel->script.shots[index];
    struct laid_shot *s = &reel->shots[index];
    struct move *m = &reel->moves[index];
    struct film_key *made = NULL, *keys = from->keys;
    int count = from->key_count;
    double frames, gap = fmax(1, round(from->join * film->fps));
    if (from->effect) {
        if (read_move(m, from, film, prov, err)) return err_context(err, "%s:%d", file, from->line);
        count = m->path.frame_count;
        frames = round((from->seconds > 0 ? from->seconds : count / m->path.fps) * film->fps);
        frames = fmax(count > 1 ? 2 : 1, frames); /* both ends of what moves */
        s->span = (frames - 1) / film->fps;
        if (frames > FRAMES_MOST) return too_long(file, from->line, err);
        if (move_keys(&made, m, from->reversed, s->span, err)) return err->status;
        keys = made;
    } else {
        s->span = keys[count - 1].time;
        frames = round(s->span * film->fps) + 1;
    }
    const double first = index ? reel->frame_count - 1 + gap : 0;
    enum status st = first + frames > FRAMES_MOST ? too_long(file, from->line, err) : ST_OK;
    if (!st) {
        s->first = (int)first;
        s->frames = (int)frames;
        reel->frame_count = s->first + s->frames;
        st = make_shot(s, keys, count, film, film->rest && !from->effect, err);
    }
    free(made);
    return st;
}

static void fill_frames(struct camera_path *path, const struct reel *reel, const struct film *film)
{
    for (int i = 0; i < reel->shot_count; i++) {
        const struct laid_shot *s = &reel->shots[i], *before = i ? s - 1 : NULL;
        const int from = before ? before->first + before->frames - 1 : 0;
        struct state state;
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

/* --------------------------------------------------------------------------------------------------------- layers */

static enum status add_layer(struct effects *to, struct effect_layer *layer, struct err *err)
{
    struct effect_layer *more = realloc(to->layers, ((size_t)to->layer_count + 1) * sizeof *more);
    if (!more) return err_nomem(err, "effect layers", ((size_t)to->layer_count + 1) * sizeof *more);
    to->layers = more;
    more[to->layer_count++] = *layer;
    *layer = (struct effect_layer){0};
    return ST_OK;
}

/* A layer of a move over the film's time: its value at each of the shot's frames, and no change at the ends of the
 * shots beside it, to where it fades over a join. A key that its neighbours say already is left out. */
static enum status carry_layer(struct effects *to, const struct effect_layer *layer, const struct reel *reel, int index,
                               double fps, struct err *err)
{
    const struct laid_shot *s = &reel->shots[index];
    const struct camera_path *move = &reel->moves[index].path;
    const double length = (move->frame_count - 1) / move->fps;
    const bool reversed = reel->script.shots[index].reversed;
    const int step = 1 + s->frames / LAYER_KEYS; /* what a file may have */
    struct effect_layer made = {.kind = layer->kind,
                                .region = layer->region,
                                .low = layer->low,
                                .high = layer->high,
                                .falloff = layer->falloff};
    char name[128];
    snprintf(name, sizeof name, "%d:%.58s", index + 1, layer->name);
    made.name = strdup(name);
    made.keys = calloc((size_t)s->frames + 2, sizeof *made.keys);
    enum status st = made.name && made.keys ? ST_OK : err_nomem(err, "a layer", (size_t)s->frames * sizeof *made.keys);
    for (int f = -1; !st && f <= s->frames; f++) {
        struct effect_key key = {.value = {1, 1, 1}};
        int at = s->first + f;
        if ((f < 0 && !index) || (f > 0 && f < s->frames - 1 && f % step)) continue;
        if (f == s->frames && index + 1 == reel->shot_count) continue;
        if (f < 0) at = s[-1].first + s[-1].frames - 1;
        if (f == s->frames) at = s[1].first;
        key.time = at / fps;
        if (f >= 0 && f < s->frames) {
            const double part = s->frames > 1 ? f / (s->frames - 1.0) : 0;
            effect_layer_value(layer, length * (reversed ? 1 - part : part), key.value);
        }
        struct effect_key *last = made.keys + made.key_count;
        const size_t size = sizeof key.value;
        if (made.key_count > 1 && !memcmp(last[-1].value, key.value, size) && !memcmp(last[-2].value, key.value, size))
            last[-1] = key;
        else
            made.keys[made.key_count++] = key;
    }
    if (!st) st = add_layer(to, &made, err);
    free(made.name);
    free(made.keys);
    return st;
}

static enum status collect_layers(struct effects *layers, struct reel *reel, const char *file, double fps,
                                  struct err *err)
{
    struct effects *own = &reel->script.layers;
    int count = own->layer_count;
    for (int i = 0; i < reel->shot_count; i++) count += reel->moves[i].layers.layer_count;
    if (count > EFFECT_LAYERS_MOST)
        return err_set(err, ST_DATA, "%s: found %d effect layers, those of its moves included, wanted at most %d.",
                       file, count, EFFECT_LAYERS_MOST);
    for (int i = 0; i < reel->shot_count; i++)
        for (int k = 0; k < reel->moves[i].layers.layer_count; k++)
            if (carry_layer(layers, &reel->moves[i].layers.layers[k], reel, i, fps, err)) return err->status;
    for (int i = 0; i < own->layer_count; i++) {
        for (int k = 0; k < layers->layer_count; k++)
            if (!strcmp(layers->layers[k].name, own->layers[i].name))
                return err_set(err, ST_DATA,
                               "%s: found a layer %s, which a move's layer is called already; wanted another name.",
                               file, own->layers[i].name);
        if (add_layer(layers, &own->layers[i], err)) return err->status;
    }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- whole */

static enum status lay_film(struct reel *reel, const char *file, const struct film *film, struct provenance *prov,
                            struct err *err)
{
    if (film_script_read(&reel->script, file, film->set, film->ups, &film->lens, film->up, err)) return err->status;
    const size_t n = (size_t)reel->script.shot_count;
    reel->shots = calloc(n, sizeof *reel->shots);
    reel->moves = calloc(n, sizeof *reel->moves);
    if (!reel->shots || !reel->moves) return err_nomem(err, "shots", n * sizeof *reel->shots);
    for (reel->shot_count = 0; reel->shot_count < (int)n; reel->shot_count++)
        if (lay_shot(reel, reel->shot_count, file, film, prov, err)) return err->status;
    if (reel->frame_count > 1) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s:%d: found one key alone, wanted a film of two frames or more; a second key like it holds it.",
                   file, reel->script.shots[0].line);
}

static void reel_release(struct reel *reel)
{
    for (int i = 0; i < reel->script.shot_count; i++) {
        if (reel->shots) shot_release(&reel->shots[i]);
        if (!reel->moves) continue;
        camera_path_release(&reel->moves[i].path);
        effects_release(&reel->moves[i].layers);
    }
    free(reel->shots);
    free(reel->moves);
    film_script_release(&reel->script);
}

static enum status add_scores(struct camera_path *path, const struct reel *reel, double fps, struct err *err)
{
    for (int i = 0; i < reel->shot_count; i++) {
        char name[32];
        snprintf(name, sizeof name, "shot_%d", i + 1);
        if (camera_path_add_score(path, name, reel->shots[i].first / fps, "s", err)) return err->status;
    }
    return ST_OK;
}

enum status keyframed_path(struct camera_path *path, struct effects *layers, const char *file, const struct film *film,
                           struct provenance *prov, struct err *err)
{
    struct reel reel = {0};
    char name[FILE_PATH];
    enum status st = file_path(name, "keyframes", film->name, ".txt", err);
    if (!st && prov) st = provenance_add_file(prov, name, file, err);
    if (!st) st = lay_film(&reel, file, film, prov, err);
    if (!st) st = camera_path_init(path, film->name, film->fps, reel.frame_count, err);
    if (!st) {
        fill_frames(path, &reel, film);
        st = add_scores(path, &reel, film->fps, err);
    }
    if (!st) st = collect_layers(layers, &reel, file, film->fps, err);
    reel_release(&reel);
    if (!st) return ST_OK;
    camera_path_release(path);
    effects_release(layers);
    return st;
}
