/* keyframes.c - see keyframes.h. */
#include "stages/plan_path/keyframes.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"
#include "common/base/textfile.h"

#define KEYS_MOST    100000
#define SHOTS_MOST   1000
#define SECONDS_MOST 1e5
#define TIME_STEP    0.001 /* seconds between keys, at least */
#define PLACE_MOST   1e9
#define FOCAL_LEAST  1e-3 /* px */
#define FOCAL_MOST   1e7
#define ZOOM_LEAST   1e-3
#define ZOOM_MOST    1e3
#define PARALLEL     1e-3 /* sine of the angle between the axis and up, at least */

void film_script_release(struct film_script *s)
{
    if (!s) return;
    for (int i = 0; i < s->shot_count; i++) {
        free(s->shots[i].effect);
        free(s->shots[i].keys);
    }
    free(s->shots);
    effects_release(&s->layers);
    *s = (struct film_script){0};
}

struct reader {
    struct textfile t;
    struct film_script *script;
    const struct camera_set *set;
    const struct vec3 *ups;
    const struct view *lens;
    struct vec3 up;
    int key_count;
    bool parted; /* the line before was a join or a cut */
    double join;
};

static enum status number(struct textfile *t, const char *what, double least, double most, double *value,
                          struct err *err)
{
    char *word;
    if (textfile_word(t, what, &word, err)) return err->status;
    if (scan_double(word, value) && *value >= least && *value <= most) return ST_OK;
    return textfile_error(t, err, word, "%s, a number from %.9g to %.9g", what, least, most);
}

static enum status point(struct textfile *t, const char *const what[3], struct vec3 *p, struct err *err)
{
    return number(t, what[0], -PLACE_MOST, PLACE_MOST, &p->x, err) ||
                   number(t, what[1], -PLACE_MOST, PLACE_MOST, &p->y, err) ||
                   number(t, what[2], -PLACE_MOST, PLACE_MOST, &p->z, err)
               ? err->status
               : ST_OK;
}

static const char *const at_words[] = {"x of the place", "y of the place", "z of the place"};
static const char *const look_words[] = {"x of what is looked at", "y of what is looked at", "z of what is looked at"};
static const char *const up_words[] = {"x of up", "y of up", "z of up"};
static const char *const focus_words[] = {"x of what is in focus", "y of what is in focus", "z of what is in focus"};

/* ---------------------------------------------------------------------------------------------------------- poses */

static void set_pose(struct film_key *key, struct vec3 place, struct vec3 x, struct vec3 y, struct vec3 z)
{
    key->place = place;
    key->turn = quat_from_mat3((struct mat3){{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}});
}

/* A view's camera, turned by quarters until it is upright; its picture contains the film's. */
static enum status pose_view(struct reader *r, struct film_key *key, struct err *err)
{
    char *name;
    if (textfile_word(&r->t, "a view's name", &name, err)) return err->status;
    const int at = camera_set_find(r->set, name);
    if (at < 0) return textfile_error(&r->t, err, name, "a view that views/images.txt has, as VIEW.exr");
    const struct view *v = &r->set->views[at];
    const struct vec3 up = r->ups ? r->ups[at] : vec3_make(0, -1, 0);
    const bool turned = fabs(up.x) > fabs(up.y);
    const double side = (turned ? up.x : up.y) > 0 ? -1 : 1;
    const struct vec3 down = turned ? vec3_make(side, 0, 0) : vec3_make(0, side, 0);
    const struct mat3 world_from_cam = mat3_transpose(v->cam_from_world);
    set_pose(key, v->center, mat3_apply(world_from_cam, vec3_make(down.y, -down.x, 0)),
             mat3_apply(world_from_cam, down), mat3_apply(world_from_cam, vec3_make(0, 0, 1)));
    const double width = turned ? v->height : v->width, height = turned ? v->width : v->height;
    const double focal = sqrt(v->fx * v->fy) * fmax(r->lens->width / width, r->lens->height / height);
    key->number[FILM_FX] = focal;
    key->number[FILM_FY] = focal * (r->lens->fy / r->lens->fx);
    key->has[FILM_FX] = key->has[FILM_FY] = true;
    return ST_OK;
}

/* cam_from_world as COLMAP writes it. */
static enum status pose_camera(struct reader *r, struct film_key *key, struct err *err)
{
    static const char *const names[] = {"qw", "qx", "qy", "qz", "tx", "ty", "tz"};
    double n[7];
    for (int i = 0; i < 7; i++)
        if (number(&r->t, names[i], -PLACE_MOST, PLACE_MOST, &n[i], err)) return err->status;
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + n[3] * n[3]);
    if (!(length > 1e-6)) return textfile_error(&r->t, err, "a quaternion of length 0", "one of length 1: qw qx qy qz");
    const struct pose pose = {{n[0] / length, n[1] / length, n[2] / length, n[3] / length},
                              vec3_make(n[4], n[5], n[6])};
    key->place = pose_center(&pose);
    key->turn = (struct quat){pose.rotation.w, -pose.rotation.x, -pose.rotation.y, -pose.rotation.z};
    return ST_OK;
}

/* A key's line: the key, and what waits for the rest of the line. */
struct key_line {
    struct film_key key;
    bool looks, has_up, has_focus;
    struct vec3 look, up; /* after "at" */
    struct vec3 focus;    /* a place */
};

static enum status pose_at(struct reader *r, struct key_line *l, struct err *err)
{
    char *word;
    l->looks = true;
    l->up = r->up;
    if (point(&r->t, at_words, &l->key.place, err) || textfile_word(&r->t, "\"look\"", &word, err)) return err->status;
    if (strcmp(word, "look")) return textfile_error(&r->t, err, word, "\"look\" and three coordinates");
    return point(&r->t, look_words, &l->look, err);
}

/* Without roll: x across the axis and up. */
static enum status look(struct reader *r, struct key_line *l, struct err *err)
{
    const struct vec3 axis = vec3_sub(l->look, l->key.place), z = vec3_normalize(axis);
    if (!(vec3_length(axis) > 1e-12 * (1 + vec3_length(l->key.place))))
        return textfile_error(&r->t, err, "a camera that looks at its own place", "another place to look at");
    const struct vec3 right = vec3_cross(z, vec3_normalize(l->up));
    if (!(vec3_length(right) > PARALLEL))
        return textfile_error(&r->t, err, l->has_up ? "an up along the axis" : "an axis along the film's up",
                              "\"up X Y Z\", a direction across the camera's axis");
    const struct vec3 x = vec3_normalize(right), y = vec3_cross(z, x);
    set_pose(&l->key, l->key.place, x, y, z);
    return ST_OK;
}

static enum status set_focus(struct reader *r, struct film_key *key, double depth, struct err *err)
{
    char found[64];
    key->number[FILM_FOCUS] = depth;
    key->has[FILM_FOCUS] = true;
    if (depth > 0 && depth <= PLACE_MOST) return ST_OK;
    snprintf(found, sizeof found, "a focus at depth %.9g", depth);
    return textfile_error(&r->t, err, found, "one before the camera, at a depth above 0 up to %.9g", PLACE_MOST);
}

/* -------------------------------------------------------------------------------------------------------- options */

static enum status read_focal(struct reader *r, struct film_key *key, struct err *err)
{
    char *word;
    double value = 0;
    if (textfile_word(&r->t, "a focal length", &word, err)) return err->status;
    const bool times = word[0] == 'x', good = scan_double(word + times, &value);
    const double least = times ? ZOOM_LEAST : FOCAL_LEAST, most = times ? ZOOM_MOST : FOCAL_MOST;
    if (!good || !(value >= least && value <= most))
        return textfile_error(&r->t, err, word,
                              "a focal length: pixels of the film from %.9g to %.9g, or x and a factor from %.9g to "
                              "%.9g",
                              FOCAL_LEAST, FOCAL_MOST, ZOOM_LEAST, ZOOM_MOST);
    key->number[FILM_FX] = times ? value * r->lens->fx : value;
    key->number[FILM_FY] = key->number[FILM_FX] * (r->lens->fy / r->lens->fx);
    key->has[FILM_FX] = key->has[FILM_FY] = true;
    return ST_OK;
}

static enum status read_focus(struct reader *r, struct key_line *l, struct err *err)
{
    char *word;
    double depth;
    if (textfile_word(&r->t, "a depth, or \"at\" and a place", &word, err)) return err->status;
    l->has_focus = !strcmp(word, "at");
    if (l->has_focus) return point(&r->t, focus_words, &l->focus, err);
    if (scan_double(word, &depth)) return set_focus(r, &l->key, depth, err);
    return textfile_error(&r->t, err, word, "a depth in scene units, or \"at\" and three coordinates");
}

static enum status read_options(struct reader *r, struct key_line *l, struct err *err)
{
    enum { FOCAL, APERTURE, FOCUS, UP, OPTIONS };
    static const char *const names[] = {"focal", "aperture", "focus", "up"};
    const char *const known = l->looks ? "up, focal, aperture or focus" : "focal, aperture or focus";
    bool seen[OPTIONS] = {false};
    while (textfile_more(&r->t)) {
        char *word;
        int which = 0;
        if (textfile_word(&r->t, known, &word, err)) return err->status;
        while (which < OPTIONS && strcmp(word, names[which])) which++;
        if (which == OPTIONS || (which == UP && !l->looks)) return textfile_error(&r->t, err, word, "%s", known);
        if (seen[which]) return textfile_error(&r->t, err, word, "each word once");
        seen[which] = true;
        if ((which == FOCAL && read_focal(r, &l->key, err)) || (which == FOCUS && read_focus(r, l, err)) ||
            (which == UP && point(&r->t, up_words, &l->up, err)) ||
            (which == APERTURE &&
             number(&r->t, "the diameter of the aperture", 0, PLACE_MOST, &l->key.number[FILM_APERTURE], err)))
            return err->status;
    }
    l->has_up = seen[UP];
    if (seen[APERTURE]) l->key.has[FILM_APERTURE] = true;
    return ST_OK;
}

/* What waited for the whole line: a camera that looks somewhere, a focus at a place. */
static enum status finish_key(struct reader *r, struct key_line *l, struct err *err)
{
    if (l->looks && look(r, l, err)) return err->status;
    if (!l->has_focus) return ST_OK;
    const struct mat3 cam_from_world = mat3_transpose(mat3_from_quat(l->key.turn));
    return set_focus(r, &l->key, mat3_apply(cam_from_world, vec3_sub(l->focus, l->key.place)).z, err);
}

/* ---------------------------------------------------------------------------------------------------------- lines */

/* A new shot at the end of the script, with the join that was written before it. */
static enum status add_shot(struct reader *r, struct film_shot **shot, struct err *err)
{
    struct film_script *s = r->script;
    if (s->shot_count == SHOTS_MOST)
        return textfile_error(&r->t, err, "one more shot", "at most %d of them", SHOTS_MOST);
    struct film_shot *more = realloc(s->shots, ((size_t)s->shot_count + 1) * sizeof *more);
    if (!more) return err_nomem(err, "shots", ((size_t)s->shot_count + 1) * sizeof *more);
    s->shots = more;
    *shot = &more[s->shot_count++];
    **shot = (struct film_shot){.line = r->t.line, .join = r->parted ? r->join : 0};
    r->parted = false;
    return ST_OK;
}

static enum status add_key(struct reader *r, struct film_shot *shot, const struct film_key *key, struct err *err)
{
    if (r->key_count++ == KEYS_MOST) return textfile_error(&r->t, err, "one more key", "at most %d of them", KEYS_MOST);
    if (!(shot->key_count & (shot->key_count - 1))) { /* a power of two: room for as many again */
        const size_t room = shot->key_count ? 2 * (size_t)shot->key_count : 1;
        struct film_key *more = realloc(shot->keys, room * sizeof *more);
        if (!more) return err_nomem(err, "keys", room * sizeof *more);
        shot->keys = more;
    }
    shot->keys[shot->key_count++] = *key;
    return ST_OK;
}

static enum status read_key(struct reader *r, struct err *err)
{
    struct textfile *t = &r->t;
    struct film_script *s = r->script;
    struct film_shot *shot = s->shot_count ? &s->shots[s->shot_count - 1] : NULL;
    struct key_line l = {0};
    char *word;
    if (!shot || shot->effect || r->parted) shot = NULL;
    if (textfile_word(t, "a time in seconds", &word, err)) return err->status;
    if (!scan_double(word, &l.key.time) || !(l.key.time >= 0 && l.key.time <= SECONDS_MOST))
        return textfile_error(t, err, word, "a time, seconds from 0 to %.9g", SECONDS_MOST);
    if (!shot && l.key.time != 0) return textfile_error(t, err, word, "0: a shot's times begin with its first key");
    if (shot && !(l.key.time >= shot->keys[shot->key_count - 1].time + TIME_STEP))
        return textfile_error(t, err, word,
                              "a time %.9g s or more after %.9g, the key's before; a line \"cut\" or \"join SECONDS\" "
                              "begins a shot of its own",
                              TIME_STEP, shot->keys[shot->key_count - 1].time);
    if (textfile_word(t, "view, camera or at", &word, err)) return err->status;
    if (!strcmp(word, "view"))
        pose_view(r, &l.key, err);
    else if (!strcmp(word, "camera"))
        pose_camera(r, &l.key, err);
    else if (!strcmp(word, "at"))
        pose_at(r, &l, err);
    else
        textfile_error(t, err, word, "view, camera or at");
    if (err->status || read_options(r, &l, err) || finish_key(r, &l, err) || (!shot && add_shot(r, &shot, err)))
        return err->status;
    return add_key(r, shot, &l.key, err);
}

/* Of a folder in parallax/. */
static bool effect_is_good(const char *name)
{
    for (const char *c = name; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr("_-+", *c)) return false;
    return *name && strlen(name) < 64;
}

static enum status read_move(struct reader *r, struct err *err)
{
    struct film_shot *shot;
    char *name, *word;
    bool reversed = false;
    double seconds = 0;
    if (textfile_word(&r->t, "a planned move's name", &name, err)) return err->status;
    if (!effect_is_good(name))
        return textfile_error(&r->t, err, name, "a planned move's name: letters, digits, _, - and +");
    while (textfile_more(&r->t)) {
        if (textfile_word(&r->t, "reversed or seconds", &word, err)) return err->status;
        if (!strcmp(word, "reversed") && !reversed)
            reversed = true;
        else if (strcmp(word, "seconds") || seconds > 0)
            return textfile_error(&r->t, err, word, "reversed or seconds, each once, or the end of the line");
        else if (number(&r->t, "the move's length in seconds", TIME_STEP, SECONDS_MOST, &seconds, err))
            return err->status;
    }
    if (add_shot(r, &shot, err)) return err->status;
    shot->reversed = reversed;
    shot->seconds = seconds;
    shot->effect = strdup(name);
    return shot->effect ? ST_OK : err_nomem(err, "a name", strlen(name) + 1);
}

static enum status read_part(struct reader *r, bool join, struct err *err)
{
    if (!r->script->shot_count || r->parted)
        return textfile_error(&r->t, err, join ? "join" : "cut", "key or move: it stands between two shots");
    r->join = 0;
    if (join && number(&r->t, "a transition's length in seconds", TIME_STEP, SECONDS_MOST, &r->join, err))
        return err->status;
    r->parted = true;
    return textfile_end(&r->t, err);
}

/* version, then the end of the line */
static enum status read_version(struct textfile *t, struct err *err)
{
    int64_t version;
    return textfile_int(t, "the version", 1, 1, &version, err) || textfile_end(t, err) ? err->status : ST_OK;
}

/* A shot whose lens opens must say where it is in focus. */
static enum status check_focus(const struct reader *r, struct err *err)
{
    for (int i = 0; i < r->script->shot_count; i++) {
        const struct film_shot *shot = &r->script->shots[i];
        double widest = 0;
        bool focus = false;
        for (int k = 0; k < shot->key_count; k++) {
            widest = fmax(widest, shot->keys[k].number[FILM_APERTURE]);
            focus = focus || shot->keys[k].has[FILM_FOCUS];
        }
        if (widest > 0 && !focus)
            return err_set(
                err, ST_DATA,
                "%s:%d: found a shot with an aperture of %.9g and no focus, wanted \"focus DEPTH\" or \"focus "
                "at X Y Z\" with one of its keys.",
                r->t.path, shot->line, widest);
    }
    return ST_OK;
}

static enum status read_lines(struct reader *r, struct err *err)
{
    char *word;
    bool layers = false;
    if (!textfile_next(&r->t)) return textfile_error(&r->t, err, NULL, "remodel-keyframes 1");
    if (textfile_word(&r->t, "remodel-keyframes", &word, err)) return err->status;
    if (strcmp(word, "remodel-keyframes"))
        return textfile_error(&r->t, err, word, "remodel-keyframes 1, the first line");
    if (read_version(&r->t, err)) return err->status;
    while (!layers && textfile_next(&r->t)) {
        enum status st = textfile_word(&r->t, "key, move, join, cut or remodel-effects", &word, err);
        if (st) return st;
        if (!strcmp(word, "key"))
            st = read_key(r, err);
        else if (!strcmp(word, "move"))
            st = read_move(r, err);
        else if (!strcmp(word, "join") || !strcmp(word, "cut"))
            st = read_part(r, *word == 'j', err);
        else if (!strcmp(word, "remodel-effects"))
            st = read_version(&r->t, err), layers = true;
        else
            st = textfile_error(&r->t, err, word, "key, move, join, cut or remodel-effects");
        if (st) return st;
    }
    const char *found = layers ? "remodel-effects" : "the end of the file";
    if (!r->script->shot_count) return textfile_error(&r->t, err, found, "a key or a move");
    if (r->parted) return textfile_error(&r->t, err, found, "a key or a move after the join or cut");
    if (check_focus(r, err)) return err->status;
    return layers ? effects_read_layers(&r->script->layers, &r->t, err) : ST_OK;
}

enum status film_script_read(struct film_script *script, const char *file, const struct camera_set *set,
                             const struct vec3 *ups, const struct view *lens, struct vec3 up, struct err *err)
{
    struct reader r = {.script = script, .set = set, .ups = ups, .lens = lens, .up = up};
    *script = (struct film_script){0};
    if (textfile_open(&r.t, file, err)) return err->status;
    const enum status st = read_lines(&r, err);
    textfile_release(&r.t);
    if (st) film_script_release(script);
    return st;
}
