/* ends.c - see ends.h. */
#include "stages/plan_path/ends.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "stages/plan_path/parallax.h"
#include "stages/plan_path/refine.h"

#define SHRINK_STEPS 7
#define MOST_PLACES  1000 /* a longer film's frames are closer together than matters */
#define BACK_STEPS   3    /* from the refined ends towards those on the grid */
#define MOST_TRIED   36   /* pairs whose way is looked at */
#define ROUNDS       8    /* of small moves, both ends' */
#define FIRST_MOVE   0.5  /* of the grid's spacing */
#define LEAST_MOVE   0.1
#define Z_MOVE       8   /* steps of the region's z, what the spacing is across */
#define LEAST_FORTH  0.5 /* of a dolly in's length: what it goes in, not across */
#define GLANCES      7   /* at the way */
#define WAYS_TRIED   4   /* a round */

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
    struct pair longest; /* of the longest pairs that with most parallax */
};

static enum status draw(struct depth_picture *d, struct chooser *c, int end, struct vec3 at, int side, struct err *err)
{
    const struct view camera = shot_end_camera(&c->v->shot, &c->v->move.end[end], at);
    return depth_picture_make(d, c->scene, &camera, side, err);
}

/* Depth pictures of many places, each drawn by one thread. */
struct drawing {
    struct chooser *c;
    const struct vec3 *at;
    const int *end; /* of the move, a place */
    const bool *wanted;
    struct depth_picture *pictures;
    struct err *errors;
    int side;
};

static void draw_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct drawing *d = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        if (d->wanted[i]) draw(&d->pictures[i], d->c, d->end[i], d->at[i], d->side, &d->errors[i]);
}

/* Releases nothing on failure: pictures is the caller's, all of it {0} on entry. */
static enum status draw_all(struct drawing *d, int count, struct err *err)
{
    enum status st = ST_OK;
    d->errors = calloc((size_t)count + 1, sizeof *d->errors);
    if (!d->errors) return err_nomem(err, "depth pictures", (size_t)count * sizeof *d->errors);
    parallel_for((size_t)count, 1, draw_some, d);
    for (int i = 0; i < count; i++) {
        d->c->notes->renders += d->wanted[i];
        if (!st && d->errors[i].status) st = err_set(err, d->errors[i].status, "%s", d->errors[i].text);
    }
    free(d->errors);
    return st;
}

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
        st = draw(&pictures[i], c, i, e->at[i], c->params->parallax_side, err);
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

/* Whether a few places of the way are valid. */
static enum status glance_at_way(bool *valid, struct chooser *c, const struct vec3 at[2], struct err *err)
{
    struct view cameras[GLANCES];
    struct viewpoint seen[GLANCES];

    for (int i = 0; i < GLANCES; i++) cameras[i] = shot_camera(&c->v->shot, &c->v->move, at, i / (GLANCES - 1.0));
    if (viewpoints_measure(seen, cameras, GLANCES, &c->test, err)) return err->status;
    *valid = true;
    for (int i = 0; i < GLANCES; i++) *valid &= seen[i].valid;
    return ST_OK;
}

/* As measure_way, if a glance finds the way valid; else e->valid is false and nothing else is told. */
static enum status measure_way_if_good(struct chooser *c, struct move_ends *e, struct err *err)
{
    if (glance_at_way(&e->valid, c, e->at, err)) return err->status;
    return e->valid ? measure_way(c, e, err) : ST_OK;
}

struct scoring {
    const struct depth_picture *pictures[2]; /* a cell */
    struct pair *pairs;
    double tolerance;
};

static void score_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct scoring *s = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct pair *p = &s->pairs[i];
        p->parallax = parallax_between(&s->pictures[0][p->cell[0]], &s->pictures[1][p->cell[1]], s->tolerance);
    }
}

static bool same_camera(const struct view *a, const struct view *b)
{
    return a->fx == b->fx && !memcmp(&a->center, &b->center, sizeof a->center) &&
           !memcmp(&a->cam_from_world, &b->cam_from_world, sizeof a->cam_from_world);
}

/* Measures the parallax of pairs. Each cell is drawn once, for both ends if they would show the same. */
static enum status score_pairs(struct chooser *c, struct pair *pairs, size_t count, struct err *err)
{
    const struct validity *v = c->v;
    const int cells[2] = {v->region[0].columns * v->region[0].rows, v->region[1].columns * v->region[1].rows};
    const size_t most = (size_t)(cells[0] + cells[1]);
    struct depth_picture *pictures = calloc(most, sizeof *pictures);
    struct vec3 *at = calloc(most, sizeof *at);
    int *end = calloc(most, sizeof *end);
    bool *wanted = calloc(most, sizeof *wanted), same = cells[0] == cells[1];
    struct drawing d = {c, at, end, wanted, pictures, NULL, c->params->parallax_side};
    enum status st = pictures && at && end && wanted ? ST_OK : err_nomem(err, "pictures", most * sizeof *pictures);

    for (size_t i = 0; !st && i < most; i++) {
        end[i] = i >= (size_t)cells[0];
        at[i] = ends_candidate(v, end[i], (int)i - end[i] * cells[0]);
    }
    for (int i = 0; !st && same && i < cells[0]; i++) {
        const struct view first = shot_end_camera(&v->shot, &v->move.end[0], at[i]);
        const struct view second = shot_end_camera(&v->shot, &v->move.end[1], at[cells[0] + i]);
        same = same_camera(&first, &second);
    }
    for (size_t i = 0; !st && i < count; i++)
        for (int k = 0; k < 2; k++) wanted[pairs[i].cell[k] + (same ? 0 : k * cells[0])] = true;
    if (!st) st = draw_all(&d, (int)most, err);
    if (!st) {
        struct scoring s = {{pictures, pictures + (same ? 0 : cells[0])}, pairs, parallax_tolerance(c->scene)};
        parallel_for(count, 16, score_some, &s);
    }
    for (size_t i = 0; pictures && i < most; i++) depth_picture_release(&pictures[i]);
    free(pictures);
    free(at);
    free(end);
    free(wanted);
    return st;
}

/* Whether a move between these ends is what its name says: no wider than max_angle; in or out, if it is a dolly in or
 * out. */
static bool keeps_course(const struct chooser *c, const struct vec3 at[2])
{
    const struct shot *shot = &c->v->shot;
    const enum move move = c->v->move.move;
    if (angle_at_centroid(shot, at) > c->params->max_angle * (1 + 1e-9)) return false;
    if (move != MOVE_DOLLY_IN && move != MOVE_DOLLY_OUT) return true;
    const double forth = shot_coordinates(shot, at[1]).z - shot_coordinates(shot, at[0]).z;
    return (move == MOVE_DOLLY_IN ? forth : -forth) >= LEAST_FORTH * vec3_length(vec3_sub(at[1], at[0]));
}

/* The pairs that keep the move's course, longest first; where none does, the narrowest of all. */
static enum status list_pairs(struct chooser *c, struct pair **pairs, size_t *count, struct err *err)
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
            if (keeps_course(c, at)) (*pairs)[n++] = p;
        }
    if (!n && narrowest.cell[0] < 0)
        return err_set(err, ST_DATA, "no place of the move's regions is valid: there is nowhere to go.");
    if (!n) (*pairs)[n++] = narrowest;
    qsort(*pairs, n, sizeof **pairs, longer_first);
    *count = n;
    return ST_OK;
}

/* All pairs, or the longest ones alone, by their parallax. The thesis' answer is the best of the longest. */
static enum status best_pairs(struct chooser *c, struct pair **pairs, int *count, struct err *err)
{
    size_t n = 0;
    enum status st = list_pairs(c, pairs, &n, err);
    const size_t longest = n < (size_t)c->params->pairs ? n : (size_t)c->params->pairs;
    if (!st && strcmp(c->params->refine, "yes")) n = longest;
    if (!st) st = score_pairs(c, *pairs, n, err);
    if (st) return st;
    c->longest = (*pairs)[0];
    for (size_t i = 1; i < longest; i++)
        if ((*pairs)[i].parallax > c->longest.parallax) c->longest = (*pairs)[i];
    qsort(*pairs, n, sizeof **pairs, more_parallax_first);
    c->notes->pairs = (int)n;
    c->notes->longest = (int)longest;
    *count = (int)n;
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
        if (measure_way_if_good(c, e, err)) return err->status;
        if (e->valid && e->angle <= c->params->max_angle)
            good = part;
        else
            bad = part;
    }
    for (int k = 0; k < 2; k++) e->at[k] = towards(origin, from[k], good);
    return measure_way(c, e, err);
}

/* Ends with ever more parallax; a glance found the ways of all but the first valid, whose way was looked at in full. */
struct ascent {
    struct move_ends up[ROUNDS + 2];
    int height;
};

/* Adds the refined ends, or what lies nearest to them on the way from the grid's that is valid and has more parallax. */
static enum status refine(struct ascent *a, struct chooser *c, struct err *err)
{
    const struct move_ends *best = &a->up[a->height];
    struct vec3 refined[2] = {best->at[0], best->at[1]};
    bool valid = false;
    if (refine_ends(refined, c->scene, c->v, c->params->max_angle, err)) return err->status;
    for (int i = 0; i < BACK_STEPS && !valid; i++) {
        struct move_ends e = {.valid = false};
        for (int k = 0; k < 2; k++) e.at[k] = towards(best->at[k], refined[k], pow(0.5, i));
        if (!keeps_course(c, e.at)) continue;
        if (measure_parallax(c, &e, err)) return err->status;
        if (!(e.parallax > best->parallax)) continue;
        if (glance_at_way(&valid, c, e.at, err)) return err->status;
        if (valid) a->up[++a->height] = e;
    }
    return ST_OK;
}

enum { AXES = 3, MOVES = 4 * AXES };

/* Each end a step forth and back along each axis. */
static void list_moves(struct move_ends tried[MOVES], const struct validity *v, const struct move_ends *from,
                       double length)
{
    for (int i = 0; i < MOVES; i++) {
        const int k = i / (2 * AXES), axis = i / 2 % AXES;
        const struct validity_region *r = &v->region[k];
        const struct validity_cell *first = &r->cells[0], *last = &r->cells[r->columns * r->rows - 1];
        const double spacing[AXES] = {(last->x - first->x) / fmax(1, r->columns - 1),
                                      (last->y - first->y) / fmax(1, r->rows - 1), Z_MOVE * v->step};
        const struct vec3 at = shot_coordinates(&v->shot, from->at[k]);
        double to[AXES] = {at.x, at.y, at.z};
        to[axis] += (i % 2 ? -1 : 1) * length * spacing[axis];
        tried[i] = (struct move_ends){.at = {from->at[0], from->at[1]}};
        tried[i].at[k] = shot_place(&v->shot, to[0], to[1], to[2]);
    }
}

/* The parallax of moves from a pair of ends; 0 where they leave the course. */
static enum status score_moves(struct move_ends tried[MOVES], struct chooser *c, const struct move_ends *from,
                               struct err *err)
{
    struct depth_picture pictures[MOVES + 2] = {{.z = NULL}};
    struct vec3 at[MOVES + 2];
    int end[MOVES + 2];
    bool wanted[MOVES + 2];
    struct drawing d = {c, at, end, wanted, pictures, NULL, c->params->parallax_side};

    for (int i = 0; i < MOVES + 2; i++) {
        end[i] = i < MOVES ? i / (2 * AXES) : i - MOVES;
        at[i] = i < MOVES ? tried[i].at[end[i]] : from->at[end[i]];
        wanted[i] = i >= MOVES || keeps_course(c, tried[i].at);
    }
    const enum status st = draw_all(&d, MOVES + 2, err);
    for (int i = 0; !st && i < MOVES; i++)
        if (wanted[i])
            tried[i].parallax = parallax_between(&pictures[end[i] ? MOVES : i], &pictures[end[i] ? i : MOVES + 1],
                                                 parallax_tolerance(c->scene));
    for (int i = 0; i < MOVES + 2; i++) depth_picture_release(&pictures[i]);
    return st;
}

/* Small moves of one end along one axis, as long as one of them gives more parallax and leaves the way valid; shorter ones
 * where none does. What the surrogate leaves out - what comes to hide what, where the regions really end - is in these. */
static enum status climb(struct ascent *a, struct chooser *c, struct err *err)
{
    double length = FIRST_MOVE;
    enum status st = ST_OK;

    for (int round = 0; !st && round < ROUNDS && length >= LEAST_MOVE; round++) {
        const struct move_ends *from = &a->up[a->height];
        struct move_ends tried[MOVES];
        bool moved = false;
        list_moves(tried, c->v, from, length);
        st = score_moves(tried, c, from, err);
        for (int n = 0; !st && !moved && n < WAYS_TRIED; n++) {
            int most = 0;
            for (int i = 1; i < MOVES; i++)
                if (tried[i].parallax > tried[most].parallax) most = i;
            if (!(tried[most].parallax > from->parallax)) break;
            st = glance_at_way(&moved, c, tried[most].at, err);
            if (!st && moved) a->up[++a->height] = tried[most];
            tried[most].parallax = 0;
        }
        if (!moved) length *= 0.5;
    }
    return st;
}

/* Ends off the grid: the highest of the ascent whose whole way is valid. */
static enum status ascend(struct chooser *c, struct move_ends *best, struct err *err)
{
    struct ascent a = {.up = {*best}};
    enum status st = refine(&a, c, err);
    if (!st) st = climb(&a, c, err);
    for (; !st && a.height > 0; a.height--) {
        struct move_ends *e = &a.up[a.height];
        st = measure_way(c, e, err);
        if (st || !e->valid) continue;
        *best = *e;
        c->notes->refined = true;
        break;
    }
    return st;
}

enum status ends_measure(struct move_ends *e, const struct layer_scene *scene, const struct validity *v,
                         const struct plan_params *params, struct err *err)
{
    struct ends_notes notes = {0};
    struct chooser c = {.scene = scene, .v = v, .params = params, .notes = &notes};

    c.test = (struct viewpoint_test){.scene = scene, .points = &c.points, .shot = &v->shot, .limits = v->limits};
    enum status st = scene_points_collect(&c.points, scene, err);
    if (!st) st = measure_way(&c, e, err);
    if (!st) st = measure_parallax(&c, e, err);
    scene_points_release(&c.points);
    viewpoint_test_release(&c.test);
    return st;
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
    if (!st) st = best_pairs(&c, &pairs, &count, err);
    if (!st) {
        notes->discrete.parallax = c.longest.parallax;
        for (int k = 0; k < 2; k++) notes->discrete.at[k] = ends_candidate(v, k, c.longest.cell[k]);
        st = measure_way(&c, &notes->discrete, err);
    }
    for (int i = 0; !st && i < count && i < MOST_TRIED && notes->chosen < 0; i++) {
        struct move_ends e = {.parallax = pairs[i].parallax};
        for (int k = 0; k < 2; k++) e.at[k] = ends_candidate(v, k, pairs[i].cell[k]);
        st = measure_way_if_good(&c, &e, err);
        if (st || !e.valid || e.angle > params->max_angle) continue;
        notes->chosen = i;
        *best = e;
    }
    if (!st && notes->chosen < 0) {
        *best = notes->discrete;
        st = draw_together(&c, best, err);
        if (!st) st = measure_parallax(&c, best, err);
    }
    if (!st && !strcmp(params->refine, "yes") && !v->move.on_axis) st = ascend(&c, best, err);
    free(pairs);
    scene_points_release(&c.points);
    viewpoint_test_release(&c.test);
    return st;
}
