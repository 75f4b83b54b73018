/* legs.c - legs of standing things, found by their colours before the floor; see legs.h.
 *
 * Overview. Depth is found by segments, and a leg is hardly wider than one: most legs get the depth of the floor behind
 * them. But all photographs together show the floor as it is without the leg, because a leg hides another place of it
 * in each. So
 *
 * 1. each place of the floor below and around a thing takes the median of its colours over the views, and their spread;
 * 2. each voxel of the gap below the thing collects the pixels of all views that see it, with nothing before it and
 *    known floor behind it. If it is empty they look like the floor that each should show; if it is part of a leg they
 *    look like each other. Which explains them better?
 * 3. legs are upright, so columns of voxels are judged as a whole. Connected columns that say so are a leg if they are
 *    thin.
 *
 * Colours are compared by their logarithms. Light and shadows lie on the floor in all views alike, so they are no legs;
 * gloss moves, but its mirror image lies below the floor.
 *
 * Source: background subtraction and the visual hull [Laurentini 1994]; the rest is new. */
#include "stages/find_things/legs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/sort.h"

#define REACH      0.4     /* of the model's height: how far beside a gap the floor behind it is looked at */
#define GRADE      0.6f    /* of a pixel of clutter, from trace_ids */
#define SAME_DEPTH 0.02    /* relative: a view shows the model's surface at this depth */
#define DARK       0.05    /* of the first photo's mean radiance: differences of darker colours count less */
#define UNLIKE     0.15f   /* logarithm: differences of colours that noise explains, ... */
#define SPREADS    2.0f    /* ... or that are usual at a place of the floor, in spreads of its colours */
#define SIDES      0.3f    /* logarithm: of the colours of a leg's sides */
#define MOST       2.0f    /* differences in these measures count no more */
#define BETTER     0.3f    /* how much better a leg must explain a column, ... */
#define BEST       0.4f    /* ... and at least one of a leg's columns */
#define THIN       0.12    /* largest share of the gap's columns that a leg fills */
#define SEEN       0.5     /* of a column's voxels, that enough views see */
#define SOLID      (-0.5f) /* distance in a leg, in bands */

enum { BESIDE = 2 };  /* voxels: columns beside a thing's that count as below it */
enum { MIN_GAP = 3 }; /* voxels between floor and thing */
enum { RIM = 2 };     /* voxels below a thing whose pixels may show its edge */
enum { COLOURS = 24, SAMPLES = 16 };
enum { MIN_COLOURS = 4, MIN_VIEWS = 4 }; /* of a place of the floor that is known; of a voxel */
enum { DOUBT = 3 };                      /* views that say neither, beside a voxel's */

struct place { /* of the floor */
    float colours[COLOURS][3], median[3], spread;
    uint8_t count, met; /* met: of the views, at most UINT8_MAX */
};

struct sample { /* of a voxel, in a view */
    float colour[3];
    float unlike; /* the floor that it should show */
};

struct candidate { /* a voxel that may be part of a leg */
    size_t at;     /* in columns and layers of the gap */
    struct sample samples[SAMPLES];
    uint8_t count, met; /* met: of the views, at most UINT8_MAX */
};

struct gap {
    uint32_t id;
    int low[2], size[2]; /* columns below the thing */
    int bottom, top;     /* layers of voxels */
    int *under;          /* of each column: the lowest layer of the thing's surface; INT_MAX: none */
    struct candidate *candidates;
    size_t candidate_count;
    uint8_t *leg; /* of each column */
    float *gain;  /* the same: how much better a leg explains it */
    double floor;
    int place_low[2], place_size[2];
    struct place *places;
};

static size_t columns_of(const struct gap *g) { return (size_t)g->size[0] * (size_t)g->size[1]; }

static size_t places_of(const struct gap *g) { return (size_t)g->place_size[0] * (size_t)g->place_size[1]; }

static int64_t voxel_of(const struct gap *g, const struct voxel_grid *grid, size_t i)
{
    const int64_t x = g->low[0] + (int64_t)(i % (size_t)g->size[0]),
                  y = g->low[1] + (int64_t)(i / (size_t)g->size[0] % (size_t)g->size[1]),
                  z = g->bottom + (int64_t)(i / ((size_t)g->size[0] * (size_t)g->size[1]));
    return (z * grid->size[1] + y) * grid->size[0] + x;
}

static int clamp(int v, int low, int high) { return v < low ? low : v > high ? high : v; }

/* --------------------------------------------------------------------------------------------------------- the gaps */

static void find_under(struct gap *g, const struct thing_volume *v)
{
    const size_t slice = (size_t)v->grid.size[0] * (size_t)v->grid.size[1];
    for (int y = 0; y < g->size[1]; y++)
        for (int x = 0; x < g->size[0]; x++) {
            int lowest = INT32_MAX;
            for (int dy = -BESIDE; dy <= BESIDE; dy++)
                for (int dx = -BESIDE; dx <= BESIDE; dx++) {
                    const int a = g->low[0] + x + dx, b = g->low[1] + y + dy;
                    if (a < 0 || b < 0 || a >= v->grid.size[0] || b >= v->grid.size[1]) continue;
                    for (int z = g->bottom; z < g->top && z < lowest; z++)
                        if (v->id[(size_t)z * slice + (size_t)b * (size_t)v->grid.size[0] + (size_t)a] == g->id)
                            lowest = z;
                }
            g->under[y * g->size[0] + x] = lowest;
        }
}

static void gap_release(struct gap *g)
{
    free(g->under);
    free(g->candidates);
    free(g->leg);
    free(g->gain);
    free(g->places);
    *g = (struct gap){0};
}

/* false: the thing has no gap below. */
static bool lay_out(struct gap *g, const struct legged *t, const struct voxel_grid *grid)
{
    const double low[3] = {t->low.x, t->low.y, t->low.z}, high[3] = {t->high.x, t->high.y, t->high.z};
    const double origin[3] = {grid->origin.x, grid->origin.y, grid->origin.z};
    const int reach = (int)ceil(REACH * grid->size[2]);
    *g = (struct gap){.id = t->id, .floor = t->floor};
    for (int k = 0; k < 2; k++) {
        const int first = (int)floor((low[k] - origin[k]) / grid->voxel) - BESIDE,
                  last = (int)ceil((high[k] - origin[k]) / grid->voxel) + BESIDE;
        g->low[k] = clamp(first, 0, grid->size[k] - 1);
        g->size[k] = clamp(last, 0, grid->size[k] - 1) - g->low[k] + 1;
        g->place_low[k] = clamp(first - reach, 0, grid->size[k] - 1);
        g->place_size[k] = clamp(last + reach, 0, grid->size[k] - 1) - g->place_low[k] + 1;
    }
    g->bottom = clamp((int)round((t->floor - origin[2]) / grid->voxel) + 1, 0, grid->size[2]);
    g->top = clamp((int)ceil((high[2] - origin[2]) / grid->voxel), 0, grid->size[2]);
    return g->top - g->bottom > MIN_GAP;
}

/* The layers of a column that may hold a leg; 0: it is not below the thing. */
static int height_of(const struct gap *g, size_t column)
{
    const int under = g->under[column];
    return under == INT32_MAX || under - RIM - g->bottom < MIN_GAP ? 0 : under - RIM - g->bottom;
}

static enum status list_candidates(struct gap *g, struct err *err)
{
    const size_t columns = columns_of(g);
    size_t count = 0;
    for (size_t c = 0; c < columns; c++) count += (size_t)height_of(g, c);
    if (!(g->candidates = calloc(count + 1, sizeof *g->candidates)))
        return err_nomem(err, "the gap below a thing", count * sizeof *g->candidates);
    for (size_t c = 0; c < columns; c++)
        for (int z = 0; z < height_of(g, c); z++) g->candidates[g->candidate_count++].at = (size_t)z * columns + c;
    return ST_OK;
}

static enum status gap_init(struct gap *g, const struct thing_volume *v, struct err *err)
{
    const size_t columns = columns_of(g);
    g->under = malloc(columns * sizeof *g->under);
    g->leg = calloc(columns, 1);
    g->gain = calloc(columns, sizeof *g->gain);
    g->places = calloc(places_of(g), sizeof *g->places);
    if (!g->under || !g->leg || !g->gain || !g->places)
        return err_nomem(err, "the floor below a thing", places_of(g) * sizeof *g->places);
    find_under(g, v);
    return list_candidates(g, err);
}

enum status legs_init(struct legs *l, const struct thing_volume *surfaces, const struct legged *things, int count,
                      struct err *err)
{
    *l = (struct legs){.grid = surfaces->grid, .gaps = calloc((size_t)count + 1, sizeof *l->gaps)};
    if (!l->gaps) return err_nomem(err, "things on legs", (size_t)count * sizeof *l->gaps);
    for (int k = 0; !err->status && k < count; k++) {
        if (!lay_out(&l->gaps[l->count], &things[k], &surfaces->grid)) continue;
        gap_init(&l->gaps[l->count++], surfaces, err);
    }
    return err->status;
}

void legs_release(struct legs *l)
{
    for (int k = 0; k < l->count; k++) gap_release(&l->gaps[k]);
    free(l->gaps);
    *l = (struct legs){0};
}

/* --------------------------------------------------------------------------------------------------------- a pixel */

/* Where a view shows a point; false: it does not. pixel: of its pixel. */
static bool find_pixel(size_t *pixel, double *u, double *v, double *z, const struct legs_view *view, struct vec3 p)
{
    const struct view *c = &view->camera;
    *z = view_project(c, p, u, v);
    if (!(*z > 0) || !(*u >= 1 && *v >= 1 && *u < c->width - 1 && *v < c->height - 1)) return false;
    *pixel = (size_t)*v * (size_t)c->width + (size_t)*u;
    return view->ids->z[*pixel] > 0 && view->photo->data[4 * *pixel + 3] > 0;
}

/* The logarithm of a photo's colours, bilinear. */
static void colour_at(float out[3], const struct image *photo, double u, double v, float dark)
{
    const double x = u - 0.5, y = v - 0.5;
    const int i = clamp((int)x, 0, photo->width - 2), j = clamp((int)y, 0, photo->height - 2);
    const float fx = (float)(x - i), fy = (float)(y - j);
    const float *a = photo->data + 4 * ((size_t)j * (size_t)photo->width + (size_t)i), *b = a + 4 * photo->width;
    for (int c = 0; c < 3; c++) {
        const float above = a[c] + fx * (a[c + 4] - a[c]), below = b[c] + fx * (b[c + 4] - b[c]);
        out[c] = logf(fmaxf(0, above + fy * (below - above)) + dark);
    }
}

/* ------------------------------------------------------------------------------------------------------- the floor */

struct legs_job {
    struct legs *legs;
    struct gap *gap;
    const struct legs_view *view;
};

static struct vec3 place_point(const struct gap *g, const struct voxel_grid *grid, size_t i)
{
    const double x = g->place_low[0] + (double)(i % (size_t)g->place_size[0]) + 0.5,
                 y = g->place_low[1] + (double)(i / (size_t)g->place_size[0]) + 0.5;
    return vec3_make(grid->origin.x + grid->voxel * x, grid->origin.y + grid->voxel * y, g->floor);
}

/* Of more views than a place can hold, each later one takes the place of an earlier one, in turn. */
static void learn_places(void *ctx, size_t begin, size_t end, int thread)
{
    const struct legs_job *job = ctx;
    const struct legs_view *view = job->view;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        size_t pixel;
        double u, v, z;
        struct place *place = &job->gap->places[i];
        if (!find_pixel(&pixel, &u, &v, &z, view, place_point(job->gap, &job->legs->grid, i))) continue;
        if (fabs(view->scale * (double)view->ids->z[pixel] / z - 1) > SAME_DEPTH) continue;
        if (view->ids->clutter[pixel] > GRADE || place->met == UINT8_MAX) continue;
        colour_at(place->colours[place->met++ % COLOURS], view->photo, u, v, job->legs->dark);
        if (place->count < COLOURS) place->count++;
    }
}

static float dark_of(const struct image *photo)
{
    double sum = 0, count = 0;
    for (size_t i = 0; i < (size_t)photo->width * (size_t)photo->height; i++) {
        const float *p = photo->data + 4 * i;
        if (!(p[3] > 0)) continue;
        sum += (double)(p[0] + p[1] + p[2]) / 3;
        count++;
    }
    return sum > 0 ? (float)(DARK * sum / count) : 0;
}

void legs_learn_floor(struct legs *l, const struct legs_view *view)
{
    if (!(l->dark > 0)) l->dark = dark_of(view->photo);
    if (!(l->dark > 0)) return;
    for (int k = 0; k < l->count; k++) {
        struct legs_job job = {l, &l->gaps[k], view};
        parallel_for(places_of(&l->gaps[k]), 1024, learn_places, &job);
    }
}

static float difference(const float a[3], const float b[3])
{
    return fmaxf(fabsf(a[0] - b[0]), fmaxf(fabsf(a[1] - b[1]), fabsf(a[2] - b[2])));
}

static void settle_place(struct place *p)
{
    double values[COLOURS];
    for (int c = 0; c < 3 && p->count; c++) {
        for (int k = 0; k < p->count; k++) values[k] = (double)p->colours[k][c];
        p->median[c] = (float)sort_median(values, p->count);
    }
    for (int k = 0; k < p->count; k++) values[k] = (double)difference(p->colours[k], p->median);
    p->spread = p->count ? (float)sort_median(values, p->count) : 0;
}

void legs_settle(struct legs *l)
{
    for (int k = 0; k < l->count; k++)
        for (size_t i = 0; i < places_of(&l->gaps[k]); i++) settle_place(&l->gaps[k].places[i]);
}

/* -------------------------------------------------------------------------------------------------------- the legs */

/* The floor that a pixel would show; NULL: something else, or it is not known. */
static const struct place *floor_behind(const struct legs_job *job, size_t pixel, double u, double v)
{
    const struct gap *g = job->gap;
    const struct voxel_grid *grid = &job->legs->grid;
    const struct legs_view *view = job->view;
    const struct vec3 p = view_unproject(&view->camera, u, v, view->scale * (double)view->ids->z[pixel]);
    if (fabs(p.z - g->floor) > grid->voxel) return NULL;
    const int x = (int)floor((p.x - grid->origin.x) / grid->voxel) - g->place_low[0],
              y = (int)floor((p.y - grid->origin.y) / grid->voxel) - g->place_low[1];
    if (x < 0 || y < 0 || x >= g->place_size[0] || y >= g->place_size[1]) return NULL;
    const struct place *place = &g->places[(size_t)y * (size_t)g->place_size[0] + (size_t)x];
    return place->count >= MIN_COLOURS ? place : NULL;
}

static void collect(void *ctx, size_t begin, size_t end, int thread)
{
    const struct legs_job *job = ctx;
    const struct legs_view *view = job->view;
    const struct voxel_grid *grid = &job->legs->grid;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct candidate *c = &job->gap->candidates[i];
        size_t pixel;
        double u, v, z;
        if (c->met == UINT8_MAX) continue;
        if (!find_pixel(&pixel, &u, &v, &z, view, thing_voxel_centre(grid, voxel_of(job->gap, grid, c->at)))) continue;
        const double nearest = view->scale * (double)view->depth->interior.z[pixel];
        const struct place *place = nearest > 0 && nearest < z - grid->voxel ? NULL : floor_behind(job, pixel, u, v);
        if (!place) continue; /* or hidden */
        struct sample *s = &c->samples[c->met++ % SAMPLES];
        colour_at(s->colour, view->photo, u, v, job->legs->dark);
        s->unlike = difference(s->colour, place->median) / fmaxf(UNLIKE, SPREADS * place->spread);
        if (c->count < SAMPLES) c->count++;
    }
}

void legs_look(struct legs *l, const struct legs_view *view)
{
    if (!(l->dark > 0)) return;
    for (int k = 0; k < l->count; k++) {
        struct legs_job job = {l, &l->gaps[k], view};
        parallel_for(l->gaps[k].candidate_count, 1024, collect, &job);
    }
}

/* How much better one colour explains a voxel's pixels than the floor does. */
static float gain_of_leg(const struct candidate *c)
{
    double values[SAMPLES];
    float common[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < c->count; i++) values[i] = (double)c->samples[i].colour[k];
        common[k] = (float)sort_median(values, c->count);
    }
    for (int i = 0; i < c->count; i++) {
        const struct sample *s = &c->samples[i];
        sum += fminf(MOST, s->unlike) - fminf(MOST, difference(s->colour, common) / SIDES);
    }
    return sum / (float)(c->count + DOUBT);
}

enum { EMPTY, UNTRIED, LEG, NO_LEG, WALKED }; /* of a column */

/* Candidates are in order of their columns. */
static void judge_columns(struct gap *g)
{
    const size_t columns = columns_of(g);
    for (size_t first = 0, end; first < g->candidate_count; first = end) {
        const size_t column = g->candidates[first].at % columns;
        float sum = 0;
        size_t seen = 0;
        for (end = first; end < g->candidate_count && g->candidates[end].at % columns == column; end++) {
            if (g->candidates[end].count < MIN_VIEWS) continue;
            sum += gain_of_leg(&g->candidates[end]);
            seen++;
        }
        if (!seen || (double)seen < SEEN * (double)(end - first)) continue;
        g->gain[column] = sum / (float)seen;
        if (g->gain[column] >= BETTER) g->leg[column] = UNTRIED;
    }
}

/* Walks through the columns that are connected with the one at list[0]; returns their number. */
static size_t walk(struct gap *g, size_t *list)
{
    size_t end = 1;
    g->leg[list[0]] = WALKED;
    for (size_t begin = 0; begin < end; begin++) {
        const int x = (int)(list[begin] % (size_t)g->size[0]), y = (int)(list[begin] / (size_t)g->size[0]);
        for (int k = 0; k < 9; k++) {
            const int a = x + k % 3 - 1, b = y + k / 3 - 1;
            if (a < 0 || b < 0 || a >= g->size[0] || b >= g->size[1]) continue;
            const size_t next = (size_t)b * (size_t)g->size[0] + (size_t)a;
            if (g->leg[next] != UNTRIED) continue;
            g->leg[next] = WALKED;
            list[end++] = next;
        }
    }
    return end;
}

static enum status find_legs(struct gap *g, struct err *err)
{
    const size_t columns = columns_of(g);
    size_t *list = malloc((columns + 1) * sizeof *list);
    if (!list) return err_nomem(err, "a leg", columns * sizeof *list);
    judge_columns(g);
    for (size_t i = 0; i < columns; i++) {
        if (g->leg[i] != UNTRIED) continue;
        list[0] = i;
        const size_t count = walk(g, list);
        float best = 0;
        for (size_t n = 0; n < count; n++) best = fmaxf(best, g->gain[list[n]]);
        const bool is_leg = best >= BEST && (double)count <= THIN * (double)columns;
        for (size_t n = 0; n < count; n++) g->leg[list[n]] = is_leg ? LEG : NO_LEG;
    }
    free(list);
    return ST_OK;
}

/* Takes the voxels of a gap's legs, or only counts them if `voxels` is NULL; returns their number. */
static size_t take(int64_t *voxels, const struct gap *g, struct thing_volume *surfaces)
{
    const size_t columns = columns_of(g);
    size_t count = 0;
    for (size_t c = 0; c < columns; c++)
        for (int z = 0; g->leg[c] == LEG && z < g->under[c] - g->bottom; z++) {
            const int64_t at = voxel_of(g, &surfaces->grid, (size_t)z * columns + c);
            if (surfaces->id[at]) continue;
            if (voxels) {
                surfaces->id[at] = g->id;
                surfaces->distance[at] = SOLID;
                voxels[count] = at;
            }
            count++;
        }
    return count;
}

enum status legs_take(int64_t **voxels, size_t *count, struct legs *l, struct thing_volume *surfaces, struct err *err)
{
    size_t most = 1;
    *count = 0;
    *voxels = NULL;
    for (int k = 0; !err->status && k < l->count; k++)
        if (!find_legs(&l->gaps[k], err)) most += take(NULL, &l->gaps[k], surfaces);
    if (!err->status && !(*voxels = malloc(most * sizeof **voxels))) err_nomem(err, "legs", most * sizeof **voxels);
    for (int k = 0; !err->status && k < l->count; k++) *count += take(*voxels + *count, &l->gaps[k], surfaces);
    return err->status;
}
