/* ends.c - choice of the two ends of a move.
 *
 * Candidates. Each valid cell of the start's region gives one candidate for the start, at the cell's nearest or
 * farthest valid z as the move requires; likewise for the end. A pair of candidates may subtend at most max_angle at
 * the scene's centroid, and the path of a dolly in or out must advance by at least half of its length.
 *
 * Discrete choice. [Colburn 2014, 3.4.2] measures the parallax of the longest pairs and takes the best, since it
 * renders the scene twice for each pair. Here each cell is rendered once, after which comparing two pictures takes less
 * than a millisecond, so all pairs are compared. The thesis tests the validity of the ends alone; here every frame's
 * position on the path is tested, and the first pair of the FIRST_PAIRS best whose whole path is valid is taken.
 *
 * If none is, there are two starts: the thesis's pair, drawn in towards the origin until its path is valid; and the
 * best valid one of a few pairs at each lower level of parallax, since neighbouring pairs mostly fail together.
 *
 * Continuous refinement, not in the thesis, then moves the ends of each start off the grid (ends_climb.c), and the
 * start that ends with the most parallax wins. */
#include "stages/plan_path/ends.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "stages/plan_path/ends_climb.h"

#define SHRINK_STEPS 7    /* bisections when the ends are drawn in */
#define FIRST_PAIRS  36   /* pairs whose path is tested, by falling parallax, before the ends are drawn in */
#define LEVEL        0.97 /* parallax of a level of further pairs, relative to the level above */
#define LEVEL_PAIRS  12   /* pairs of a level whose path is tested */
#define MIN_START    0.5  /* parallax of the second start before it is refined, relative to the first */
#define STARTS       2

struct start {
    struct move_ends ends; /* their path is valid, unless drawn-in ends show none that is */
    int rank;              /* by parallax; -1: drawn in */
};

struct start_list {
    struct start start[STARTS];
    int count;
};

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
            const double angle = ends_angle(&v->shot, at);
            if (angle < min_angle) min_angle = angle, narrowest = p;
            if (ends_are_allowed(s, at)) (*pairs)[n++] = p;
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
    if (ends_batch_init(&b, s, cells, err)) return err->status;
    for (int i = 0; i < cells; i++) {
        b.end[i] = i >= starts;
        b.at[i] = ends_candidate(v, b.end[i], i - b.end[i] * starts);
    }
    const int second = ends_share_cameras(v, b.at) ? 0 : starts; /* first picture of the end's cells */
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) b.wanted[pairs[i].cell[k] + k * second] = true;
    ends_batch_render(&b, err);
    if (!err->status) {
        struct pair_scoring scoring = {{b.pictures, b.pictures + second}, pairs, parallax_tolerance(s->scene)};
        parallel_for(count, 16, score_some, &scoring);
    }
    ends_batch_release(&b);
    return err->status;
}

/* Lists pairs by falling parallax: all of them, or without refinement the longest alone. discrete gets the thesis's
 * choice, the best of the longest. */
static enum status rank_pairs(struct ends_search *s, struct end_pair **pairs, int *count, struct end_pair *discrete,
                              struct err *err)
{
    size_t n = 0;
    list_pairs(s, pairs, &n, err);
    const size_t longest = n < (size_t)s->params->pairs ? n : (size_t)s->params->pairs;
    if (!err->status && strcmp(s->params->refine, "yes")) n = longest;
    if (!err->status) score_pairs(s, *pairs, n, err);
    if (err->status) return err->status;
    *discrete = (*pairs)[0];
    for (size_t i = 1; i < longest; i++)
        if ((*pairs)[i].parallax > discrete->parallax) *discrete = (*pairs)[i];
    qsort(*pairs, n, sizeof **pairs, more_parallax_first);
    s->notes->pairs = (int)n;
    s->notes->longest = (int)longest;
    *count = (int)n;
    return ST_OK;
}

/* Draws the ends in towards the origin, by the least that makes the path valid and no wider than max_angle. */
static enum status draw_in(struct ends_search *s, struct move_ends *e, struct err *err)
{
    const struct vec3 origin = s->v->shot.origin, from[2] = {e->at[0], e->at[1]};
    struct move_ends widest = *e;  /* of those that are valid */
    double valid = 0, invalid = 1; /* fractions of the way from the origin to the ends */

    for (int i = 0; i < SHRINK_STEPS; i++) {
        const double middle = 0.5 * (valid + invalid);
        for (int k = 0; k < 2; k++) e->at[k] = point_between(origin, from[k], middle);
        if (ends_measure_path_if_valid(s, e, err)) return err->status;
        if (e->valid && e->angle <= s->params->max_angle)
            valid = middle, widest = *e;
        else
            invalid = middle;
    }
    if (valid > 0) {
        *e = widest;
        return ST_OK;
    }
    for (int k = 0; k < 2; k++) e->at[k] = point_between(origin, from[k], valid);
    return ends_measure_path(s, e, err);
}

/* Adds the pair of this rank to the starts if its path is valid. */
static enum status try_pair(struct ends_search *s, struct start_list *l, const struct end_pair *pairs, int rank,
                            struct err *err)
{
    const struct end_pair *p = &pairs[rank];
    struct move_ends e = {.parallax = p->parallax};
    for (int k = 0; k < 2; k++) e.at[k] = ends_candidate(s->v, k, p->cell[k]);
    if (ends_measure_path_if_valid(s, &e, err) || !e.valid || e.angle > s->params->max_angle) return err->status;
    l->start[l->count++] = (struct start){e, rank};
    return ST_OK;
}

/* Tries up to LEVEL_PAIRS pairs of each level of parallax, evenly spread, from rank `from` down to least_parallax,
 * until the list is full. */
static enum status try_levels(struct ends_search *s, struct start_list *l, const struct end_pair *pairs, int count,
                              int from, double least_parallax, struct err *err)
{
    while (!err->status && l->count < STARTS && from < count && pairs[from].parallax > least_parallax) {
        const double lower = fmax(LEVEL * pairs[from].parallax, least_parallax);
        int end = from + 1;
        while (end < count && pairs[end].parallax > lower) end++;
        const int of_level = end - from, tried = of_level < LEVEL_PAIRS ? of_level : LEVEL_PAIRS;
        for (int i = 0; !err->status && l->count < STARTS && i < tried; i++)
            try_pair(s, l, pairs, from + (int)((long)i * of_level / tried), err);
        from = end;
    }
    return err->status;
}

/* Adds the ends drawn in from `ends`, whether their path is valid or not. */
static enum status add_drawn_in(struct ends_search *s, struct start_list *l, const struct move_ends *ends,
                                struct err *err)
{
    struct start *drawn = &l->start[l->count];
    *drawn = (struct start){.ends = *ends, .rank = -1};
    if (!draw_in(s, &drawn->ends, err) && !ends_measure_parallax(s, &drawn->ends, err)) l->count++;
    return err->status;
}

/* Finds the starts on the grid: the first pair with a valid path, or drawn-in ends and a pair of less parallax. */
static enum status find_starts(struct ends_search *s, struct start_list *l, bool refined, struct err *err)
{
    struct move_ends *discrete = &s->notes->discrete;
    struct end_pair *pairs = NULL, longest;
    int count = 0, next = 0;
    rank_pairs(s, &pairs, &count, &longest, err);
    if (!err->status) {
        discrete->parallax = longest.parallax;
        for (int k = 0; k < 2; k++) discrete->at[k] = ends_candidate(s->v, k, longest.cell[k]);
        ends_measure_path(s, discrete, err);
    }
    for (; !err->status && !l->count && next < count && next < FIRST_PAIRS; next++) try_pair(s, l, pairs, next, err);
    if (!err->status && !l->count && !add_drawn_in(s, l, discrete, err)) {
        const struct move_ends *drawn = &l->start[0].ends;
        const double least = drawn->valid ? (refined ? MIN_START : 1) * drawn->parallax : 0;
        try_levels(s, l, pairs, count, next, least, err);
    }
    free(pairs);
    return err->status;
}

/* Valid paths first, then more parallax. */
static bool is_better(const struct move_ends *a, const struct move_ends *b)
{
    return a->valid != b->valid ? a->valid : a->parallax > b->parallax;
}

enum status ends_measure(struct move_ends *e, const struct layer_scene *scene, const struct validity *v,
                         const struct plan_params *params, struct err *err)
{
    struct ends_notes notes = {0};
    struct ends_search s;
    if (!ends_search_init(&s, scene, v, params, &notes, err) && !ends_measure_path(&s, e, err))
        ends_measure_parallax(&s, e, err);
    ends_search_release(&s);
    return err->status;
}

enum status ends_choose(struct move_ends *best, struct ends_notes *notes, const struct layer_scene *scene,
                        const struct validity *v, const struct plan_params *params, struct err *err)
{
    const bool refined = !strcmp(params->refine, "yes") && !v->move.on_axis;
    struct start_list l = {.count = 0};
    struct ends_search s;
    *notes = (struct ends_notes){.chosen = -1};
    if (!ends_search_init(&s, scene, v, params, notes, err)) find_starts(&s, &l, refined, err);
    for (int i = 0; !err->status && i < l.count; i++) {
        bool moved = false;
        if (refined && ends_improve(&s, &l.start[i].ends, &moved, err)) break;
        if (i && !is_better(&l.start[i].ends, best)) continue;
        *best = l.start[i].ends;
        notes->chosen = l.start[i].rank;
        notes->refined = moved;
    }
    ends_search_release(&s);
    return err->status;
}
