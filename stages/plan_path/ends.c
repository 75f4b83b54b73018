/* ends.c - see ends.h. */
#include "stages/plan_path/ends.h"

#include <stdlib.h>
#include <string.h>

#include "stages/plan_path/parallax.h"
#include "stages/plan_path/refine.h"

#define SHRINK_STEPS 7
#define MOST_PLACES  1000 /* a longer film's frames are closer together than matters */
#define BACK_STEPS   3    /* from the refined ends towards those on the grid */

/* Whether an end stands as far towards the scene as it may, or as far back. The establishing dolly is to show the whole
 * scene: both of its ends stay back, and it goes across. */
static bool is_forward(enum move move, int end)
{
    switch (move) {
    case MOVE_ESTABLISHING_DOLLY:
        return false;
    case MOVE_ESTABLISHING_DOLLY_OUT:
    case MOVE_DOLLY_OUT:
    case MOVE_DOLLY_ZOOM:
        return end == 0;
    default:
        return end == 1;
    }
}

struct vec3 ends_candidate(const struct validity *v, int end, int cell)
{
    const struct validity_cell *c = &v->region[end].cells[cell];
    return shot_place(&v->shot, c->x, c->y, is_forward(v->move.move, end) ? c->high : c->low);
}

struct pair {
    int cell[2];
    double length, parallax;
};

static int longer_first(const void *a, const void *b)
{
    const struct pair *p = a, *q = b;
    if (p->length != q->length) return p->length > q->length ? -1 : 1;
    return p->cell[0] != q->cell[0] ? p->cell[0] - q->cell[0] : p->cell[1] - q->cell[1];
}

static int more_parallax_first(const void *a, const void *b)
{
    const struct pair *p = a, *q = b;
    if (p->parallax != q->parallax) return p->parallax > q->parallax ? -1 : 1;
    return longer_first(a, b);
}

struct chooser {
    const struct layer_scene *scene;
    const struct validity *v;
    const struct plan_params *params;
    struct scene_points points;
    struct viewpoint_test test;
    struct ends_notes *notes;
};

static double angle_at_centroid(const struct shot *shot, const struct vec3 at[2])
{
    const struct vec3 a = vec3_sub(at[0], shot->centroid), b = vec3_sub(at[1], shot->centroid);
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) * 180 / M_PI;
}

static enum status measure_parallax(struct chooser *c, struct move_ends *e, struct err *err)
{
    struct depth_picture pictures[2] = {{.z = NULL}};
    enum status st = ST_OK;
    for (int i = 0; !st && i < 2; i++) {
        const struct view camera = shot_end_camera(&c->v->shot, &c->v->move.end[i], e->at[i]);
        st = depth_picture_make(&pictures[i], c->scene, &camera, c->params->parallax_side, err);
        c->notes->renders++;
    }
    if (!st) e->parallax = parallax_between(&pictures[0], &pictures[1], parallax_tolerance(c->scene));
    for (int i = 0; i < 2; i++) depth_picture_release(&pictures[i]);
    return st;
}

double ends_part(int i, int count, const char *ease)
{
    const double t = i / (count - 1.0);
    return strcmp(ease, "smooth") ? t : t * t * (3 - 2 * t);
}

/* What the way is like at some places: `count`, eased. */
static enum status measure_places(struct chooser *c, struct move_ends *e, int count, const char *ease, struct err *err)
{
    struct view *cameras = calloc((size_t)count, sizeof *cameras);
    struct viewpoint *seen = calloc((size_t)count, sizeof *seen);
    enum status st = cameras && seen ? ST_OK : err_nomem(err, "the way's cameras", (size_t)count * sizeof *cameras);

    for (int i = 0; !st && i < count; i++)
        cameras[i] = shot_camera(&c->v->shot, &c->v->move, e->at, ends_part(i, count, ease));
    if (!st) st = viewpoints_measure(seen, cameras, count, &c->test, err);
    for (int i = 0; !st && i < count; i++) {
        e->valid &= seen[i].valid;
        e->worst_outside = fmax(e->worst_outside, seen[i].outside);
        if (seen[i].h > e->worst_h) e->worst_h = seen[i].h, e->worst_at = ends_part(i, count, ease);
    }
    free(cameras);
    free(seen);
    return st;
}

/* What all of the way is like: a few places first, which tell soon where it is not valid, then those of the frames. */
static enum status measure_way(struct chooser *c, struct move_ends *e, struct err *err)
{
    const int frames = (int)fmin(round(c->params->seconds * c->params->fps), MOST_PLACES);

    e->length = vec3_length(vec3_sub(e->at[1], e->at[0]));
    e->angle = angle_at_centroid(&c->v->shot, e->at);
    e->valid = true;
    e->worst_h = -1;
    e->worst_outside = 0;
    enum status st = measure_places(c, e, WAY_PLACES, "none", err);
    if (!st && e->valid) st = measure_places(c, e, frames, c->params->ease, err);
    return st;
}

/* The longest pairs that keep max_angle; where all are wider, the narrowest of all. */
static enum status longest_pairs(struct chooser *c, struct pair **pairs, int *count, struct err *err)
{
    const struct validity *v = c->v;
    const int cells[2] = {v->region[0].columns * v->region[0].rows, v->region[1].columns * v->region[1].rows};
    const size_t most = (size_t)cells[0] * (size_t)cells[1];
    struct pair narrowest = {.cell = {-1, -1}};
    double least = HUGE_VAL;
    size_t n = 0;

    *pairs = malloc((most + 1) * sizeof **pairs);
    if (!*pairs) return err_nomem(err, "pairs of viewpoints", most * sizeof **pairs);
    for (int a = 0; a < cells[0]; a++)
        for (int b = 0; b < cells[1]; b++) {
            if (!v->region[0].cells[a].valid || !v->region[1].cells[b].valid) continue;
            const struct vec3 at[2] = {ends_candidate(v, 0, a), ends_candidate(v, 1, b)};
            const struct pair p = {{a, b}, vec3_length(vec3_sub(at[1], at[0])), 0};
            const double angle = angle_at_centroid(&v->shot, at);
            if (angle < least) least = angle, narrowest = p;
            if (angle <= c->params->max_angle) (*pairs)[n++] = p;
        }
    if (!n && narrowest.cell[0] < 0)
        return err_set(err, ST_DATA, "no place of the move's regions is valid: there is nowhere to go.");
    if (!n) (*pairs)[n++] = narrowest;
    qsort(*pairs, n, sizeof **pairs, longer_first);
    *count = n < (size_t)c->params->pairs ? (int)n : c->params->pairs;
    for (int i = 0; i < *count; i++) {
        struct pair *p = &(*pairs)[i];
        struct move_ends e = {.at = {ends_candidate(v, 0, p->cell[0]), ends_candidate(v, 1, p->cell[1])}};
        if (measure_parallax(c, &e, err)) return err->status;
        p->parallax = e.parallax;
    }
    qsort(*pairs, (size_t)*count, sizeof **pairs, more_parallax_first);
    return ST_OK;
}

static struct vec3 towards(struct vec3 from, struct vec3 to, double part)
{
    return vec3_add(vec3_scale(from, 1 - part), vec3_scale(to, part));
}

/* Draws the ends together towards the origin, as little as makes the way valid and no wider than max_angle. */
static enum status draw_together(struct chooser *c, struct move_ends *e, struct err *err)
{
    const struct vec3 origin = c->v->shot.origin, from[2] = {e->at[0], e->at[1]};
    double good = 0, bad = 1;

    for (int i = 0; i < SHRINK_STEPS; i++) {
        const double part = 0.5 * (good + bad);
        for (int k = 0; k < 2; k++) e->at[k] = towards(origin, from[k], part);
        if (measure_way(c, e, err)) return err->status;
        if (e->valid && e->angle <= c->params->max_angle)
            good = part;
        else
            bad = part;
    }
    for (int k = 0; k < 2; k++) e->at[k] = towards(origin, from[k], good);
    return measure_way(c, e, err);
}

/* Takes the refined ends, or what lies nearest to them on the way from the grid's, if it is valid and has more parallax. */
static enum status refine(struct chooser *c, struct move_ends *best, struct err *err)
{
    struct vec3 refined[2] = {best->at[0], best->at[1]};
    if (refine_ends(refined, c->scene, c->v, c->params->max_angle, err)) return err->status;
    for (int i = 0; i < BACK_STEPS; i++) {
        struct move_ends e = {.valid = false};
        for (int k = 0; k < 2; k++) e.at[k] = towards(best->at[k], refined[k], pow(0.5, i));
        if (measure_way(c, &e, err)) return err->status;
        if (!e.valid || e.angle > c->params->max_angle * (1 + 1e-9)) continue;
        if (measure_parallax(c, &e, err)) return err->status;
        if (!(e.parallax > best->parallax)) continue;
        *best = e;
        c->notes->refined = true;
        break;
    }
    return ST_OK;
}

enum status ends_choose(struct move_ends *best, struct ends_notes *notes, const struct layer_scene *scene,
                        const struct validity *v, const struct plan_params *params, struct err *err)
{
    struct chooser c = {.scene = scene, .v = v, .params = params, .notes = notes};
    struct pair *pairs = NULL;
    int count = 0;

    *notes = (struct ends_notes){.chosen = -1};
    c.test = (struct viewpoint_test){.scene = scene, .points = &c.points, .shot = &v->shot, .limits = v->limits};
    enum status st = scene_points_collect(&c.points, scene, err);
    if (!st) st = longest_pairs(&c, &pairs, &count, err);
    notes->pairs = count;
    for (int i = 0; !st && i < count && notes->chosen < 0; i++) {
        struct move_ends e = {.parallax = pairs[i].parallax};
        for (int k = 0; k < 2; k++) e.at[k] = ends_candidate(v, k, pairs[i].cell[k]);
        st = measure_way(&c, &e, err);
        if (!i) *best = notes->discrete = e;
        if (st || !e.valid || e.angle > params->max_angle) continue;
        notes->chosen = i;
        *best = e;
    }
    if (!st && notes->chosen < 0) {
        st = draw_together(&c, best, err);
        if (!st) st = measure_parallax(&c, best, err);
    }
    if (!st && !strcmp(params->refine, "yes") && !v->move.on_axis) st = refine(&c, best, err);
    free(pairs);
    scene_points_release(&c.points);
    viewpoint_test_release(&c.test);
    return st;
}
