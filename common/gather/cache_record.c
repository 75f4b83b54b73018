/* cache_record.c - indirect irradiance at a point with its gradients.
 *
 * Overview. The hemisphere is divided into M rings of equal cosine-weighted area and each ring into N cells. One ray
 * goes through a random place of each cell. The radiance and the distance of neighbouring cells say how irradiance
 * changes when the point turns or moves.
 *
 * Mathematics. Ring j is between the angles with sin^2 = j / M and (j + 1) / M. With L the radiance of cell (j, k), r
 * its distance, u_k the tangent towards the middle of column k and v the tangent a quarter turn further [Ward 1992b]:
 *   E      = pi / (M N) sum L
 *   turn   = pi / (M N) sum L tan(t) v           so that dE = turn . (n x n') when the normal n becomes n'
 *   move   = sum_k u_k 2 pi / N sum_j sin t_j cos^2 t_j / min(r, r of ring j - 1) (L - L of ring j - 1)
 *          + sum_k v_k sum_j (sin t_j+1 - sin t_j) / min(r, r of column k - 1) (L - L of column k - 1)
 * where t_j is the angle below ring j and v_k belongs to the edge between the columns k - 1 and k. An edge at distance
 * r moves by 1 / r as the point moves, and what it sweeps over changes by the difference of radiance.
 *
 * The radius is the harmonic mean of distances [Ward 1988], and at most E / |move|: beyond that the gradient alone
 * would change the irradiance by all of it.
 *
 * The standard error comes from the differences of neighbouring cells in a ring: their mean square is twice the
 * variance within a cell, and a little more where light has a slope. For the change from one field to another they are
 * those of b - q a, cell by cell: where the edit changes nothing but the brightness, nothing is left of them.
 *
 * Source: [Ward 1992b]. Different here: lamps and openings are left out, because their light changes at the edges of
 * shadows, which no gradient foresees; the caller gathers it at each point. */
#include "common/gather/cache_record.h"

#include <math.h>

#include "common/base/rng.h"
#include "common/image/luminance.h"
#include "common/light/frame.h"
#include "common/math/numbers.h"

enum { RINGS_MAX = 72, COLUMNS_MAX = CACHE_CELLS_MAX / RINGS_MAX }; /* 16 k cells */

/* One column of cells, before and after its edges. */
struct column {
    struct rgb light[RINGS_MAX];
    double inverse[RINGS_MAX]; /* 1 / distance */
};

struct hemisphere {
    struct cache_record *record;
    const struct light_field *field;
    struct mixture lights;
    struct vec3 x, y;
    struct rng rng;
    int rings, columns;
    struct rgb sum, squares;
    struct cache_cells *cells; /* NULL: not asked for */
};

static struct vec3 tangent(const struct hemisphere *h, double turns)
{
    double c, s;
    turns -= floor(turns);
    fast_cos_sin(turns, &c, &s);
    return vec3_add(vec3_scale(h->x, c), vec3_scale(h->y, s));
}

static void add_gradient(struct vec3 gradient[3], struct vec3 along, struct rgb light)
{
    gradient[0] = vec3_add(gradient[0], vec3_scale(along, light.r));
    gradient[1] = vec3_add(gradient[1], vec3_scale(along, light.g));
    gradient[2] = vec3_add(gradient[2], vec3_scale(along, light.b));
}

/* What the cells of ring j in a column see; each adds to the sums of the record. */
static void add_look(struct hemisphere *h, struct column *c, int j, struct vec3 direction, double turns,
                     const struct light_look *seen)
{
    struct cache_record *r = h->record;
    const bool is_direct = mixture_is_light(&h->lights, direction, seen->source);
    const struct rgb light = is_direct ? rgb_grey(0) : seen->radiance;
    const double cosine = vec3_dot(direction, r->point.normal);
    const double tangent_of = sqrt(fast_max(0, 1 - cosine * cosine)) / fast_max(cosine, 1e-6);
    c->light[j] = light;
    c->inverse[j] = seen->distance > 0 ? 1 / seen->distance : 0;
    h->sum = rgb_add(h->sum, light);
    add_gradient(r->turn, vec3_scale(tangent(h, turns + 0.25), tangent_of), light);
    r->light[seen->source] += rgb_luminance(light);
    r->mean_inverse += c->inverse[j];
    if (seen->distance > 0 && seen->distance < r->nearest) r->nearest = seen->distance;
}

static void trace_column(struct hemisphere *h, struct column *c, int k)
{
    const struct gather_point p = h->record->point;
    for (int j = 0; j < h->rings; j += RAY_PACKET) {
        const int count = h->rings - j < RAY_PACKET ? h->rings - j : RAY_PACKET;
        struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
        struct light_look seen[RAY_PACKET];
        double turns[RAY_PACKET];
        for (int i = 0; i < count; i++) {
            const uint64_t cell = (uint64_t)k * RINGS_MAX + (uint64_t)(j + i);
            uint32_t bits[4];
            rng_block(&h->rng, (uint64_t)h->rings, cell, bits);
            const double sine2 = (j + i + bits[0] * 0x1p-32) / h->rings;
            turns[i] = (k + bits[1] * 0x1p-32) / h->columns;
            from[i] = p.at;
            direction[i] =
                vec3_add(vec3_scale(tangent(h, turns[i]), sqrt(sine2)), vec3_scale(p.normal, sqrt(1 - sine2)));
        }
        h->field->look(h->field->ctx, from, p.normal, direction, (1u << count) - 1, seen);
        for (int i = 0; i < count; i++) add_look(h, c, j + i, direction[i], turns[i], &seen[i]);
        for (int i = 0; h->cells && i < count; i++)
            h->cells->light[k * h->rings + j + i] = (float)rgb_luminance(c->light[j + i]);
    }
}

static struct rgb rgb_sub(struct rgb a, struct rgb b) { return rgb_add(a, rgb_scale(b, -1)); }

/* The part of the gradient by translation of the edges between the rings of a column. */
static void add_rings(struct hemisphere *h, const struct column *c, int k)
{
    const struct vec3 u = tangent(h, (k + 0.5) / h->columns);
    for (int j = 1; j < h->rings; j++) {
        const double sine2 = (double)j / h->rings, inverse = fast_max(c->inverse[j], c->inverse[j - 1]);
        const double rate = 2 * PI / h->columns * sqrt(sine2) * (1 - sine2) * inverse;
        add_gradient(h->record->move, vec3_scale(u, rate), rgb_sub(c->light[j], c->light[j - 1]));
    }
}

/* The part of the edge between two columns; adds to the squared differences. */
static void add_edge(struct hemisphere *h, const struct column *before, const struct column *after, int k)
{
    const struct vec3 v = tangent(h, (double)k / h->columns + 0.25);
    for (int j = 0; j < h->rings; j++) {
        const double width = sqrt((j + 1.0) / h->rings) - sqrt((double)j / h->rings);
        const double rate = width * fast_max(after->inverse[j], before->inverse[j]);
        const struct rgb d = rgb_sub(after->light[j], before->light[j]);
        add_gradient(h->record->move, vec3_scale(v, rate), d);
        h->squares = rgb_add(h->squares, rgb_multiply(d, d));
    }
}

static void trace_columns(struct hemisphere *h)
{
    struct column columns[2], first;
    trace_column(h, &first, 0);
    add_rings(h, &first, 0);
    columns[0] = first;
    for (int k = 1; k < h->columns; k++) {
        trace_column(h, &columns[k & 1], k);
        add_rings(h, &columns[k & 1], k);
        add_edge(h, &columns[(k - 1) & 1], &columns[k & 1], k);
    }
    add_edge(h, &columns[(h->columns - 1) & 1], &first, h->columns);
}

static void finish(struct hemisphere *h)
{
    struct cache_record *r = h->record;
    const double cells = (double)h->rings * h->columns, scale = PI / cells;
    r->value = rgb_scale(h->sum, scale);
    r->error = rgb_luminance(rgb_make(sqrt(h->squares.r / 2), sqrt(h->squares.g / 2), sqrt(h->squares.b / 2))) * scale;
    for (int c = 0; c < 3; c++) r->turn[c] = vec3_scale(r->turn[c], scale);
    for (int s = 0; s < LIGHT_SOURCES; s++) r->light[s] *= scale;
    r->mean_inverse /= cells;
    r->rays = (int)cells;
    r->radius = r->mean_inverse > 0 ? 1 / r->mean_inverse : INFINITY;
    const struct vec3 slope =
        vec3_add(vec3_scale(r->move[0], LUMINANCE_R),
                 vec3_add(vec3_scale(r->move[1], LUMINANCE_G), vec3_scale(r->move[2], LUMINANCE_B)));
    const double value = rgb_luminance(r->value), steep = vec3_length(slope);
    if (steep * r->radius > value) r->radius = value / steep;
}

static void gather(struct hemisphere *h, int rays)
{
    *h->record = (struct cache_record){.point = h->record->point, .nearest = INFINITY};
    h->sum = h->squares = rgb_grey(0);
    h->rings = (int)sqrt(rays / PI);
    h->rings = h->rings < 4 ? 4 : h->rings > RINGS_MAX ? RINGS_MAX : h->rings;
    h->columns = (int)(PI * h->rings);
    if (h->columns > COLUMNS_MAX) h->columns = COLUMNS_MAX;
    if (h->cells) h->cells->rings = h->rings, h->cells->columns = h->columns;
    trace_columns(h);
    finish(h);
}

void cache_record_gather_once(struct cache_record *r, const struct light_field *f, struct gather_point p, int rays,
                              uint64_t key, struct cache_cells *cells)
{
    struct hemisphere h = {.record = r, .field = f, .rng = rng_make(key, "gather", "cache"), .cells = cells};
    r->point = p;
    frame_from_normal(p.normal, &h.x, &h.y);
    mixture_init(&h.lights, f, p, MIXTURE_LIGHTS);
    gather(&h, rays);
}

double cache_cells_error(const struct cache_cells *a, const struct cache_cells *b, double q)
{
    const int cells = a->rings * a->columns;
    double squares = 0;
    for (int i = 0; i < cells; i++) {
        const int beside = i < a->rings ? cells - a->rings + i : i - a->rings; /* in the column before */
        const double d =
            ((double)b->light[i] - q * (double)a->light[i]) - ((double)b->light[beside] - q * (double)a->light[beside]);
        squares += d * d;
    }
    return cells ? sqrt(squares / 2) * PI / cells : 0;
}

void cache_record_gather(struct cache_record *r, const struct light_field *f, struct gather_point p, double target,
                         double beside, int least, uint64_t key)
{
    int spent = 0;
    for (int rays = least;; rays *= 4) {
        cache_record_gather_once(r, f, p, rays, key, NULL);
        spent += r->rays;
        if (r->error <= target * (beside + rgb_luminance(r->value)) || rays >= 16 * least) break;
    }
    r->rays = spent;
}

struct rgb cache_record_at(const struct cache_record *r, struct gather_point p)
{
    const struct vec3 by = vec3_sub(p.at, r->point.at), turned = vec3_cross(r->point.normal, p.normal);
    double c[3] = {r->value.r, r->value.g, r->value.b};
    for (int i = 0; i < 3; i++) c[i] = fast_max(0, c[i] + vec3_dot(r->move[i], by) + vec3_dot(r->turn[i], turned));
    return rgb_make(c[0], c[1], c[2]);
}
