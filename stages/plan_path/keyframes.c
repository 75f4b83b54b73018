/* keyframes.c - reader of keyframed films.
 *
 * A key's pose comes in one of three forms: `view`, the upright camera of a view; `camera`, a pose as COLMAP writes it;
 * or `at ... look ...`, a position and a point to look at. Some options depend on others later on the line (up, focus
 * at a point), so they are collected in struct key_line and resolved at its end. */
#include "stages/plan_path/keyframes.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

#define MAX_KEYS       100000
#define MAX_SHOTS      1000
#define MAX_SECONDS    1e5
#define MIN_TIME_STEP  0.001 /* between keys, s */
#define MAX_COORDINATE 1e9
#define MIN_FOCAL      1e-3 /* px */
#define MAX_FOCAL      1e7
#define MIN_ZOOM       1e-3
#define MAX_ZOOM       1e3
#define MIN_UP_SINE    1e-3 /* of the angle between the camera's axis and up */

void keyframes_release(struct film_script *s)
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

struct keyframe_reader {
    struct textfile t;
    struct film_script *script;
    const struct camera_set *set;
    const struct vec3 *ups;
    const struct view *lens;
    struct vec3 up;
    int key_count;
    bool after_break; /* the previous line was a join or a cut */
    double join;      /* duration of that join, s; 0: a cut */
};

static enum status read_point(struct textfile *t, const char *const what[3], struct vec3 *p, struct err *err)
{
    return textfile_number(t, what[0], -MAX_COORDINATE, MAX_COORDINATE, &p->x, err) ||
                   textfile_number(t, what[1], -MAX_COORDINATE, MAX_COORDINATE, &p->y, err) ||
                   textfile_number(t, what[2], -MAX_COORDINATE, MAX_COORDINATE, &p->z, err)
               ? err->status
               : ST_OK;
}

static const char *const position_names[] = {"x of the position", "y of the position", "z of the position"};
static const char *const target_names[] = {"x of the target", "y of the target", "z of the target"};
static const char *const up_names[] = {"x of up", "y of up", "z of up"};
static const char *const focus_names[] = {"x of the point in focus", "y of the point in focus",
                                          "z of the point in focus"};

/* ------------------------------------------------------------------------------------------------------------ poses */

/* x, y, z: the camera's axes in the world. */
static void set_pose(struct film_key *key, struct vec3 position, struct vec3 x, struct vec3 y, struct vec3 z)
{
    key->position = position;
    key->rotation = quat_from_mat3((struct mat3){{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}});
}

/* A view's camera, rotated by quarter turns until it is upright, with the focal length at which the frame just lies
 * within its picture. */
static enum status read_view_pose(struct keyframe_reader *r, struct film_key *key, struct err *err)
{
    char *name;
    if (textfile_word(&r->t, "a view's name", &name, err)) return err->status;
    const int view_idx = camera_set_find(r->set, name);
    if (view_idx < 0) return textfile_error(&r->t, err, name, "a view listed in views/images.txt, there as VIEW.exr");
    const struct view *v = &r->set->views[view_idx];
    const struct vec3 up = r->ups ? r->ups[view_idx] : vec3_make(0, -1, 0);
    const bool turned = fabs(up.x) > fabs(up.y);
    const double side = (turned ? up.x : up.y) > 0 ? -1 : 1;
    const struct vec3 down = turned ? vec3_make(side, 0, 0) : vec3_make(0, side, 0);
    const struct mat3 world_from_cam = mat3_transpose(v->cam_from_world);
    set_pose(key, v->center, mat3_apply(world_from_cam, vec3_make(down.y, -down.x, 0)),
             mat3_apply(world_from_cam, down), mat3_apply(world_from_cam, vec3_make(0, 0, 1)));
    const double width = turned ? v->height : v->width, height = turned ? v->width : v->height;
    const double focal = sqrt(v->fx * v->fy) * fmax(r->lens->width / width, r->lens->height / height);
    key->lens[LENS_FX] = focal;
    key->lens[LENS_FY] = focal * (r->lens->fy / r->lens->fx);
    key->keyed[LENS_FX] = key->keyed[LENS_FY] = true;
    return ST_OK;
}

/* cam_from_world as COLMAP writes it. */
static enum status read_camera_pose(struct keyframe_reader *r, struct film_key *key, struct err *err)
{
    static const char *const names[] = {"qw", "qx", "qy", "qz", "tx", "ty", "tz"};
    double n[7];
    for (int i = 0; i < 7; i++)
        if (textfile_number(&r->t, names[i], -MAX_COORDINATE, MAX_COORDINATE, &n[i], err)) return err->status;
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + n[3] * n[3]);
    if (!(length > 1e-6)) return textfile_error(&r->t, err, "a quaternion of length 0", "one of length 1: qw qx qy qz");
    const struct pose pose = {{n[0] / length, n[1] / length, n[2] / length, n[3] / length},
                              vec3_make(n[4], n[5], n[6])};
    key->position = pose_center(&pose);
    key->rotation = (struct quat){pose.rotation.w, -pose.rotation.x, -pose.rotation.y, -pose.rotation.z};
    return ST_OK;
}

/* A key's line: the key, and what can be resolved at the end of the line alone. */
struct key_line {
    struct film_key key;
    bool has_target;        /* the pose was given as at ... look ... */
    struct vec3 target, up; /* if has_target */
    bool has_up;            /* up was given on the line */
    bool has_focus_point;
    struct vec3 focus_point;
};

static enum status read_look_pose(struct keyframe_reader *r, struct key_line *l, struct err *err)
{
    char *word;
    l->has_target = true;
    l->up = r->up;
    if (read_point(&r->t, position_names, &l->key.position, err) || textfile_word(&r->t, "\"look\"", &word, err))
        return err->status;
    if (strcmp(word, "look")) return textfile_error(&r->t, err, word, "\"look\" and three coordinates");
    return read_point(&r->t, target_names, &l->target, err);
}

/* Points the camera at the target, without roll: x is perpendicular to the axis and to up. */
static enum status resolve_look(struct keyframe_reader *r, struct key_line *l, struct err *err)
{
    const struct vec3 axis = vec3_sub(l->target, l->key.position), z = vec3_normalize(axis);
    if (!(vec3_length(axis) > 1e-12 * (1 + vec3_length(l->key.position))))
        return textfile_error(&r->t, err, "a camera that looks at its own position", "another point to look at");
    const struct vec3 right = vec3_cross(z, vec3_normalize(l->up));
    if (!(vec3_length(right) > MIN_UP_SINE))
        return textfile_error(
            &r->t, err, l->has_up ? "an up parallel to the camera's axis" : "a camera axis parallel to the film's up",
            "\"up X Y Z\", a direction not parallel to the camera's axis");
    const struct vec3 x = vec3_normalize(right), y = vec3_cross(z, x);
    set_pose(&l->key, l->key.position, x, y, z);
    return ST_OK;
}

static enum status set_focus(struct keyframe_reader *r, struct film_key *key, double depth, struct err *err)
{
    char found[64];
    key->lens[LENS_FOCUS] = depth;
    key->keyed[LENS_FOCUS] = true;
    if (depth > 0 && depth <= MAX_COORDINATE) return ST_OK;
    snprintf(found, sizeof found, "a focus at depth %.9g", depth);
    return textfile_error(&r->t, err, found, "a focus in front of the camera, at a depth above 0 up to %.9g",
                          MAX_COORDINATE);
}

/* ---------------------------------------------------------------------------------------------------------- options */

static enum status read_focal(struct keyframe_reader *r, struct film_key *key, struct err *err)
{
    char *word;
    double value = 0;
    if (textfile_word(&r->t, "a focal length", &word, err)) return err->status;
    const bool is_factor = word[0] == 'x', is_number = scan_double(word + is_factor, &value);
    const double min = is_factor ? MIN_ZOOM : MIN_FOCAL, max = is_factor ? MAX_ZOOM : MAX_FOCAL;
    if (!is_number || !(value >= min && value <= max))
        return textfile_error(&r->t, err, word,
                              "a focal length in pixels of the film, from %.9g to %.9g, or x and a factor from %.9g "
                              "to %.9g",
                              MIN_FOCAL, MAX_FOCAL, MIN_ZOOM, MAX_ZOOM);
    key->lens[LENS_FX] = is_factor ? value * r->lens->fx : value;
    key->lens[LENS_FY] = key->lens[LENS_FX] * (r->lens->fy / r->lens->fx);
    key->keyed[LENS_FX] = key->keyed[LENS_FY] = true;
    return ST_OK;
}

static enum status read_focus(struct keyframe_reader *r, struct key_line *l, struct err *err)
{
    char *word;
    double depth;
    if (textfile_word(&r->t, "a depth, or \"at\" and a point", &word, err)) return err->status;
    l->has_focus_point = !strcmp(word, "at");
    if (l->has_focus_point) return read_point(&r->t, focus_names, &l->focus_point, err);
    if (scan_double(word, &depth)) return set_focus(r, &l->key, depth, err);
    return textfile_error(&r->t, err, word, "a depth in scene units, or \"at\" and three coordinates");
}

static enum status read_options(struct keyframe_reader *r, struct key_line *l, struct err *err)
{
    enum { FOCAL, APERTURE, FOCUS, UP, OPTIONS };
    static const char *const names[] = {"focal", "aperture", "focus", "up"};
    const char *const known = l->has_target ? "up, focal, aperture or focus" : "focal, aperture or focus";
    bool seen[OPTIONS] = {false};
    while (textfile_more(&r->t)) {
        char *word;
        int which = 0;
        if (textfile_word(&r->t, known, &word, err)) return err->status;
        while (which < OPTIONS && strcmp(word, names[which])) which++;
        if (which == OPTIONS || (which == UP && !l->has_target)) return textfile_error(&r->t, err, word, "%s", known);
        if (seen[which]) return textfile_error(&r->t, err, word, "each option once");
        seen[which] = true;
        if ((which == FOCAL && read_focal(r, &l->key, err)) || (which == FOCUS && read_focus(r, l, err)) ||
            (which == UP && read_point(&r->t, up_names, &l->up, err)) ||
            (which == APERTURE && textfile_number(&r->t, "the diameter of the aperture", 0, MAX_COORDINATE,
                                                  &l->key.lens[LENS_APERTURE], err)))
            return err->status;
    }
    l->has_up = seen[UP];
    if (seen[APERTURE]) l->key.keyed[LENS_APERTURE] = true;
    return ST_OK;
}

/* Resolves what depends on the whole line: the pose from a target, the focus from a point. */
static enum status resolve_key(struct keyframe_reader *r, struct key_line *l, struct err *err)
{
    if (l->has_target && resolve_look(r, l, err)) return err->status;
    if (!l->has_focus_point) return ST_OK;
    const struct mat3 cam_from_world = mat3_transpose(mat3_from_quat(l->key.rotation));
    return set_focus(r, &l->key, mat3_apply(cam_from_world, vec3_sub(l->focus_point, l->key.position)).z, err);
}

/* ------------------------------------------------------------------------------------------------------------ lines */

/* Appends a shot to the script, with the join that precedes it. */
static enum status add_shot(struct keyframe_reader *r, struct film_shot **shot, struct err *err)
{
    struct film_script *s = r->script;
    if (s->shot_count == MAX_SHOTS) return textfile_error(&r->t, err, "one more shot", "at most %d shots", MAX_SHOTS);
    if (array_append(&s->shots, (size_t)s->shot_count, sizeof *s->shots, "shots", err)) return err->status;
    *shot = &s->shots[s->shot_count++];
    **shot = (struct film_shot){.line = r->t.line, .join = r->after_break ? r->join : 0};
    r->after_break = false;
    return ST_OK;
}

static enum status add_key(struct keyframe_reader *r, struct film_shot *shot, const struct film_key *key,
                           struct err *err)
{
    if (r->key_count++ == MAX_KEYS) return textfile_error(&r->t, err, "one more key", "at most %d keys", MAX_KEYS);
    if (array_append(&shot->keys, (size_t)shot->key_count, sizeof *shot->keys, "keys", err)) return err->status;
    shot->keys[shot->key_count++] = *key;
    return ST_OK;
}

/* The shot that the next key continues; NULL: the key begins a new shot. */
static struct film_shot *open_shot(const struct keyframe_reader *r)
{
    const struct film_script *s = r->script;
    if (!s->shot_count || r->after_break || s->shots[s->shot_count - 1].effect) return NULL;
    return &s->shots[s->shot_count - 1];
}

static enum status read_time(struct textfile *t, const struct film_shot *shot, double *time, struct err *err)
{
    char *word;
    if (textfile_word(t, "a time in seconds", &word, err)) return err->status;
    if (textfile_number_of(t, word, "a time in seconds", 0, MAX_SECONDS, time, err)) return err->status;
    if (!shot && *time != 0) return textfile_error(t, err, word, "0, the time of a shot's first key");
    if (!shot || *time >= shot->keys[shot->key_count - 1].time + MIN_TIME_STEP) return ST_OK;
    return textfile_error(
        t, err, word,
        "a time %.9g s or more after %.9g, that of the previous key; a line \"cut\" or \"join SECONDS\" "
        "begins a new shot",
        MIN_TIME_STEP, shot->keys[shot->key_count - 1].time);
}

static enum status read_pose(struct keyframe_reader *r, struct key_line *l, struct err *err)
{
    char *word;
    if (textfile_word(&r->t, "view, camera or at", &word, err)) return err->status;
    if (!strcmp(word, "view")) return read_view_pose(r, &l->key, err);
    if (!strcmp(word, "camera")) return read_camera_pose(r, &l->key, err);
    if (!strcmp(word, "at")) return read_look_pose(r, l, err);
    return textfile_error(&r->t, err, word, "view, camera or at");
}

static enum status read_key(struct keyframe_reader *r, struct err *err)
{
    struct film_shot *shot = open_shot(r);
    struct key_line l = {0};
    if (read_time(&r->t, shot, &l.key.time, err) || read_pose(r, &l, err) || read_options(r, &l, err) ||
        resolve_key(r, &l, err) || (!shot && add_shot(r, &shot, err)))
        return err->status;
    return add_key(r, shot, &l.key, err);
}

/* Whether the name can be that of a folder in parallax/. */
static bool effect_is_valid(const char *name)
{
    for (const char *c = name; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr("_-+", *c)) return false;
    return *name && strlen(name) < 64;
}

static enum status read_planned_move(struct keyframe_reader *r, struct err *err)
{
    struct film_shot *shot = NULL;
    char *name, *word;
    bool reversed = false;
    double seconds = 0;
    if (textfile_word(&r->t, "a planned move's name", &name, err)) return err->status;
    if (!effect_is_valid(name))
        return textfile_error(&r->t, err, name, "a planned move's name: up to 63 letters, digits, _, - and +");
    while (textfile_more(&r->t)) {
        if (textfile_word(&r->t, "reversed or seconds", &word, err)) return err->status;
        if (!strcmp(word, "reversed") && !reversed)
            reversed = true;
        else if (strcmp(word, "seconds") || seconds > 0)
            return textfile_error(&r->t, err, word, "reversed or seconds, each once, or the end of the line");
        else if (textfile_number(&r->t, "the move's duration in seconds", MIN_TIME_STEP, MAX_SECONDS, &seconds, err))
            return err->status;
    }
    if (add_shot(r, &shot, err)) return err->status;
    shot->reversed = reversed;
    shot->seconds = seconds;
    shot->effect = strdup(name);
    return shot->effect ? ST_OK : err_nomem(err, "a name", strlen(name) + 1);
}

/* A join or a cut. */
static enum status read_break(struct keyframe_reader *r, bool join, struct err *err)
{
    if (!r->script->shot_count || r->after_break)
        return textfile_error(&r->t, err, join ? "join" : "cut", "key or move: join and cut go between two shots");
    r->join = 0;
    if (join && textfile_number(&r->t, "a transition's duration in seconds", MIN_TIME_STEP, MAX_SECONDS, &r->join, err))
        return err->status;
    r->after_break = true;
    return textfile_end(&r->t, err);
}

/* The rest of a line that names a format: its version. */
static enum status read_version(struct textfile *t, struct err *err)
{
    int64_t version;
    return textfile_int(t, "the version", 1, 1, &version, err) || textfile_end(t, err) ? err->status : ST_OK;
}

/* A shot with an open aperture must have a focus. */
static enum status check_focus(const struct keyframe_reader *r, struct err *err)
{
    for (int i = 0; i < r->script->shot_count; i++) {
        const struct film_shot *shot = &r->script->shots[i];
        double widest = 0;
        bool focus = false;
        for (int k = 0; k < shot->key_count; k++) {
            widest = fmax(widest, shot->keys[k].lens[LENS_APERTURE]);
            focus = focus || shot->keys[k].keyed[LENS_FOCUS];
        }
        if (widest > 0 && !focus)
            return err_set(
                err, ST_DATA,
                "%s:%d: found a shot with an aperture of %.9g and no focus, wanted \"focus DEPTH\" or \"focus "
                "at X Y Z\" in one of its keys.",
                r->t.path, shot->line, widest);
    }
    return ST_OK;
}

static enum status read_header(struct textfile *t, struct err *err)
{
    char *word;
    if (!textfile_next(t)) return textfile_error(t, err, NULL, "remodel-keyframes 1");
    if (textfile_word(t, "remodel-keyframes", &word, err)) return err->status;
    if (strcmp(word, "remodel-keyframes")) return textfile_error(t, err, word, "remodel-keyframes 1, the first line");
    return read_version(t, err);
}

/* *layers: the line begins the film's effect layers. */
static enum status read_line(struct keyframe_reader *r, bool *layers, struct err *err)
{
    static const char expected[] = "key, move, join, cut or remodel-effects";
    char *word;
    if (textfile_word(&r->t, expected, &word, err)) return err->status;
    if (!strcmp(word, "key")) return read_key(r, err);
    if (!strcmp(word, "move")) return read_planned_move(r, err);
    if (!strcmp(word, "join") || !strcmp(word, "cut")) return read_break(r, *word == 'j', err);
    if (strcmp(word, "remodel-effects")) return textfile_error(&r->t, err, word, "%s", expected);
    *layers = true;
    return read_version(&r->t, err);
}

static enum status read_lines(struct keyframe_reader *r, struct err *err)
{
    bool layers = false;
    if (read_header(&r->t, err)) return err->status;
    while (!layers && textfile_next(&r->t))
        if (read_line(r, &layers, err)) return err->status;
    const char *found = layers ? "remodel-effects" : "the end of the file";
    if (!r->script->shot_count) return textfile_error(&r->t, err, found, "a key or a move");
    if (r->after_break) return textfile_error(&r->t, err, found, "a key or a move after the join or cut");
    if (check_focus(r, err)) return err->status;
    return layers ? effects_read_layers(&r->script->layers, &r->t, err) : ST_OK;
}

enum status keyframes_read(struct film_script *script, const char *file, const struct camera_set *set,
                           const struct vec3 *ups, const struct view *lens, struct vec3 up, struct provenance *prov,
                           struct err *err)
{
    struct keyframe_reader r = {.script = script, .set = set, .ups = ups, .lens = lens, .up = up};
    *script = (struct film_script){0};
    const char *slash = strrchr(file, '/');
    char name[FILE_PATH];
    if (file_path(name, "keyframes", slash ? slash + 1 : file, "", err) || provenance_open(prov, name, &r.t, file, err))
        return err->status;
    read_lines(&r, err);
    textfile_release(&r.t);
    if (err->status) keyframes_release(script);
    return err->status;
}
