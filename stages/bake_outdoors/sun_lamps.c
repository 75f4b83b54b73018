/* sun_lamps.c - the light indoors that the textures lack, as lamps below the ceilings.
 *
 * Overview. What a surface gets from outdoors and from other surfaces is known from the textures. Lamps that hang in
 * the room, that saturate in all photographs, or that shine in a cone are not in them. But their light is seen where
 * it arrives: the ceiling lamp makes the floor below it brighter than the floor beside it. Where lamps are is unknown
 * at this stage, so that a grid of them is supposed below all ceilings, most of which turn out to be dark.
 *
 * Mathematics. The model is cut into about SQUARES squares (atlas_squares.c). Square i of face f has radiance L_i and
 * irradiance E_i from what is known; lamp j of intensity a_j adds F_ij a_j, with F_ij = cos_i cos_j / r^2 where nothing
 * lies between. The face reflects a share k_f. Each colour on its own,
 *     log L_i = log k_f + log(E_i + sum_j F_ij a_j) + noise of the texture,
 * is solved for a_j >= 0 by Gauss-Newton steps: log k_f is the median of its face, the step a non-negative least
 * squares problem by coordinate descent on the normal equations [Franc 2005], in which the columns have length 1, each
 * face's mean is taken out, and DAMPING holds the last values. Weights 1 / sqrt(1 + (e / NOISE)^2) keep posters and
 * carpets from deciding.
 *   A logarithm is fitted since a product of reflectance and light is seen: fitting E + F a to L / k would shrink 1 / k
 * by the noise of L, and the lamps with it.
 *
 * Limits. Lamps that stand low or shine up, and sharp cones, are only met on average.
 *
 * Source: none for this form. Inverse lighting by a sum of basis lights with non-negative weights is that of [Marschner
 * 1997]. */
#include "stages/bake_outdoors/sun_lamps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/light/ceiling_places.h"
#include "common/light/point_lamp.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "stages/bake_outdoors/sun_fit.h"

enum { SQUARES = 2000, MAX_LAMPS = 256, MOST_RAYS = 8192, STEPS = 20, SWEEPS = 100, FEW = 3 };
static const double SPACING = 0.18; /* of the model's height: of the grid, at least */
static const double BELOW = 0.04;   /* of a room's height: distance of a lamp from the ceiling */
static const double NEAREST = 0.15; /* of the model's height: lamps do not light what is nearer */
static const double TARGET = 0.03;  /* relative error of the known light; more noise in it would pass for lamps */
static const double NOISE = 0.15;   /* of a texture, a logarithm */
static const double DAMPING = 0.05, RELAXED = 0.7;

void sun_lamps_release(struct sun_lamps *l)
{
    free(l->at);
    free(l->intensity);
    *l = (struct sun_lamps){0};
}

/* What a lamp of intensity 1 gives. */
static double lamp_factor(const struct model_rays *model, struct vec3 lamp, struct vec3 at, struct vec3 normal)
{
    if (vec3_length(vec3_sub(lamp, at)) < NEAREST * model_rays_height(model)) return 0;
    return point_lamp_factor(model, POINT_LAMP_DOWNWARDS, lamp, at, normal);
}

struct rgb sun_lamps_irradiance(const struct sun_lamps *l, const struct model_rays *model, struct vec3 at,
                                struct vec3 normal)
{
    double sum[3] = {0, 0, 0};
    for (int j = 0; j < l->count; j++) {
        const double *a = l->intensity[j];
        if (!(a[0] > 0 || a[1] > 0 || a[2] > 0)) continue;
        const double factor = lamp_factor(model, l->at[j], at, normal);
        for (int c = 0; c < 3; c++) sum[c] += factor * a[c];
    }
    return rgb_make(sum[0], sum[1], sum[2]);
}

/* --------------------------------------------------------------------------------------------------------- the grid */

static enum status list_lamps(struct sun_lamps *l, const struct model_rays *model, struct err *err)
{
    const struct ceiling_grid grid = {.rays = model, .spacing = SPACING, .below = BELOW, .most = MAX_LAMPS};
    l->at = malloc(MAX_LAMPS * sizeof *l->at);
    l->intensity = calloc(MAX_LAMPS, sizeof *l->intensity);
    if (!l->at || !l->intensity) return err_nomem(err, "lamps", MAX_LAMPS * sizeof *l->intensity);
    l->count = ceiling_places_list(l->at, &grid);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------- rows */

/* Unlit squares of faces that have some, in order of face. */
struct rows {
    const struct sun_indoors *in;
    const struct sun_lamps *lamps;
    struct atlas_square *list;
    double (*known)[3]; /* irradiance */
    float *factors;     /* of each row and lamp */
    int count;
};

static void fill_range(void *ctx, size_t begin, size_t end, int thread)
{
    const struct rows *r = ctx;
    const struct light_field field = sun_indoors_field(r->in);
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct atlas_square *t = &r->list[i];
        struct irradiance e;
        ray_irradiance_to(&e, &field, (struct gather_point){t->at, t->normal}, TARGET, MOST_RAYS, i);
        r->known[i][0] = e.value.r, r->known[i][1] = e.value.g, r->known[i][2] = e.value.b;
        for (int j = 0; j < r->lamps->count; j++)
            r->factors[i * (size_t)r->lamps->count + (size_t)j] =
                (float)lamp_factor(r->in->scene->model, r->lamps->at[j], t->at, t->normal);
    }
}

/* Keeps the squares that the sun does not reach. */
static enum status list_rows(struct rows *r, const struct atlas_squares *edges, struct vec3 direction, double radius,
                             struct err *err)
{
    const struct atlas_scene *scene = r->in->scene;
    struct atlas_squares squares = {0};
    struct atlas_places near = {0};
    float *share = NULL;
    const double side = atlas_squares_side(scene, SQUARES);
    if (side > 0) atlas_squares_list(&squares, scene, side, 1, NULL, err);
    if (!err->status && !(share = malloc(((size_t)squares.count + 1) * sizeof *share)))
        err_nomem(err, "squares", (size_t)squares.count * sizeof *share);
    if (!err->status && !atlas_places_list(&near, edges, NULL, scene->atlas->atlas.tile_count, err)) {
        sun_shares(share, &squares, scene->model, direction, radius);
        for (int i = 0; i < squares.count; i++)
            if (share[i] == 0 && !atlas_places_near(&near, squares.list[i].tile, squares.list[i].at, squares.side))
                squares.list[r->count++] = squares.list[i];
        r->list = squares.list;
        squares.list = NULL;
    }
    atlas_squares_release(&squares);
    atlas_places_release(&near);
    free(share);
    return err->status;
}

static enum status make_rows(struct rows *r, struct err *err)
{
    const size_t count = (size_t)r->count + 1, lamps = (size_t)r->lamps->count + 1;
    r->known = calloc(count, sizeof *r->known);
    r->factors = calloc(count * lamps, sizeof *r->factors);
    if (!r->known || !r->factors) return err_nomem(err, "squares", count * lamps * sizeof *r->factors);
    parallel_for((size_t)r->count, 8, fill_range, r);
    return ST_OK;
}

static void rows_release(struct rows *r)
{
    free(r->list);
    free(r->known);
    free(r->factors);
}

/* ----------------------------------------------------------------------------------------------------------- a step */

struct step {
    const struct rows *rows;
    int colour;
    double *a;                /* intensities */
    double *total;            /* light of each row */
    double *error, *weight;   /* of each row */
    double *column, *mean;    /* of each lamp, in one row; of each lamp, over a face */
    double *normal, *right;   /* the normal equations */
    struct weighted *scratch; /* of each row */
};

static int end_of_face(const struct rows *r, int first)
{
    int end = first;
    while (end < r->count && r->list[end].tile == r->list[first].tile) end++;
    return end;
}

static bool counts(const struct step *s, int i) { return s->rows->known[i][s->colour] > 0; }

/* The light of a face's rows, and how far they are off the median of their logarithms. */
static void look_at_face(struct step *s, int first, int end)
{
    const struct rows *r = s->rows;
    size_t count = 0;
    for (int i = first; i < end; i++) {
        const float *factors = r->factors + (size_t)i * (size_t)r->lamps->count;
        s->total[i] = r->known[i][s->colour];
        s->weight[i] = 0;
        if (!counts(s, i)) continue;
        for (int j = 0; j < r->lamps->count; j++) s->total[i] += (double)factors[j] * s->a[j];
        s->error[i] = (double)r->list[i].level[s->colour] - log(s->total[i]);
        s->scratch[count++] = (struct weighted){s->error[i], 1};
    }
    if (count < FEW) return;
    const double median = weighted_percentile(s->scratch, count, 0.5);
    for (int i = first; i < end; i++) {
        if (!counts(s, i)) continue;
        const double e = (s->error[i] - median) / NOISE;
        s->weight[i] = 1 / sqrt(1 + e * e);
    }
}

/* A row's columns, and its right side. */
static double fill_columns(struct step *s, int i)
{
    const int lamps = s->rows->lamps->count;
    const float *factors = s->rows->factors + (size_t)i * (size_t)lamps;
    double right = s->error[i];
    for (int j = 0; j < lamps; j++) {
        s->column[j] = (double)factors[j] / s->total[i];
        right += s->column[j] * s->a[j];
    }
    return right;
}

static void add_face(struct step *s, int first, int end)
{
    const int lamps = s->rows->lamps->count;
    double weights = 0, mean = 0;
    memset(s->mean, 0, (size_t)lamps * sizeof *s->mean);
    for (int i = first; i < end; i++) {
        if (!(s->weight[i] > 0)) continue;
        mean += s->weight[i] * fill_columns(s, i);
        weights += s->weight[i];
        for (int j = 0; j < lamps; j++) s->mean[j] += s->weight[i] * s->column[j];
    }
    if (!(weights > 0)) return;
    for (int i = first; i < end; i++) {
        if (!(s->weight[i] > 0)) continue;
        const double right = fill_columns(s, i) - mean / weights;
        for (int j = 0; j < lamps; j++) s->column[j] -= s->mean[j] / weights;
        for (int j = 0; j < lamps; j++) {
            const double scaled = s->weight[i] * s->column[j];
            double *row = s->normal + (size_t)j * (size_t)lamps;
            s->right[j] += scaled * right;
            for (int k = 0; k <= j; k++) row[k] += scaled * s->column[k];
        }
    }
}

/* The step's solution, each coordinate in turn, in units in which the diagonal is 1 + DAMPING^2. */
static void solve(struct step *s)
{
    const size_t lamps = (size_t)s->rows->lamps->count;
    double *length = s->mean, *x = s->column;
    for (size_t j = 0; j < lamps; j++) length[j] = sqrt(s->normal[j * lamps + j]) + 1e-12;
    for (size_t j = 0; j < lamps; j++) {
        x[j] = s->a[j] * length[j];
        s->right[j] = s->right[j] / length[j] + DAMPING * DAMPING * x[j];
        for (size_t k = 0; k <= j; k++) {
            s->normal[j * lamps + k] /= length[j] * length[k];
            s->normal[k * lamps + j] = s->normal[j * lamps + k];
        }
        s->normal[j * lamps + j] += DAMPING * DAMPING;
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (size_t j = 0; j < lamps; j++) {
            double sum = s->right[j];
            for (size_t k = 0; k < lamps; k++) sum -= k == j ? 0 : s->normal[j * lamps + k] * x[k];
            x[j] = fmax(0, sum / s->normal[j * lamps + j]);
        }
    for (size_t j = 0; j < lamps; j++) s->a[j] += RELAXED * (x[j] / length[j] - s->a[j]);
}

static void take_step(struct step *s)
{
    const size_t lamps = (size_t)s->rows->lamps->count;
    memset(s->normal, 0, lamps * lamps * sizeof *s->normal);
    memset(s->right, 0, lamps * sizeof *s->right);
    for (int first = 0; first < s->rows->count;) {
        const int end = end_of_face(s->rows, first);
        look_at_face(s, first, end);
        add_face(s, first, end);
        first = end;
    }
    solve(s);
}

static enum status fit_colour(struct sun_lamps *l, const struct rows *r, int colour, struct err *err)
{
    const size_t lamps = (size_t)l->count, rows = (size_t)r->count;
    double *all = calloc(3 * rows + 4 * lamps + lamps * lamps, sizeof *all);
    struct weighted *scratch = malloc(rows * sizeof *scratch);
    if (!all || !scratch) err_nomem(err, "lamps", (lamps * lamps + 5 * rows) * sizeof *all);
    if (!err->status) {
        struct step s = {.rows = r, .colour = colour, .scratch = scratch, .total = all, .error = all + rows};
        s.weight = s.error + rows;
        s.a = s.weight + rows;
        s.column = s.a + lamps;
        s.mean = s.column + lamps;
        s.right = s.mean + lamps;
        s.normal = s.right + lamps;
        for (int k = 0; k < STEPS; k++) take_step(&s);
        for (size_t j = 0; j < lamps; j++) l->intensity[j][colour] = s.a[j];
    }
    free(all);
    free(scratch);
    return err->status;
}

enum status sun_lamps_fit(struct sun_lamps *l, const struct sun_indoors *in, const struct atlas_squares *edges,
                          struct vec3 direction, double radius, struct err *err)
{
    struct rows rows = {.in = in, .lamps = l};
    *l = (struct sun_lamps){0};
    if (!list_lamps(l, in->bare ? in->bare : in->scene->model, err) && !list_rows(&rows, edges, direction, radius, err))
        make_rows(&rows, err);
    for (int c = 0; !err->status && c < 3 && l->count && rows.count; c++) fit_colour(l, &rows, c, err);
    rows_release(&rows);
    return err->status;
}
