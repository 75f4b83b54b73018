/* ends.c - choice of the two ends of a move.
 *
 * Candidates. Each valid cell of the start's region gives one candidate for the start, at the cell's nearest or
 * farthest valid z as the move requires; likewise for the end. A pair of candidates may subtend at most max_angle at
 * the scene's centroid, and the path of a dolly in or out must advance by at least half of its length. An establishing
 * dolly must show most of the scene. It stays back in the thesis; but near objects have the most parallax, and where a
 * region ends at the back depends on single holes, so pairs at the front compete as well if they show enough.
 *
 * Discrete choice. [Colburn 2014, 3.4.2] measures the parallax of the longest pairs and takes the best, since it
 * renders the scene twice for each pair. Here each cell is rendered once, after which comparing two pictures takes less
 * than a millisecond, so all pairs are compared. The thesis tests the validity of the ends alone; here every frame's
 * position on the path is tested.
 *
 * Starts. Candidates lie on the border of what is valid, so that a straight path between two of them often leaves it.
 * The region's cells tell where; such a pair is lifted from the border towards z = 0, at which the cells were found
 * valid, by as little as keeps the path within. The first pair, by falling parallax, whose path then passes a test is a
 * start; further ones begin some cells away, since neighbours end on the same summit. If there is none, or none near
 * the best pair's parallax, another start is the thesis's pair, drawn in towards the origin until its path is valid.
 *
 * Continuous refinement, not in the thesis, then moves the ends of each start off the grid (ends_climb.c). All starts
 * climb a few rounds, the best of them to the end, and the one that ends with the most parallax wins. */
#include "stages/plan_path/ends.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "stages/plan_path/ends_climb.h"

#define SHRINK_STEPS 7   /* bisections when the ends are drawn in */
#define SHRINK       0.9 /* then, until all of the path is valid */
#define MIN_DRAWN    0.02
#define DRAW_BELOW   0.75 /* parallax of the first start, relative to the best pair's, below which ends are drawn in */
#define LIFTS        4    /* lifts of a pair that are tried, in equal steps */
#define SURE_CELLS   0.5  /* weight of the valid cells about a point that may be valid */
#define MAX_PAIRS    96   /* pairs whose path is tested */
#define MIN_START    0.3  /* parallax of a further start before it is refined, relative to the first */
#define APART        3    /* cells between an end of a start and that of another one */
#define PAIR_STARTS  8
#define FIRST_ROUNDS 4 /* of the climb of every start */
#define FINALISTS    3 /* starts that climb on */

enum { DRAWN_IN = -1 };

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

struct vec3 ends_candidate(const struct validity *v, int end, int cell, enum side side)
{
    const struct validity_cell *c = &v->region[end].cells[cell];
    const bool forward = is_forward(v->move.move, end) != (side == SIDE_OTHER);
    return world_from_shot(&v->shot, c->x, c->y, forward ? c->high : c->low);
}

struct end_pair {
    int cell[2];
    enum side side;
    double length, parallax;
};

struct start {
    struct move_ends ends;
    int rank; /* of its pair by parallax, or DRAWN_IN */
    struct end_pair pair;
    struct ascent ascent;
};

struct start_list {
    struct start start[PAIR_STARTS + 1];
    int count;
};

static int longer_first(const void *a, const void *b)
{
    const struct end_pair *p = a, *q = b;
    if (p->length != q->length) return p->length > q->length ? -1 : 1;
    if (p->side != q->side) return p->side < q->side ? -1 : 1;
    return p->cell[0] != q->cell[0] ? p->cell[0] - q->cell[0] : p->cell[1] - q->cell[1];
}

static int more_parallax_first(const void *a, const void *b)
{
    const struct end_pair *p = a, *q = b;
    if (p->parallax != q->parallax) return p->parallax > q->parallax ? -1 : 1;
    return longer_first(a, b);
}

/* Which cells' candidates show enough of the scene for an end. */
static bool *cells_that_show(const struct ends_search *s, int end, enum side side)
{
    const struct validity_region *r = &s->v->region[end];
    bool *shows = calloc((size_t)cell_count(r) + 1, sizeof *shows);
    for (int i = 0; shows && i < cell_count(r); i++)
        shows[i] = r->cells[i].valid && ends_show_enough(s, end, ends_candidate(s->v, end, i, side));
    return shows;
}

/* Appends the allowed pairs of one side to a list of *count, which has room for all. narrowest: of all valid pairs the
 * one of the smallest angle, in degrees. */
static enum status add_pairs(struct end_pair *pairs, size_t *count, struct end_pair *narrowest, double *min_angle,
                             const struct ends_search *s, enum side side, struct err *err)
{
    const struct validity *v = s->v;
    bool *shows[2] = {cells_that_show(s, 0, side), cells_that_show(s, 1, side)};
    if (!shows[0] || !shows[1]) err_nomem(err, "viewpoints", (size_t)cell_count(&v->region[0]));
    for (int a = 0; !err->status && a < cell_count(&v->region[0]); a++)
        for (int b = 0; b < cell_count(&v->region[1]); b++) {
            if (!v->region[0].cells[a].valid || !v->region[1].cells[b].valid) continue;
            const struct vec3 at[2] = {ends_candidate(v, 0, a, side), ends_candidate(v, 1, b, side)};
            const struct end_pair p = {{a, b}, side, vec3_length(vec3_sub(at[1], at[0])), 0};
            const double angle = ends_angle(&v->shot, at);
            if (angle < *min_angle) *min_angle = angle, *narrowest = p;
            if (shows[0][a] && shows[1][b] && ends_move_as_asked(s, at)) pairs[(*count)++] = p;
        }
    free(shows[0]);
    free(shows[1]);
    return err->status;
}

/* Lists the allowed pairs: first those of the move's own side, longest first, *own of them; at least one, that of the
 * smallest angle if none is allowed. An establishing dolly has those of the other side as well. */
static enum status list_pairs(struct ends_search *s, struct end_pair **pairs, size_t *own, size_t *count,
                              struct err *err)
{
    const struct validity *v = s->v;
    const size_t max_count = 2 * (size_t)cell_count(&v->region[0]) * (size_t)cell_count(&v->region[1]);
    struct end_pair narrowest = {.cell = {-1, -1}};
    double min_angle = HUGE_VAL, ignored = -HUGE_VAL;
    size_t n = 0;

    *pairs = malloc((max_count + 1) * sizeof **pairs);
    if (!*pairs) return err_nomem(err, "pairs of viewpoints", max_count * sizeof **pairs);
    if (add_pairs(*pairs, &n, &narrowest, &min_angle, s, SIDE_OWN, err)) return err->status;
    if (!n && narrowest.cell[0] < 0)
        return err_set(err, ST_DATA,
                       "no cell of the move's regions is valid: there is nowhere to go; see the depth maps, or raise "
                       "max_h of [sample_validity].");
    if (!n) (*pairs)[n++] = narrowest;
    qsort(*pairs, n, sizeof **pairs, longer_first);
    *own = n;
    if (v->move.move == MOVE_ESTABLISHING_DOLLY) add_pairs(*pairs, &n, &narrowest, &ignored, s, SIDE_OTHER, err);
    *count = n;
    return err->status;
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

/* Measures the parallax of pairs of one side. Each cell is rendered once, or once for both ends if they have the same
 * cameras. */
static enum status score_pairs(struct ends_search *s, struct end_pair *pairs, size_t count, struct err *err)
{
    const struct validity *v = s->v;
    const int starts = cell_count(&v->region[0]), cells = starts + cell_count(&v->region[1]);
    struct picture_batch b;
    if (!count) return ST_OK;
    if (ends_batch_init(&b, s, cells, err)) return err->status;
    for (int i = 0; i < cells; i++) {
        b.end[i] = i >= starts;
        b.at[i] = ends_candidate(v, b.end[i], i - b.end[i] * starts, pairs[0].side);
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
    size_t own = 0, n = 0;
    list_pairs(s, pairs, &own, &n, err);
    const size_t longest = own < (size_t)s->params->pairs ? own : (size_t)s->params->pairs;
    if (!err->status && strcmp(s->params->refine, "yes")) own = n = longest;
    if (!err->status && !score_pairs(s, *pairs, own, err)) score_pairs(s, *pairs + own, n - own, err);
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

/* Draws the ends in towards the origin, by about the least that makes the path valid and no wider than max_angle. */
static enum status draw_in(struct ends_search *s, struct move_ends *e, struct err *err)
{
    const struct vec3 origin = s->v->shot.origin, from[2] = {e->at[0], e->at[1]};
    double valid = 0, invalid = 1; /* fractions of the way from the origin to the ends, by the coarse test */
    for (int i = 0; i < SHRINK_STEPS; i++) {
        const double middle = 0.5 * (valid + invalid);
        bool passes = false;
        for (int k = 0; k < 2; k++) e->at[k] = point_between(origin, from[k], middle);
        if (ends_angle(&s->v->shot, e->at) <= s->params->max_angle && ends_test_path(&passes, s, e->at, err))
            return err->status;
        if (passes)
            valid = middle;
        else
            invalid = middle;
    }
    for (;; valid = valid > MIN_DRAWN ? SHRINK * valid : 0) {
        for (int k = 0; k < 2; k++) e->at[k] = point_between(origin, from[k], valid);
        if (ends_measure_path(s, e, err) || e->valid || valid == 0) return err->status;
    }
}

/* Whether the straight path between two viewpoints stays within the region, as far as its cells tell. */
static bool is_within(const struct validity *v, const struct vec3 at[2])
{
    for (int i = 0; i < PATH_SAMPLES; i++) {
        const struct vec3 p = shot_from_world(&v->shot, point_between(at[0], at[1], i / (PATH_SAMPLES - 1.0)));
        double low, high;
        const double weight = validity_region_at(&v->region[0], p.x, p.y, &low, &high);
        if (weight < SURE_CELLS || p.z < low / weight - v->step || p.z > high / weight + v->step) return false;
    }
    return true;
}

/* Whether both ends have the same region: then the positions of a path tell whether it is valid. */
static bool has_one_region(const struct validity *v)
{
    const struct validity_region *a = &v->region[0], *b = &v->region[1];
    bool same = a->columns == b->columns && a->rows == b->rows;
    for (int i = 0; same && i < cell_count(a); i++) {
        const struct validity_cell *c = &a->cells[i], *d = &b->cells[i];
        same = c->x == d->x && c->y == d->y && c->valid == d->valid && c->low == d->low && c->high == d->high;
    }
    return same;
}

/* Sets `at` to the ends of a pair, lifted as far as its path needs. False: no lift keeps the path within the region of
 * both ends. */
static bool lift_pair(struct vec3 at[2], const struct validity *v, const struct end_pair *p, bool one_region)
{
    for (int i = 0; i <= LIFTS; i++) {
        for (int k = 0; k < 2; k++) {
            struct vec3 c = shot_from_world(&v->shot, ends_candidate(v, k, p->cell[k], p->side));
            at[k] = world_from_shot(&v->shot, c.x, c.y, c.z * (LIFTS - i) / LIFTS);
        }
        if (!one_region || is_within(v, at)) return true;
    }
    return false;
}

static int cells_apart(const struct validity_region *r, int a, int b)
{
    const int x = abs(a % r->columns - b % r->columns), y = abs(a / r->columns - b / r->columns);
    return x > y ? x : y;
}

/* Whether a pair is on the other side than each start, or begins some cells away from it, whichever end comes first. */
static bool is_apart(const struct start_list *l, const struct validity *v, const struct end_pair *p)
{
    const struct validity_region *r = &v->region[0];
    for (int i = 0; i < l->count; i++) {
        const int *cell = l->start[i].pair.cell;
        for (int turned = 0; turned < 2 && p->side == l->start[i].pair.side; turned++)
            if (cells_apart(r, cell[0], p->cell[turned]) < APART && cells_apart(r, cell[1], p->cell[!turned]) < APART)
                return false;
    }
    return true;
}

/* Adds a pair to the starts if a few samples of its path are valid. rank: of its parallax. */
static enum status try_pair(struct ends_search *s, struct start_list *l, const struct end_pair *p, int rank,
                            const struct vec3 at[2], struct err *err)
{
    struct start *start = &l->start[l->count];
    bool valid = false;
    *start = (struct start){.ends = {.at = {at[0], at[1]}}, .rank = rank, .pair = *p};
    if (ends_test_path(&valid, s, at, err) || !valid || ends_angle(&s->v->shot, at) > s->params->max_angle)
        return err->status;
    if (!ends_measure_parallax(s, &start->ends, err)) l->count++;
    return err->status;
}

/* Tries pairs by falling parallax until the list is full. */
static enum status try_pairs(struct ends_search *s, struct start_list *l, const struct end_pair *pairs, int count,
                             int max_starts, struct err *err)
{
    const bool one_region = has_one_region(s->v);
    for (int rank = 0, tried = 0; !err->status && rank < count && tried < MAX_PAIRS && l->count < max_starts; rank++) {
        const struct end_pair *p = &pairs[rank];
        struct vec3 at[2];
        if (l->count && p->parallax < MIN_START * l->start[0].ends.parallax) break;
        if (!is_apart(l, s->v, p) || !lift_pair(at, s->v, p, one_region)) continue;
        try_pair(s, l, p, rank, at, err);
        tried++;
    }
    return err->status;
}

/* Adds the thesis's pair, drawn in, to the starts. */
static enum status add_drawn_in(struct ends_search *s, struct start_list *l, struct err *err)
{
    struct start *drawn = &l->start[l->count];
    *drawn = (struct start){.ends = s->notes->discrete, .rank = DRAWN_IN};
    if (!draw_in(s, &drawn->ends, err) && !ends_measure_parallax(s, &drawn->ends, err)) l->count++;
    return err->status;
}

/* Finds the starts. */
static enum status find_starts(struct ends_search *s, struct start_list *l, bool refined, struct err *err)
{
    struct move_ends *discrete = &s->notes->discrete;
    struct end_pair *pairs = NULL, longest;
    int count = 0;
    rank_pairs(s, &pairs, &count, &longest, err);
    if (!err->status) {
        discrete->parallax = longest.parallax;
        for (int k = 0; k < 2; k++) discrete->at[k] = ends_candidate(s->v, k, longest.cell[k], SIDE_OWN);
        ends_measure_path(s, discrete, err);
    }
    if (!err->status) try_pairs(s, l, pairs, count, refined ? PAIR_STARTS : 1, err);
    if (!err->status && (!l->count || l->start[0].ends.parallax < DRAW_BELOW * pairs[0].parallax))
        add_drawn_in(s, l, err);
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

/* Lets every start climb a few rounds, and sorts them by what they reached. */
static enum status begin_ascents(struct ends_search *s, struct start_list *l, struct err *err)
{
    for (int i = 0; i < l->count; i++) {
        struct ascent *a = &l->start[i].ascent;
        if (climb_begin(a, s, &l->start[i].ends, err) || climb_on(a, s, FIRST_ROUNDS, err)) return err->status;
    }
    for (int i = 1; i < l->count; i++) {
        const struct start start = l->start[i];
        const double parallax = start.ascent.up[start.ascent.height].parallax;
        int k = i;
        for (; k > 0 && l->start[k - 1].ascent.up[l->start[k - 1].ascent.height].parallax < parallax; k--)
            l->start[k] = l->start[k - 1];
        l->start[k] = start;
    }
    return ST_OK;
}

/* Lets a start climb on, measures all of its path, and takes it if it is better than the best so far. */
static enum status take_start(struct ends_search *s, struct move_ends *best, struct start *start, bool refined,
                              struct err *err)
{
    bool moved = false;
    if (refined && !climb_on(&start->ascent, s, CLIMB_ROUNDS, err))
        climb_take_top(&start->ends, &moved, &start->ascent, s, err);
    if (!err->status && !moved) ends_measure_path(s, &start->ends, err);
    if (err->status || !is_better(&start->ends, best)) return err->status;
    *best = start->ends;
    s->notes->chosen = start->rank;
    s->notes->refined = moved;
    return ST_OK;
}

enum status ends_choose(struct move_ends *best, struct ends_notes *notes, const struct layer_scene *scene,
                        const struct validity *v, const struct plan_params *params, struct err *err)
{
    const bool refined = !strcmp(params->refine, "yes") && !v->move.on_axis;
    struct start_list l = {.count = 0};
    struct ends_search s;
    *notes = (struct ends_notes){.chosen = -1};
    *best = (struct move_ends){.parallax = -1}; /* any start is better */
    if (!ends_search_init(&s, scene, v, params, notes, err)) find_starts(&s, &l, refined, err);
    if (!err->status && refined) begin_ascents(&s, &l, err);
    bool drawn_in = false;
    for (int i = 0; !err->status && i < l.count && (i < FINALISTS || !best->valid); i++) {
        drawn_in = drawn_in || l.start[i].rank == DRAWN_IN;
        take_start(&s, best, &l.start[i], refined, err);
        if (err->status || best->valid || drawn_in || i + 1 < l.count || add_drawn_in(&s, &l, err) || i + 1 == l.count)
            continue;
        if (refined) climb_begin(&l.start[i + 1].ascent, &s, &l.start[i + 1].ends, err);
    }
    ends_search_release(&s);
    return err->status;
}
