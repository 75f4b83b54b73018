/* windows.c - windows of a wall from what the views show of its plane.
 *
 * Candidates. A cell is open if most votes lie behind the plane, solid if most lie on it, unknown if there are too few.
 * Open cells that touch form a region; a gap of a few cells between regions, such as a glazing bar, is crossed. The
 * region's rectangle has the maximum sum over its cells, where an open cell counts 1, a solid one -1 and an unknown one
 * 0 (Kadane's scan over all pairs of columns [Bentley 1984]).
 *
 * Evidence. A candidate is a window if
 *   - most votes inside lie behind the plane. A poster, a lamp or a sun patch is at the wall's depth;
 *   - few of its points are mirror images of the scene's points. Else it is a mirror;
 *   - it is bounded by solid wall;
 *   - its brightness exceeds that of the wall around it by a factor, and by a multiple of the spread there.
 * It takes the place of an opening found from points. Other openings from points stay, unless the views contradict
 * them: their cells are solid, or they are mirrors.
 *
 * Bright areas. A blown-out window has nothing that could match, and takes its depth from the wall around it. So does a
 * patch of sun, but that seldom is a rectangle along its wall. So a bright area where nothing matched, which fills its
 * rectangle, is a window if it has an edge on each side. With three it is a doubtful one: a person decides.
 *
 * Sides. Each side moves by a few cells to the largest step of brightness along it, because pictures have sharper edges
 * than depth. It moves farther outwards than inwards: the front of a reveal is near the plane, and its depth may be on
 * it. Where the largest step is that from the glass to the reveal, the next one outwards, from the reveal to the wall,
 * is taken, if there is one. A part that furniture hides in all views is not guessed: the window ends there. */
#include "stages/suggest_model/windows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"

enum { MIN_SAMPLES = 2 };                                           /* views that know a cell */
enum { GAP = 3, OUTWARDS = 8, INWARDS = 2, DEEPEST = 4, RING = 8 }; /* cells */
static const double MIN_OPEN = 0.6;                                 /* of the votes inside a window */
static const double MAX_SOLID_OPEN = 0.5; /* fewer votes: an opening from points is contradicted */
static const double MAX_MIRRORED = 0.5;   /* of the votes behind the plane */
static const double MIN_KNOWN = 0.25;     /* of the cells of an opening that views may contradict */
static const double MIN_BORDER = 0.25;    /* of the cells around a window that are solid */
static const double MIN_BRIGHTER = 1.5;   /* times the wall around it */
static const double MIN_SPREADS = 1.5;    /* times the standard deviation of log luminance around it */
static const double SECOND_STEP = 0.3;    /* of the largest step of brightness, where a reveal meets the wall */
static const double MAX_FOOT = 0.15;      /* of a doorway's lower side, of the ceiling's height */
static const double SAME = 0.5;           /* overlap of equal openings, of the smaller area */
/* of a bright area: */
static const double MIN_BRIGHT = 1.4;       /* of a cell, times the wall */
static const double MAX_MATCHED = 0.4;      /* mean confidence of its cells */
static const double MIN_FILL = 0.7;         /* of its rectangle's cells that are bright */
static const double MIN_WINDOW_FILL = 0.75; /* the same of a window that is not doubtful, with edges on all sides */
static const double MIN_EDGE = 0.5;         /* step of brightness at a side, of that to the wall */
enum { EDGE_BEGIN = 1, EDGE_END = 4 };      /* cells from a side: lines whose brightness is compared */
enum { MIN_EDGES = 3 };                     /* sides with such a step */

struct rect { /* cells begin <= x < end, foot <= y < top */
    int begin, foot, end, top;
};

static bool is_known(const struct wall_cell *c) { return c->samples >= MIN_SAMPLES && c->on + c->beyond > 0; }

/* 1: views look through the cell; -1: they see the wall; 0: not known. */
static int state_of(const struct wall_raster *r, int x, int y)
{
    const struct wall_cell *c = wall_raster_at(r, x, y);
    return !is_known(c) ? 0 : c->beyond > c->on ? 1 : -1;
}

static double log_brightness(const struct wall_cell *c) { return c->brightness / c->samples; }

/* 1: the cell is bright and nothing matched there; -1: it is not; 0: not known. wall: log luminance of the wall. */
static int blown_state_of(const struct wall_raster *r, int x, int y, double wall)
{
    const struct wall_cell *c = wall_raster_at(r, x, y);
    if (!is_known(c)) return 0;
    const double matched = (c->on + c->beyond) / c->samples - RASTER_MIN_WEIGHT;
    return matched < MAX_MATCHED && log_brightness(c) - wall >= log(MIN_BRIGHT) ? 1 : -1;
}

/* ------------------------------------------------------------------------------------------------------- candidates */

/* Marks the cells that can be reached from (x, y) over cells of state 1 and gaps, and finds their bounds. stack has
 * room for all cells. */
static struct rect mark_region(const struct wall_raster *r, const signed char *state, unsigned char *marked, int *stack,
                               int x, int y)
{
    struct rect b = {x, y, x + 1, y + 1};
    int count = 0;
    stack[count++] = x * r->up + y;
    marked[stack[0]] = 1;
    while (count) {
        const int at = stack[--count], cx = at / r->up, cy = at % r->up;
        if (cx < b.begin) b.begin = cx;
        if (cx >= b.end) b.end = cx + 1;
        if (cy < b.foot) b.foot = cy;
        if (cy >= b.top) b.top = cy + 1;
        for (int nx = cx - GAP; nx <= cx + GAP; nx++)
            for (int ny = cy - GAP; ny <= cy + GAP; ny++) {
                if ((nx != cx && ny != cy) || nx < 0 || ny < 0 || nx >= r->across || ny >= r->up) continue;
                const int next = nx * r->up + ny;
                if (marked[next] || state[next] <= 0) continue;
                marked[next] = 1;
                stack[count++] = next;
            }
    }
    return b;
}

/* The rectangle inside the bounds with the maximum sum. rows has room for a column. */
static struct rect best_rect(const struct wall_raster *r, const signed char *state, const struct rect *bounds,
                             int *rows)
{
    struct rect best = {0};
    int most = 0;
    for (int begin = bounds->begin; begin < bounds->end; begin++) {
        memset(rows, 0, (size_t)r->up * sizeof *rows);
        for (int end = begin + 1; end <= bounds->end; end++) {
            int sum = 0, foot = bounds->foot;
            for (int y = bounds->foot; y < bounds->top; y++) {
                rows[y] += state[(end - 1) * r->up + y];
                if (sum <= 0) sum = 0, foot = y;
                sum += rows[y];
                if (sum > most) {
                    most = sum;
                    best = (struct rect){begin, foot, end, y + 1};
                }
            }
        }
    }
    return best;
}

/* --------------------------------------------------------------------------------------------------------- evidence */

struct evidence {
    double known, open, mirrored, border; /* fractions */
    double wall;                          /* log luminance of the wall around */
    double contrast, spread;              /* of log luminance to the wall around; its standard deviation there */
};

static double median_of(double *values, size_t count)
{
    if (!count) return 0;
    sort_doubles(values, count);
    return values[count / 2];
}

/* values has room for all cells. */
static struct evidence weigh(const struct wall_raster *r, const struct rect *rect, double *values)
{
    struct evidence e = {0};
    double on = 0, beyond = 0, mirrored = 0;
    size_t inside = 0, around = 0, all = 0;
    for (int x = rect->begin; x < rect->end; x++)
        for (int y = rect->foot; y < rect->top; y++) {
            const struct wall_cell *c = wall_raster_at(r, x, y);
            if (!is_known(c)) continue;
            on += c->on;
            beyond += c->beyond;
            mirrored += c->mirrored;
            values[inside++] = log_brightness(c);
        }
    const double bright = median_of(values, inside);
    e.known = (double)inside / ((double)(rect->end - rect->begin) * (rect->top - rect->foot));
    for (int x = rect->begin - RING; x < rect->end + RING; x++)
        for (int y = rect->foot - RING; y < rect->top + RING; y++) {
            const bool in = x >= rect->begin && x < rect->end && y >= rect->foot && y < rect->top;
            if (in || x < 0 || y < 0 || x >= r->across || y >= r->up) continue;
            all++;
            if (state_of(r, x, y) < 0) values[around++] = log_brightness(wall_raster_at(r, x, y));
        }
    e.open = on + beyond > 0 ? beyond / (on + beyond) : 0;
    e.mirrored = beyond > 0 ? mirrored / beyond : 0;
    e.border = all ? (double)around / (double)all : 0;
    if (!inside || !around) return e;
    const double wall = median_of(values, around);
    for (size_t i = 0; i < around; i++) values[i] = fabs(values[i] - wall);
    e.wall = wall;
    e.contrast = bright - wall;
    e.spread = 1.4826 * median_of(values, around); /* the standard deviation of a normal distribution */
    return e;
}

/* ------------------------------------------------------------------------------------------------------------ sides */

/* Mean log luminance of the known cells of a line along a side; false: too few. */
static bool line_brightness(double *mean, const struct wall_raster *r, const struct rect *rect, bool row, int at)
{
    const int first = row ? rect->begin : rect->foot, last = row ? rect->end : rect->top;
    double sum = 0;
    int count = 0;
    if (at < 0 || at >= (row ? r->up : r->across)) return false;
    for (int k = first; k < last; k++) {
        const struct wall_cell *c = row ? wall_raster_at(r, k, at) : wall_raster_at(r, at, k);
        if (!is_known(c)) continue;
        sum += log_brightness(c);
        count++;
    }
    *mean = sum / (count ? count : 1);
    return 4 * count >= last - first;
}

/* How much brighter the line inside a position is than the one outside; 0 if too little is known. A line that is darker
 * than the wall counts as wall: a dark picture's edge is no step. */
static double step_at(const struct wall_raster *r, const struct rect *rect, double wall, bool row, int step, int at)
{
    double inside, outside;
    const int in = step > 0 ? at : at - 1, out = step > 0 ? at - 1 : at;
    if (!line_brightness(&inside, r, rect, row, in) || !line_brightness(&outside, r, rect, row, out)) return 0;
    return inside - fmax(outside, wall);
}

/* Moves a side (inside lies at or above *side if `step` is 1, below it if -1) to the largest step of brightness, and on
 * to the outermost one near it that is not much smaller. */
static void refine_side(int *side, int step, const struct wall_raster *r, const struct rect *rect, double wall,
                        bool row)
{
    const int from = *side;
    double largest = 0;
    for (int shift = -INWARDS; shift <= OUTWARDS; shift++) {
        const double here = step_at(r, rect, wall, row, step, from - step * shift);
        if (here <= largest) continue;
        largest = here;
        *side = from - step * shift;
    }
    const int glass = *side;
    for (int shift = 1; largest > 0 && shift <= DEEPEST; shift++)
        if (step_at(r, rect, wall, row, step, glass - step * shift) >= SECOND_STEP * largest)
            *side = glass - step * shift;
}

static void refine(struct rect *rect, const struct wall_raster *r, double wall)
{
    struct rect fine = *rect;
    refine_side(&fine.begin, 1, r, rect, wall, false);
    refine_side(&fine.end, -1, r, rect, wall, false);
    refine_side(&fine.foot, 1, r, rect, wall, true);
    refine_side(&fine.top, -1, r, rect, wall, true);
    *rect = fine;
}

/* --------------------------------------------------------------------------------------------------------- openings */

static double overlap(double a0, double a1, double b0, double b1) { return fmax(0, fmin(a1, b1) - fmax(a0, b0)); }

/* Whether most of the smaller of two openings lies in the other. */
static bool is_same(const struct suggested_opening *a, const struct suggested_opening *b)
{
    const double common = overlap(a->begin, a->end, b->begin, b->end) * overlap(a->foot, a->top, b->foot, b->top);
    const double area_a = (a->end - a->begin) * (a->top - a->foot), area_b = (b->end - b->begin) * (b->top - b->foot);
    return a->wall == b->wall && common > SAME * fmin(area_a, area_b);
}

static struct suggested_opening opening_from_rect(const struct wall_raster *r, const struct rect *rect, int wall)
{
    const bool window = rect->foot * r->cell > MAX_FOOT * r->height;
    return (struct suggested_opening){.wall = wall,
                                      .begin = r->begin + rect->begin * r->cell,
                                      .end = r->begin + rect->end * r->cell,
                                      .foot = window ? rect->foot * r->cell : 0,
                                      .top = rect->top * r->cell,
                                      .window = window};
}

static struct rect rect_from_opening(const struct wall_raster *r, const struct suggested_opening *o)
{
    struct rect c = {(int)floor((o->begin - r->begin) / r->cell + 0.5), (int)floor(o->foot / r->cell + 0.5),
                     (int)floor((o->end - r->begin) / r->cell + 0.5), (int)floor(o->top / r->cell + 0.5)};
    if (c.begin < 0) c.begin = 0;
    if (c.foot < 0) c.foot = 0;
    if (c.end > r->across) c.end = r->across;
    if (c.top > r->up) c.top = r->up;
    return c;
}

/* Puts an opening in the place of equal ones, which were found from points. */
static enum status replace(struct suggestion *s, const struct suggested_opening *o, struct err *err)
{
    int kept = 0;
    for (int i = 0; i < s->opening_count; i++)
        if (!is_same(&s->openings[i], o)) s->openings[kept++] = s->openings[i];
    s->opening_count = kept;
    if (array_append(&s->openings, (size_t)s->opening_count, sizeof *s->openings, "openings", err)) return err->status;
    s->openings[s->opening_count++] = *o;
    return ST_OK;
}

/* Whether the views contradict an opening of the raster's wall. */
static bool is_contradicted(const struct suggested_opening *o, const struct wall_raster *r, double *values)
{
    const struct rect rect = rect_from_opening(r, o);
    if (rect.begin >= rect.end || rect.foot >= rect.top) return true;
    const struct evidence e = weigh(r, &rect, values);
    return e.known > MIN_KNOWN && (e.open < MAX_SOLID_OPEN || e.mirrored > MAX_MIRRORED);
}

/* Removes the openings of the wall that the views contradict. */
static void remove_contradicted(struct suggestion *s, int wall, const struct wall_raster *r, double *values)
{
    int kept = 0;
    for (int i = 0; i < s->opening_count; i++) {
        if (s->openings[i].wall == wall && is_contradicted(&s->openings[i], r, values)) continue;
        s->openings[kept++] = s->openings[i];
    }
    s->opening_count = kept;
}

/* Fraction of a rectangle's cells that have state 1. */
static double filled(const struct wall_raster *r, const signed char *state, const struct rect *rect)
{
    int count = 0;
    for (int x = rect->begin; x < rect->end; x++)
        for (int y = rect->foot; y < rect->top; y++) count += state[x * r->up + y] > 0;
    return count / ((double)(rect->end - rect->begin) * (rect->top - rect->foot));
}

/* Mean log luminance of the lines EDGE_BEGIN to EDGE_END beside a position, towards `step`; false: none is known. */
static bool strip_brightness(double *mean, const struct wall_raster *r, const struct rect *rect, bool row, int at,
                             int step)
{
    double sum = 0;
    int count = 0;
    for (int k = EDGE_BEGIN; k < EDGE_END; k++) {
        double line;
        if (!line_brightness(&line, r, rect, row, step > 0 ? at + k : at - 1 - k)) continue;
        sum += line;
        count++;
    }
    *mean = sum / (count ? count : 1);
    return count;
}

/* Number of sides at which the brightness rises by at least a fraction of the contrast to the wall. */
static int edges(const struct wall_raster *r, const struct rect *rect, const struct evidence *e)
{
    const int at[4] = {rect->begin, rect->end, rect->foot, rect->top};
    int count = 0;
    for (int k = 0; k < 4; k++) {
        const int inwards = k % 2 ? -1 : 1;
        double inside, outside;
        count += strip_brightness(&inside, r, rect, k >= 2, at[k], inwards) &&
                 strip_brightness(&outside, r, rect, k >= 2, at[k], -inwards) &&
                 inside - outside >= MIN_EDGE * e->contrast;
    }
    return count;
}

static bool is_brighter(const struct evidence *e)
{
    return e->contrast >= fmax(log(MIN_BRIGHTER), MIN_SPREADS * e->spread);
}

static bool is_window(const struct evidence *e)
{
    return e->open >= MIN_OPEN && e->mirrored <= MAX_MIRRORED && e->border >= MIN_BORDER && is_brighter(e);
}

static bool is_blown_out(const struct wall_raster *r, const signed char *state, const struct rect *rect,
                         const struct evidence *e)
{
    return e->border >= MIN_BORDER && is_brighter(e) && filled(r, state, rect) >= MIN_FILL &&
           edges(r, rect, e) >= MIN_EDGES;
}

static double area_of(const struct suggested_opening *o) { return (o->end - o->begin) * (o->top - o->foot); }

/* Whether an opening covers most of another one that is as large or larger. */
static bool is_within_another(const struct suggestion *s, const struct suggested_opening *o)
{
    for (int i = 0; i < s->opening_count; i++)
        if (is_same(&s->openings[i], o) && (o->doubtful || area_of(o) <= area_of(&s->openings[i]))) return true;
    return false;
}

struct finder { /* of the windows of one wall */
    const struct wall_raster *raster;
    signed char *state; /* of each cell */
    unsigned char *marked;
    int *stack;
    double *values;
    double min_side;
    int wall;
};

/* Adds a region's rectangle if it is a window, or, if `blown`, a doubtful one. */
static enum status try_region(struct suggestion *s, const struct finder *f, const struct rect *bounds, bool blown,
                              struct err *err)
{
    const struct wall_raster *r = f->raster;
    struct rect rect = best_rect(r, f->state, bounds, f->stack);
    if ((rect.end - rect.begin) * r->cell < f->min_side || (rect.top - rect.foot) * r->cell < f->min_side) return ST_OK;
    const struct evidence e = weigh(r, &rect, f->values);
    if (blown ? !is_blown_out(r, f->state, &rect, &e) : !is_window(&e)) return ST_OK;
    refine(&rect, r, e.wall);
    struct suggested_opening o = opening_from_rect(r, &rect, f->wall);
    o.doubtful = blown && !(edges(r, &rect, &e) == 4 && filled(r, f->state, &rect) >= MIN_WINDOW_FILL);
    if (blown && is_within_another(s, &o)) return ST_OK;
    return replace(s, &o, err);
}

/* Tries each region of cells with state 1. */
static enum status try_regions(struct suggestion *s, const struct finder *f, bool blown, struct err *err)
{
    const struct wall_raster *r = f->raster;
    memset(f->marked, 0, (size_t)r->across * (size_t)r->up);
    for (int x = 0; !err->status && x < r->across; x++)
        for (int y = 0; !err->status && y < r->up; y++) {
            if (f->marked[x * r->up + y] || f->state[x * r->up + y] <= 0) continue;
            const struct rect bounds = mark_region(r, f->state, f->marked, f->stack, x, y);
            try_region(s, f, &bounds, blown, err);
        }
    return err->status;
}

/* Median log luminance of the cells where views see the wall. */
static double wall_brightness(const struct wall_raster *r, double *values)
{
    size_t count = 0;
    for (int x = 0; x < r->across; x++)
        for (int y = 0; y < r->up; y++)
            if (state_of(r, x, y) < 0) values[count++] = log_brightness(wall_raster_at(r, x, y));
    return median_of(values, count);
}

static enum status find_windows(struct suggestion *s, const struct finder *f, struct err *err)
{
    const struct wall_raster *r = f->raster;
    for (int x = 0; x < r->across; x++)
        for (int y = 0; y < r->up; y++) f->state[x * r->up + y] = (signed char)state_of(r, x, y);
    if (try_regions(s, f, false, err)) return err->status;
    const double wall = wall_brightness(r, f->values);
    for (int x = 0; x < r->across; x++)
        for (int y = 0; y < r->up; y++) f->state[x * r->up + y] = (signed char)blown_state_of(r, x, y, wall);
    return try_regions(s, f, true, err);
}

enum status windows_suggest(struct suggestion *s, int wall, const struct wall_raster *r,
                            const struct suggest_params *params, struct err *err)
{
    const size_t cells = (size_t)r->across * (size_t)r->up;
    const struct finder f = {.raster = r,
                             .state = malloc(cells + 1),
                             .marked = malloc(cells + 1),
                             .stack = malloc((cells + (size_t)r->up) * sizeof(int)),
                             .values = malloc((cells + 1) * sizeof(double)),
                             .min_side = params->min_opening * r->height,
                             .wall = wall};
    if (!f.state || !f.marked || !f.stack || !f.values) err_nomem(err, "a wall's cells", cells * sizeof *f.values);
    if (!err->status) {
        remove_contradicted(s, wall, r, f.values);
        find_windows(s, &f, err);
    }
    free(f.state);
    free(f.marked);
    free(f.stack);
    free(f.values);
    return err->status;
}
