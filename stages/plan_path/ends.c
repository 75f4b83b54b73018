/* ends.c - choice of the two ends of a move.
 *
 * Candidates. Each valid cell of the start's region gives one candidate for the start, at the cell's nearest or
 * farthest valid z as the move requires; likewise for the end. A pair of candidates may subtend at most max_angle at
 * the scene's centroid, and the path of a dolly in or out must advance by at least half of its length.
 *
 * Discrete choice. [Colburn 2014, 3.4.2] measures the parallax of the longest pairs and takes the best, since it
 * renders the scene twice for each pair. Here each cell is rendered once, after which comparing two pictures takes less
 * than a millisecond, so all pairs are compared. The thesis tests the validity of the ends alone; here every frame's
 * position on the path is tested, and the best pair whose whole path is valid wins. If there is none, the thesis's pair
 * is drawn in towards the origin until its path is valid.
 *
 * Continuous refinement, not in the thesis: Levenberg-Marquardt on a smooth surrogate (refine.c), from which only as
 * much is kept as the real validity and parallax confirm; then hill climbing by small steps of one end along one axis,
 * each of which must increase the parallax. The best result with a valid path replaces the discrete one. */
#include "stages/plan_path/ends.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "stages/plan_path/parallax.h"
#include "stages/plan_path/refine.h"

#define SHRINK_STEPS     7    /* bisections when the ends are drawn in */
#define MAX_PATH_SAMPLES 1000 /* frames of a longer film are closer together than matters */
#define COARSE_SAMPLES   7    /* of a path, in the quick test of its validity */
#define MAX_PAIRS_TESTED 36   /* pairs whose path is tested, by falling parallax */
#define BACK_STEPS       3    /* attempts between the refined ends and those on the grid */
#define CLIMB_ROUNDS     8
#define PATHS_PER_ROUND  4   /* steps whose path is tested in a round */
#define FIRST_STEP       0.5 /* of the climb, in units of the grid's spacing */
#define MIN_STEP         0.1
#define Z_SPACING        8   /* spacing in z, in steps of the region's z */
#define MIN_ADVANCE      0.5 /* of the length of a dolly in or out: its part along z */

/* Whether an end lies as close to the scene as is valid, or as far back. Both ends of an establishing dolly stay back,
 * since it should show the whole scene; it moves sideways. */
static bool is_forward(enum camera_move move, int end)
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
    return world_from_shot(&v->shot, c->x, c->y, is_forward(v->move.move, end) ? c->high : c->low);
}

struct end_pair {
    int cell[2];
    double length, parallax;
};

static int longer_first(const void *a, const void *b)
{
    const struct end_pair *p = a, *q = b;
    if (p->length != q->length) return p->length > q->length ? -1 : 1;
    return p->cell[0] != q->cell[0] ? p->cell[0] - q->cell[0] : p->cell[1] - q->cell[1];
}

static int more_parallax_first(const void *a, const void *b)
{
    const struct end_pair *p = a, *q = b;
    if (p->parallax != q->parallax) return p->parallax > q->parallax ? -1 : 1;
    return longer_first(a, b);
}

struct ends_search {
    const struct layer_scene *scene;
    const struct validity *v;
    const struct plan_params *params;
    struct scene_points points;
    struct viewpoint_test test;
    struct ends_notes *notes;
};

static enum status search_init(struct ends_search *s, const struct layer_scene *scene, const struct validity *v,
                               const struct plan_params *params, struct ends_notes *notes, struct err *err)
{
    *s = (struct ends_search){.scene = scene, .v = v, .params = params, .notes = notes};
    s->test = (struct viewpoint_test){.scene = scene, .points = &s->points, .shot = &v->shot, .limits = v->limits};
    return scene_points_collect(&s->points, scene, err);
}

static void search_release(struct ends_search *s)
{
    scene_points_release(&s->points);
    viewpoint_test_release(&s->test);
}

/* ---------------------------------------------------------------------------------------------------- depth
 * pictures */

static enum status render_end(struct depth_picture *d, const struct ends_search *s, int end, struct vec3 at,
                              struct err *err)
{
    const struct view camera = shot_end_camera(&s->v->shot, &s->v->move.end[end], at);
    return depth_picture_make(d, s->scene, &camera, s->params->parallax_side, err);
}

/* Depth pictures of many viewpoints, each rendered by one thread. */
struct picture_batch {
    struct ends_search *search;
    int count;
    struct vec3 *at; /* one per viewpoint, as are those below */
    int *end;        /* which end of the move it is */
    bool *wanted;    /* whether it is rendered */
    struct depth_picture *pictures;
    struct err *errors;
};

static void batch_release(struct picture_batch *b)
{
    for (int i = 0; b->pictures && i < b->count; i++) depth_picture_release(&b->pictures[i]);
    free(b->pictures);
    free(b->at);
    free(b->end);
    free(b->wanted);
    free(b->errors);
}

static enum status batch_init(struct picture_batch *b, struct ends_search *s, int count, struct err *err)
{
    const size_t n = (size_t)count;
    *b = (struct picture_batch){.search = s, .count = count};
    b->at = calloc(n, sizeof *b->at);
    b->end = calloc(n, sizeof *b->end);
    b->wanted = calloc(n, sizeof *b->wanted);
    b->pictures = calloc(n, sizeof *b->pictures);
    b->errors = calloc(n, sizeof *b->errors);
    if (b->at && b->end && b->wanted && b->pictures && b->errors) return ST_OK;
    batch_release(b);
    *b = (struct picture_batch){0};
    return err_nomem(err, "depth pictures", n * sizeof *b->pictures);
}

static void render_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct picture_batch *b = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        if (b->wanted[i]) render_end(&b->pictures[i], b->search, b->end[i], b->at[i], &b->errors[i]);
}

static enum status batch_render(struct picture_batch *b, struct err *err)
{
    parallel_for((size_t)b->count, 1, render_some, b);
    for (int i = 0; i < b->count; i++) b->search->notes->renders += b->wanted[i];
    for (int i = 0; i < b->count; i++)
        if (b->errors[i].status) return err_set(err, b->errors[i].status, "%s", b->errors[i].text);
    return ST_OK;
}

static enum status measure_parallax(struct ends_search *s, struct move_ends *e, struct err *err)
{
    struct depth_picture pictures[2] = {{.z = NULL}};
    enum status st = ST_OK;
    for (int i = 0; !st && i < 2; i++) {
        st = render_end(&pictures[i], s, i, e->at[i], err);
        s->notes->renders++;
    }
    if (!st) e->parallax = parallax_between(&pictures[0], &pictures[1], parallax_tolerance(s->scene));
    for (int i = 0; i < 2; i++) depth_picture_release(&pictures[i]);
    return st;
}

/* -------------------------------------------------------------------------------------------------------------
 * paths */

static double angle_at_centroid(const struct shot_setup *shot, const struct vec3 at[2])
{
    const struct vec3 a = vec3_sub(at[0], shot->centroid), b = vec3_sub(at[1], shot->centroid);
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) * 180 / PI;
}

double path_fraction(int i, int count, const char *ease)
{
    const double t = i / (count - 1.0);
    return strcmp(ease, "smooth") ? t : t * t * (3 - 2 * t);
}

/* Updates validity and worst values of e by `count` samples of its path. */
static enum status measure_path_samples(struct ends_search *s, struct move_ends *e, int count, const char *ease,
                                        struct err *err)
{
    struct view *cameras = calloc((size_t)count, sizeof *cameras);
    struct viewpoint *found = calloc((size_t)count, sizeof *found);
    enum status st = cameras && found ? ST_OK : err_nomem(err, "cameras of a path", (size_t)count * sizeof *cameras);

    for (int i = 0; !st && i < count; i++)
        cameras[i] = shot_camera(&s->v->shot, &s->v->move, e->at, path_fraction(i, count, ease));
    if (!st) st = viewpoints_measure(found, cameras, count, &s->test, err);
    for (int i = 0; !st && i < count; i++) {
        e->valid &= found[i].valid;
        e->worst_outside = fmax(e->worst_outside, found[i].outside);
        if (found[i].h > e->worst_h) e->worst_h = found[i].h, e->worst_at = path_fraction(i, count, ease);
    }
    free(cameras);
    free(found);
    return st;
}

/* Measures all of e but its parallax. A few samples of the path come first, as they soon find most invalid paths. */
static enum status measure_path(struct ends_search *s, struct move_ends *e, struct err *err)
{
    const int frames = (int)fmin(round(s->params->seconds * s->params->fps), MAX_PATH_SAMPLES);

    e->length = vec3_length(vec3_sub(e->at[1], e->at[0]));
    e->angle = angle_at_centroid(&s->v->shot, e->at);
    e->valid = true;
    e->worst_h = -1;
    e->worst_outside = 0;
    enum status st = measure_path_samples(s, e, WAY_PLACES, "none", err);
    if (!st && e->valid) st = measure_path_samples(s, e, frames, s->params->ease, err);
    return st;
}

/* Whether COARSE_SAMPLES of the path between the ends are valid. */
static enum status test_path_coarsely(bool *valid, struct ends_search *s, const struct vec3 at[2], struct err *err)
{
    struct view cameras[COARSE_SAMPLES];
    struct viewpoint found[COARSE_SAMPLES];

    for (int i = 0; i < COARSE_SAMPLES; i++)
        cameras[i] = shot_camera(&s->v->shot, &s->v->move, at, i / (COARSE_SAMPLES - 1.0));
    if (viewpoints_measure(found, cameras, COARSE_SAMPLES, &s->test, err)) return err->status;
    *valid = true;
    for (int i = 0; i < COARSE_SAMPLES; i++) *valid &= found[i].valid;
    return ST_OK;
}

/* As measure_path if the coarse test passes; else sets e->valid to false and nothing else. */
static enum status measure_path_if_valid(struct ends_search *s, struct move_ends *e, struct err *err)
{
    if (test_path_coarsely(&e->valid, s, e->at, err)) return err->status;
    return e->valid ? measure_path(s, e, err) : ST_OK;
}

/* Whether a move between these ends is no wider than max_angle and, if it is a dolly in or out, advances enough. */
static bool is_allowed(const struct ends_search *s, const struct vec3 at[2])
{
    const struct shot_setup *shot = &s->v->shot;
    const enum camera_move move = s->v->move.move;
    if (angle_at_centroid(shot, at) > s->params->max_angle * (1 + 1e-9)) return false;
    if (move != MOVE_DOLLY_IN && move != MOVE_DOLLY_OUT) return true;
    const double advance = shot_from_world(shot, at[1]).z - shot_from_world(shot, at[0]).z;
    return (move == MOVE_DOLLY_IN ? advance : -advance) >= MIN_ADVANCE * vec3_length(vec3_sub(at[1], at[0]));
}

/* ------------------------------------------------------------------------------------------------- pairs on the
 * grid */

static int cell_count(const struct validity_region *r) { return r->columns * r->rows; }

/* Lists the allowed pairs, longest first; the pair of the smallest angle if none is allowed. */
static enum status list_pairs(struct ends_search *s, struct end_pair **pairs, size_t *count, struct err *err)
{
    const struct validity *v = s->v;
    const int cells[2] = {cell_count(&v->region[0]), cell_count(&v->region[1])};
    const size_t max_count = (size_t)cells[0] * (size_t)cells[1];
    struct end_pair narrowest = {.cell = {-1, -1}};
    double min_angle = HUGE_VAL;
    size_t n = 0;

    *pairs = malloc((max_count + 1) * sizeof **pairs);
    if (!*pairs) return err_nomem(err, "pairs of viewpoints", max_count * sizeof **pairs);
    for (int a = 0; a < cells[0]; a++)
        for (int b = 0; b < cells[1]; b++) {
            if (!v->region[0].cells[a].valid || !v->region[1].cells[b].valid) continue;
            const struct vec3 at[2] = {ends_candidate(v, 0, a), ends_candidate(v, 1, b)};
            const struct end_pair p = {{a, b}, vec3_length(vec3_sub(at[1], at[0])), 0};
            const double angle = angle_at_centroid(&v->shot, at);
            if (angle < min_angle) min_angle = angle, narrowest = p;
            if (is_allowed(s, at)) (*pairs)[n++] = p;
        }
    if (!n && narrowest.cell[0] < 0)
        return err_set(err, ST_DATA,
                       "no cell of the move's regions is valid: there is nowhere to go; see the depth maps, or raise "
                       "max_h of [sample_validity].");
    if (!n) (*pairs)[n++] = narrowest;
    qsort(*pairs, n, sizeof **pairs, longer_first);
    *count = n;
    return ST_OK;
}

static bool same_camera(const struct view *a, const struct view *b)
{
    return a->fx == b->fx && !memcmp(&a->center, &b->center, sizeof a->center) &&
           !memcmp(&a->cam_from_world, &b->cam_from_world, sizeof a->cam_from_world);
}

/* Whether both ends of the move have the same camera in every cell. `at` has the start's candidates, then the end's. */
static bool ends_share_cameras(const struct validity *v, const struct vec3 *at)
{
    const int cells = cell_count(&v->region[0]);
    bool same = cells == cell_count(&v->region[1]);
    for (int i = 0; same && i < cells; i++) {
        const struct view first = shot_end_camera(&v->shot, &v->move.end[0], at[i]);
        const struct view second = shot_end_camera(&v->shot, &v->move.end[1], at[cells + i]);
        same = same_camera(&first, &second);
    }
    return same;
}

struct pair_scoring {
    const struct depth_picture *pictures[2]; /* one per cell */
    struct end_pair *pairs;
    double tolerance;
};

static void score_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct pair_scoring *s = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct end_pair *p = &s->pairs[i];
        p->parallax = parallax_between(&s->pictures[0][p->cell[0]], &s->pictures[1][p->cell[1]], s->tolerance);
    }
}

/* Measures the parallax of pairs. Each cell is rendered once, or once for both ends if their cameras are the same. */
static enum status score_pairs(struct ends_search *s, struct end_pair *pairs, size_t count, struct err *err)
{
    const struct validity *v = s->v;
    const int starts = cell_count(&v->region[0]), cells = starts + cell_count(&v->region[1]);
    struct picture_batch b;
    if (batch_init(&b, s, cells, err)) return err->status;
    for (int i = 0; i < cells; i++) {
        b.end[i] = i >= starts;
        b.at[i] = ends_candidate(v, b.end[i], i - b.end[i] * starts);
    }
    const int second = ends_share_cameras(v, b.at) ? 0 : starts; /* first picture of the end's cells */
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) b.wanted[pairs[i].cell[k] + k * second] = true;
    const enum status st = batch_render(&b, err);
    if (!st) {
        struct pair_scoring scoring = {{b.pictures, b.pictures + second}, pairs, parallax_tolerance(s->scene)};
        parallel_for(count, 16, score_some, &scoring);
    }
    batch_release(&b);
    return st;
}

/* Lists pairs by falling parallax: all of them, or without refinement the longest alone. discrete gets the thesis's
 * choice, the best of the longest. */
static enum status rank_pairs(struct ends_search *s, struct end_pair **pairs, int *count, struct end_pair *discrete,
                              struct err *err)
{
    size_t n = 0;
    enum status st = list_pairs(s, pairs, &n, err);
    const size_t longest = n < (size_t)s->params->pairs ? n : (size_t)s->params->pairs;
    if (!st && strcmp(s->params->refine, "yes")) n = longest;
    if (!st) st = score_pairs(s, *pairs, n, err);
    if (st) return st;
    *discrete = (*pairs)[0];
    for (size_t i = 1; i < longest; i++)
        if ((*pairs)[i].parallax > discrete->parallax) *discrete = (*pairs)[i];
    qsort(*pairs, n, sizeof **pairs, more_parallax_first);
    s->notes->pairs = (int)n;
    s->notes->longest = (int)longest;
    *count = (int)n;
    return ST_OK;
}

static struct vec3 between(struct vec3 a, struct vec3 b, double t)
{
    return vec3_add(vec3_scale(a, 1 - t), vec3_scale(b, t));
}

/* Draws the ends in towards the origin, by the least that makes the path valid and no wider than max_angle. */
static enum status draw_in(struct ends_search *s, struct move_ends *e, struct err *err)
{
    const struct vec3 origin = s->v->shot.origin, from[2] = {e->at[0], e->at[1]};
    double valid = 0, invalid = 1; /* fractions of the way from the origin to the ends */

    for (int i = 0; i < SHRINK_STEPS; i++) {
        const double middle = 0.5 * (valid + invalid);
        for (int k = 0; k < 2; k++) e->at[k] = between(origin, from[k], middle);
        if (measure_path_if_valid(s, e, err)) return err->status;
        if (e->valid && e->angle <= s->params->max_angle)
            valid = middle;
        else
            invalid = middle;
    }
    for (int k = 0; k < 2; k++) e->at[k] = between(origin, from[k], valid);
    return measure_path(s, e, err);
}

/* The pair of the most parallax whose path is valid; notes->chosen stays -1 if none of the first MAX_PAIRS_TESTED
 * is. */
static enum status choose_valid_pair(struct ends_search *s, const struct end_pair *pairs, int count,
                                     struct move_ends *best, struct err *err)
{
    for (int i = 0; i < count && i < MAX_PAIRS_TESTED; i++) {
        struct move_ends e = {.parallax = pairs[i].parallax};
        for (int k = 0; k < 2; k++) e.at[k] = ends_candidate(s->v, k, pairs[i].cell[k]);
        if (measure_path_if_valid(s, &e, err)) return err->status;
        if (!e.valid || e.angle > s->params->max_angle) continue;
        s->notes->chosen = i;
        *best = e;
        break;
    }
    return ST_OK;
}

static enum status choose_on_grid(struct ends_search *s, struct move_ends *best, struct err *err)
{
    struct move_ends *discrete = &s->notes->discrete;
    struct end_pair *pairs = NULL, longest;
    int count = 0;
    enum status st = rank_pairs(s, &pairs, &count, &longest, err);
    if (!st) {
        discrete->parallax = longest.parallax;
        for (int k = 0; k < 2; k++) discrete->at[k] = ends_candidate(s->v, k, longest.cell[k]);
        st = measure_path(s, discrete, err);
    }
    if (!st) st = choose_valid_pair(s, pairs, count, best, err);
    if (!st && s->notes->chosen < 0) {
        *best = *discrete;
        st = draw_in(s, best, err);
        if (!st) st = measure_parallax(s, best, err);
    }
    free(pairs);
    return st;
}

/* ------------------------------------------------------------------------------------------------------ off the
 * grid */

/* Ends of ever more parallax, from those on the grid upwards. The path of the first is fully measured; those of the
 * others have passed the coarse test alone. */
struct ascent {
    struct move_ends up[CLIMB_ROUNDS + 2];
    int height;
};

/* Adds the refined ends, or a point between them and the grid's ends that is valid and has more parallax. */
static enum status refine(struct ascent *a, struct ends_search *s, struct err *err)
{
    const struct move_ends *best = &a->up[a->height];
    struct vec3 refined[2] = {best->at[0], best->at[1]};
    bool valid = false;
    if (refine_ends(refined, s->scene, s->v, s->params->max_angle, err)) return err->status;
    for (int i = 0; i < BACK_STEPS && !valid; i++) {
        struct move_ends e = {.valid = false};
        for (int k = 0; k < 2; k++) e.at[k] = between(best->at[k], refined[k], pow(0.5, i));
        if (!is_allowed(s, e.at)) continue;
        if (measure_parallax(s, &e, err)) return err->status;
        if (!(e.parallax > best->parallax)) continue;
        if (test_path_coarsely(&valid, s, e.at, err)) return err->status;
        if (valid) a->up[++a->height] = e;
    }
    return ST_OK;
}

enum { AXES = 3, STEPS = 4 * AXES };

/* All single steps: each end, forwards and backwards along each axis. length: in units of the grid's spacing. */
static void list_steps(struct move_ends step[STEPS], const struct validity *v, const struct move_ends *from,
                       double length)
{
    for (int i = 0; i < STEPS; i++) {
        const int k = i / (2 * AXES), axis = i / 2 % AXES;
        const struct validity_region *r = &v->region[k];
        const struct validity_cell *first = &r->cells[0], *last = &r->cells[cell_count(r) - 1];
        const double spacing[AXES] = {(last->x - first->x) / fmax(1, r->columns - 1),
                                      (last->y - first->y) / fmax(1, r->rows - 1), Z_SPACING * v->step};
        const struct vec3 at = shot_from_world(&v->shot, from->at[k]);
        double to[AXES] = {at.x, at.y, at.z};
        to[axis] += (i % 2 ? -1 : 1) * length * spacing[axis];
        step[i] = (struct move_ends){.at = {from->at[0], from->at[1]}};
        step[i].at[k] = world_from_shot(&v->shot, to[0], to[1], to[2]);
    }
}

/* Measures the parallax of single steps; 0 for those that are not allowed. */
static enum status score_steps(struct move_ends step[STEPS], struct ends_search *s, const struct move_ends *from,
                               struct err *err)
{
    struct picture_batch b; /* the end that each step moves, then the two ends where they were */
    if (batch_init(&b, s, STEPS + 2, err)) return err->status;
    for (int i = 0; i < STEPS + 2; i++) {
        b.end[i] = i < STEPS ? i / (2 * AXES) : i - STEPS;
        b.at[i] = i < STEPS ? step[i].at[b.end[i]] : from->at[b.end[i]];
        b.wanted[i] = i >= STEPS || is_allowed(s, step[i].at);
    }
    const enum status st = batch_render(&b, err);
    for (int i = 0; !st && i < STEPS; i++)
        if (b.wanted[i])
            step[i].parallax = parallax_between(&b.pictures[b.end[i] ? STEPS : i],
                                                &b.pictures[b.end[i] ? i : STEPS + 1], parallax_tolerance(s->scene));
    batch_release(&b);
    return st;
}

static int most_parallax(const struct move_ends step[STEPS])
{
    int best = 0;
    for (int i = 1; i < STEPS; i++)
        if (step[i].parallax > step[best].parallax) best = i;
    return best;
}

/* Takes the best step whose path is valid while it gives more parallax; halves the steps when none does. This covers
 * what the surrogate leaves out: what hides what after the step, and the true borders of the regions. */
static enum status climb(struct ascent *a, struct ends_search *s, struct err *err)
{
    double length = FIRST_STEP;
    for (int round = 0; round < CLIMB_ROUNDS && length >= MIN_STEP; round++) {
        const struct move_ends *from = &a->up[a->height];
        struct move_ends step[STEPS];
        bool moved = false;
        list_steps(step, s->v, from, length);
        if (score_steps(step, s, from, err)) return err->status;
        for (int n = 0; !moved && n < PATHS_PER_ROUND; n++) {
            const int best = most_parallax(step);
            if (!(step[best].parallax > from->parallax)) break;
            if (test_path_coarsely(&moved, s, step[best].at, err)) return err->status;
            if (moved) a->up[++a->height] = step[best];
            step[best].parallax = 0;
        }
        if (!moved) length *= 0.5;
    }
    return ST_OK;
}

/* Replaces *best by the highest ends of the ascent whose whole path is valid, if any. */
static enum status refine_and_climb(struct ends_search *s, struct move_ends *best, struct err *err)
{
    struct ascent a = {.up = {*best}};
    enum status st = refine(&a, s, err);
    if (!st) st = climb(&a, s, err);
    for (; !st && a.height > 0; a.height--) {
        struct move_ends *e = &a.up[a.height];
        st = measure_path(s, e, err);
        if (st || !e->valid) continue;
        *best = *e;
        s->notes->refined = true;
        break;
    }
    return st;
}

enum status ends_measure(struct move_ends *e, const struct layer_scene *scene, const struct validity *v,
                         const struct plan_params *params, struct err *err)
{
    struct ends_notes notes = {0};
    struct ends_search s;
    enum status st = search_init(&s, scene, v, params, &notes, err);
    if (!st) st = measure_path(&s, e, err);
    if (!st) st = measure_parallax(&s, e, err);
    search_release(&s);
    return st;
}

enum status ends_choose(struct move_ends *best, struct ends_notes *notes, const struct layer_scene *scene,
                        const struct validity *v, const struct plan_params *params, struct err *err)
{
    struct ends_search s;
    *notes = (struct ends_notes){.chosen = -1};
    enum status st = search_init(&s, scene, v, params, notes, err);
    if (!st) st = choose_on_grid(&s, best, err);
    if (!st && !strcmp(params->refine, "yes") && !v->move.on_axis) st = refine_and_climb(&s, best, err);
    search_release(&s);
    return st;
}
