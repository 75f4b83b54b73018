/* outdoors_gather.c - makes the picture of the outdoors.
 *
 * Overview. Everything outside counts as infinitely far away, so a direction is all that a pixel needs. The picture is
 * made in two passes over the pictures that show some of the outdoors; one of them is in memory at a time.
 *   1. At the centre of each cell of CELL x CELL px, each picture is asked what it shows. A cell keeps the best
 *      MAX_CANDIDATES. From these come one gain for each photo (outdoors_gains.c) and the picture that shows the cell
 *      (outdoors_choose.c).
 *   2. The chosen pictures are resampled. The weight of a picture at a pixel is the share of the four nearest cells
 *      that chose it, interpolated bilinearly: 1 inside an area of one picture, with a transition of a cell's width to
 *      the next, so that no edge shows where two pictures meet. Pictures that are not chosen there have a very small
 *      weight, which only counts where the chosen ones show nothing. A pixel is the mean of 2 x 2 samples.
 * What remains is guessed afterwards (outdoors_guess.c).
 *
 * Source: looking up what lies outside by direction in a lighting reference image is [Colburn 2014, 5.3.2]. Different
 * here: photographs fill what no reference image shows, and directions that nothing shows are guessed and marked. */
#include "stages/bake_outdoors/outdoors_gather.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/image/luminance.h"
#include "common/math/numbers.h"

enum { ROWS = 8, SAMPLES = 2 };
#define ELSEWHERE 1e-4f /* weight of a picture that is not chosen, of one that is */
#define CLIPPED   1e-2f /* weight of a clipped sample */

struct gather {
    struct outdoors *out;
    struct outdoors_cells cells;
    struct outdoors_picture *pictures;
    const struct outdoors_params *params;
    double *gain;          /* by photo */
    bool *shows;           /* by picture */
    float *weights;        /* by pixel, beside out->rgb */
    float *strength;       /* by pixel: the largest weight of a picture so far, whose kind `source` is */
    int current;           /* picture */
    double (*azimuths)[2]; /* cosine and sine, of each column of samples */
};

/* -------------------------------------------------------------------------------------------------------- the model */

enum status outdoors_model_read(struct outdoors_model *m, const char *path, struct provenance *prov, struct err *err)
{
    *m = (struct outdoors_model){0};
    if (model_rays_read(&m->rays, path, MODEL_WITHOUT_GLASS, prov, err)) return err->status;
    const struct solid_mesh *mesh = &m->rays.mesh;
    m->normals = calloc((size_t)m->rays.ids, sizeof *m->normals);
    if (!m->normals) return err_nomem(err, "faces", (size_t)m->rays.ids * sizeof *m->normals);
    for (int i = 0; i < mesh->face_count; i++) m->normals[solid_face_id(mesh, i)] = mesh->faces[i].normal;
    return ST_OK;
}

void outdoors_model_release(struct outdoors_model *m)
{
    if (!m) return;
    model_rays_release(&m->rays);
    free(m->normals);
    *m = (struct outdoors_model){0};
}

/* ------------------------------------------------------------------------------------------------------- candidates */

/* Whether a goes before b in a cell's list. */
static bool precedes(const struct outdoors_candidate *a, const struct outdoors_candidate *b,
                     const struct outdoors_picture *pictures)
{
    const int rank = outdoors_rank(a, pictures) - outdoors_rank(b, pictures);
    return rank ? rank > 0 : a->score > b->score;
}

static void insert(struct outdoors_candidate list[MAX_CANDIDATES], const struct outdoors_candidate *c,
                   const struct outdoors_picture *pictures)
{
    int at = MAX_CANDIDATES;
    while (at > 0 && (list[at - 1].picture < 0 || precedes(c, &list[at - 1], pictures))) at--;
    if (at == MAX_CANDIDATES) return;
    memmove(list + at + 1, list + at, (size_t)(MAX_CANDIDATES - 1 - at) * sizeof *list);
    list[at] = *c;
}

static void ask_rows(void *ctx, size_t begin, size_t end, int thread)
{
    struct gather *g = ctx;
    const struct outdoors_picture *p = &g->pictures[g->current];
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < g->cells.width; x++) {
            struct outdoors_candidate c = {.picture = g->current};
            float rgb[3], facing;
            const struct vec3 d = outdoors_direction(g->out, (x + 0.5) * CELL, ((double)y + 0.5) * CELL);
            const enum outdoors_state state = outdoors_picture_sample(rgb, &facing, p, d);
            if (state == SHOWS_NOTHING) continue;
            c.luminance = luminance_of(rgb);
            c.clipped = state == SHOWS_CLIPPED;
            c.score = facing * (float)sqrt(p->coverage);
            insert(g->cells.lists[y * (size_t)g->cells.width + (size_t)x], &c, g->pictures);
        }
}

/* ------------------------------------------------------------------------------------------------------- resampling */

/* The share of the four cells around a pixel that chose the current picture. */
static float chosen_here(const struct gather *g, int x, int y)
{
    const struct outdoors_cells *cells = &g->cells;
    const float u = ((float)x + 0.5f) / CELL - 0.5f, v = ((float)y + 0.5f) / CELL - 0.5f;
    const int left = (int)floorf(u), top = (int)floorf(v);
    const float fx = u - (float)left, fy = v - (float)top;
    float share = 0;
    for (int k = 0; k < 4; k++) {
        const int cx = (left + (k & 1) + cells->width) % cells->width;
        int cy = top + (k >> 1);
        cy = cy < 0 ? 0 : cy >= cells->height ? cells->height - 1 : cy;
        if (cells->chosen[(size_t)cy * (size_t)cells->width + (size_t)cx] == g->current)
            share += (k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy);
    }
    return share;
}

/* The directions of the samples of a row of pixels. */
struct sample_row {
    double cosine[SAMPLES], sine[SAMPLES]; /* of their elevations */
};

static struct vec3 sample_direction(const struct gather *g, const struct sample_row *row, int x, int k)
{
    const double *azimuth = g->azimuths[SAMPLES * x + k % SAMPLES], cosine = row->cosine[k / SAMPLES];
    return vec3_make(cosine * azimuth[0], cosine * azimuth[1], row->sine[k / SAMPLES]);
}

/* The mean of the samples of a pixel. False: none shows the outdoors. */
static bool sample_pixel(float rgb[3], bool *clipped, const struct gather *g, const struct sample_row *row, int x)
{
    int count = 0;
    rgb[0] = rgb[1] = rgb[2] = 0;
    *clipped = false;
    for (int k = 0; k < SAMPLES * SAMPLES; k++) {
        float one[3];
        const struct vec3 d = sample_direction(g, row, x, k);
        const enum outdoors_state state = outdoors_picture_sample(one, NULL, &g->pictures[g->current], d);
        if (state == SHOWS_NOTHING) continue;
        *clipped |= state == SHOWS_CLIPPED;
        for (int c = 0; c < 3; c++) rgb[c] += one[c];
        count++;
    }
    for (int c = 0; count && c < 3; c++) rgb[c] /= (float)count;
    return count > 0;
}

static void add_pixel(struct gather *g, const struct sample_row *row, int x, int y)
{
    const struct outdoors_picture *p = &g->pictures[g->current];
    const size_t at = (size_t)y * (size_t)g->out->width + (size_t)x;
    float rgb[3];
    bool clipped;
    if (vec3_dot(sample_direction(g, row, x, 0), p->axis) < p->cone - PI / g->out->height) return;
    if (!sample_pixel(rgb, &clipped, g, row, x)) return;
    const float weight = (chosen_here(g, x, y) + ELSEWHERE) * (clipped ? CLIPPED : 1);
    const float gain = (float)g->gain[p->photo] * weight;
    for (size_t c = 0; c < 3; c++) g->out->rgb[3 * at + c] += gain * rgb[c];
    g->weights[at] += weight;
    if (weight <= g->strength[at]) return;
    g->strength[at] = weight;
    g->out->source[at] = p->reference ? OUTDOORS_REFERENCE : OUTDOORS_PHOTO;
}

static void add_rows(void *ctx, size_t begin, size_t end, int thread)
{
    struct gather *g = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++) {
        struct sample_row row;
        for (int k = 0; k < SAMPLES; k++) {
            const double elevation = PI / 2 - PI * ((double)y + (k + 0.5) / SAMPLES) / g->out->height;
            row.cosine[k] = cos(elevation);
            row.sine[k] = sin(elevation);
        }
        for (int x = 0; x < g->out->width; x++) add_pixel(g, &row, x, (int)y);
    }
}

static void find_azimuths(struct gather *g)
{
    for (int x = 0; x < SAMPLES * g->out->width; x++) {
        const double azimuth = 2 * PI * (x + 0.5) / (SAMPLES * g->out->width) - PI;
        g->azimuths[x][0] = cos(azimuth);
        g->azimuths[x][1] = sin(azimuth);
    }
}

static void divide_by_weights(struct gather *g)
{
    const size_t pixels = (size_t)g->out->width * (size_t)g->out->height;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3 && g->weights[i] > 0; c++) g->out->rgb[3 * i + c] /= g->weights[i];
}

/* ------------------------------------------------------------------------------------------------------- the passes */

static enum status init(struct gather *g, int count, int photos, struct err *err)
{
    if (outdoors_init(g->out, g->params->height, err)) return err->status;
    g->cells.width = g->out->width / CELL;
    g->cells.height = g->out->height / CELL;
    const size_t cells = (size_t)g->cells.width * (size_t)g->cells.height, pixels = cells * CELL * CELL;
    g->cells.lists = malloc(cells * sizeof *g->cells.lists);
    g->cells.chosen = malloc(cells * sizeof *g->cells.chosen);
    g->gain = calloc((size_t)photos + 1, sizeof *g->gain);
    g->shows = calloc((size_t)count + 1, sizeof *g->shows);
    g->weights = calloc(pixels, sizeof *g->weights);
    g->strength = calloc(pixels, sizeof *g->strength);
    g->azimuths = calloc(SAMPLES * (size_t)g->out->width, sizeof *g->azimuths);
    if (!g->cells.lists || !g->cells.chosen || !g->gain || !g->shows || !g->weights || !g->strength || !g->azimuths)
        return err_nomem(err, "a picture of the outdoors", cells * sizeof *g->cells.lists + pixels * 8);
    for (size_t i = 0; i < cells; i++)
        for (int k = 0; k < MAX_CANDIDATES; k++) g->cells.lists[i][k].picture = -1;
    find_azimuths(g);
    return ST_OK;
}

static enum status load_picture(struct gather *g, int picture, bool *shows, const struct outdoors_model *model,
                                struct provenance *prov, struct err *err)
{
    const struct outdoors_limits limits = {g->params->edge, g->params->max_clutter};
    return outdoors_picture_load(&g->pictures[picture], shows, &model->rays, model->normals, &limits, prov, err);
}

static enum status first_pass(struct gather *g, int count, const struct outdoors_model *model, struct provenance *prov,
                              struct progress *progress, struct err *err)
{
    for (int i = 0; i < count; i++) {
        g->current = i;
        if (load_picture(g, i, &g->shows[i], model, prov, err)) return err->status;
        progress_add(progress, 1);
        if (!g->shows[i]) continue;
        parallel_for((size_t)g->cells.height, ROWS, ask_rows, g);
        outdoors_picture_unload(&g->pictures[i]);
    }
    return ST_OK;
}

static bool is_chosen(const struct gather *g, int picture)
{
    const size_t cells = (size_t)g->cells.width * (size_t)g->cells.height;
    for (size_t i = 0; i < cells; i++)
        if (g->cells.chosen[i] == picture) return true;
    return false;
}

static enum status second_pass(struct gather *g, int count, struct outdoors_totals *totals,
                               const struct outdoors_model *model, struct progress *progress, struct err *err)
{
    for (int i = 0; i < count; i++) {
        bool shows;
        progress_add(progress, 1);
        if (!is_chosen(g, i)) continue;
        g->current = i;
        if (load_picture(g, i, &shows, model, NULL, err)) return err->status;
        parallel_for((size_t)g->out->height, ROWS, add_rows, g);
        outdoors_picture_unload(&g->pictures[i]);
        *(g->pictures[i].reference ? &totals->references : &totals->photos) += 1;
    }
    divide_by_weights(g);
    return ST_OK;
}

static void sum_up(struct outdoors_totals *t, const struct gather *g, int count)
{
    double rows = 0;
    t->min_gain = t->max_gain = 1;
    for (int i = 0; i < count; i++) {
        if (!g->shows[i] || g->pictures[i].reference) continue;
        t->min_gain = fmin(t->min_gain, g->gain[g->pictures[i].photo]);
        t->max_gain = fmax(t->max_gain, g->gain[g->pictures[i].photo]);
    }
    for (int y = 0; y < g->out->height; y++) {
        const struct vec3 d = outdoors_direction(g->out, 0, y + 0.5);
        const double area = hypot(d.x, d.y) / g->out->width;
        for (int x = 0; x < g->out->width; x++) {
            const uint8_t source = g->out->source[(size_t)y * (size_t)g->out->width + (size_t)x];
            t->by_references += source == OUTDOORS_REFERENCE ? area : 0;
            t->by_photos += source == OUTDOORS_PHOTO ? area : 0;
        }
        rows += area * g->out->width;
    }
    t->by_references /= rows;
    t->by_photos /= rows;
}

enum status outdoors_gather(struct outdoors *o, struct outdoors_totals *totals, struct outdoors_picture *pictures,
                            int count, int photos, const struct outdoors_model *model,
                            const struct outdoors_params *params, struct provenance *prov, struct err *err)
{
    struct gather g = {.out = o, .pictures = pictures, .params = params};
    struct progress progress;
    *totals = (struct outdoors_totals){0};
    init(&g, count, photos, err);
    progress_start(&progress, "outdoors", 2 * (int64_t)count, "pictures");
    if (!err->status && !first_pass(&g, count, model, prov, &progress, err))
        outdoors_find_gains(g.gain, photos, &g.cells, pictures, err);
    if (!err->status) {
        outdoors_choose(&g.cells, pictures, g.gain, params->agree);
        second_pass(&g, count, totals, model, &progress, err);
    }
    progress_end(&progress);
    if (!err->status) sum_up(totals, &g, count);
    free(g.cells.lists);
    free(g.cells.chosen);
    free(g.gain);
    free(g.shows);
    free(g.weights);
    free(g.strength);
    free(g.azimuths);
    return err->status;
}
