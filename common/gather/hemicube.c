/* hemicube.c - irradiance by a hemicube.
 *
 * Overview. Half a cube stands on the surface about the point: a top of 2 x 2 at a distance of 1 along the normal, and
 * four sides of 2 x 1. The top has n x n square pixels, each side n x n / 2. One ray goes through the centre of each
 * pixel, and what it sees counts by the pixel's form factor.
 *
 * Mathematics. E = pi sum(L dF), where dF is the share that a pixel has of the hemisphere, weighted by the cosine. Its
 * density is 1 / (pi r^4) on the top, where r^2 = 1 + x^2 + y^2, and z / (pi r^4) on a side, r^2 = 1 + y^2 + z^2 with z
 * the height above the surface. Integrated from the corner (0, 0) to (x, y) or (y, z) they are
 *   top   T(x, y) = (a atan(b') + b atan(a')) / (2 pi),   a = x / sqrt(1 + x^2), b' = y / sqrt(1 + x^2), and so on
 *   side  S(y, z) = (atan(y) - atan(y / sqrt(1 + z^2)) / sqrt(1 + z^2)) / (2 pi)
 * and a pixel's form factor is the sum over its four corners with the signs + - - +. The sum over all pixels therefore
 * telescopes to 4 T(1, 1) + 8 S(1, 1) = 1, whatever n is. The factors of one quarter of the top and of one half of a
 * side stand for the others by symmetry.
 *
 * Error. The pixels of each of the five pictures are coloured like a chess board. If A and B are the picture's
 * irradiance from its white and from its black pixels alone, (A - B) / 2 says what the sampling missed there; the five
 * are added as independent errors. Light that varies linearly across a picture gives A = B, as it leaves the sum exact.
 *
 * Source: [Cohen 1985], in the thesis [Colburn 2014, 5.3.1]. Different here: factors are integrals over the pixels, not
 * values at their centres; pictures are traced and not rasterised; the result says how far off it may be. */
#include <math.h>
#include <stdlib.h>

#include "common/gather/irradiance.h"
#include "common/light/frame.h"
#include "common/math/numbers.h"

enum { SIDES = 4, PARITIES = 2 };

struct hemicube {
    int n;
    double *top;  /* (n / 2)^2: the pixel i, j from the middle */
    double *side; /* (n / 2)^2: the pixel i from the middle and j from the surface */
};

static double top_integral(double x, double y)
{
    const double rx = sqrt(1 + x * x), ry = sqrt(1 + y * y);
    return (x / rx * atan(y / rx) + y / ry * atan(x / ry)) / (2 * PI);
}

static double side_integral(double y, double z)
{
    const double r = sqrt(1 + z * z);
    return (atan(y) - atan(y / r) / r) / (2 * PI);
}

/* Factors of the pixels between (0, 0) and (1, 1). */
static enum status fill_factors(double *to, int half, double integral(double, double), struct err *err)
{
    double *rows = malloc(2 * (size_t)(half + 1) * sizeof *rows);
    if (!rows) return err_nomem(err, "a hemicube", (size_t)half * 16);
    double *low = rows, *high = rows + half + 1;
    for (int i = 0; i <= half; i++) low[i] = 0;
    for (int j = 0; j < half; j++) {
        for (int i = 0; i <= half; i++) high[i] = integral((double)i / half, (double)(j + 1) / half);
        for (int i = 0; i < half; i++)
            to[(size_t)j * (size_t)half + (size_t)i] = (high[i + 1] - low[i + 1]) - (high[i] - low[i]);
        double *swap = low;
        low = high;
        high = swap;
    }
    free(rows);
    return ST_OK;
}

enum status hemicube_make(struct hemicube **h, int n, struct err *err)
{
    *h = NULL;
    if (n < 2 || n > HEMICUBE_MAX || n % 2)
        return err_set(err, ST_USAGE, "a hemicube cannot have %d pixels in a row, wanted an even number from 2 to %d.",
                       n, HEMICUBE_MAX);
    const size_t half = (size_t)n / 2;
    struct hemicube *made = calloc(1, sizeof *made);
    if (made) {
        made->n = n;
        made->top = malloc(half * half * sizeof *made->top);
        made->side = malloc(half * half * sizeof *made->side);
    }
    if (!made || !made->top || !made->side) err_nomem(err, "a hemicube", half * half * 16);
    if (!err->status && !fill_factors(made->top, n / 2, top_integral, err) &&
        !fill_factors(made->side, n / 2, side_integral, err))
        *h = made;
    if (err->status) hemicube_free(made);
    return err->status;
}

void hemicube_free(struct hemicube *h)
{
    if (!h) return;
    free(h->top);
    free(h->side);
    free(h);
}

double hemicube_sum(const struct hemicube *h)
{
    const size_t half = (size_t)h->n / 2;
    double sum = 0;
    for (size_t j = 0; j < half; j++) {
        double row = 0;
        for (size_t i = 0; i < half; i++) row += 4 * h->top[j * half + i] + 8 * h->side[j * half + i];
        sum += row;
    }
    return sum;
}

/* ------------------------------------------------------------------------------------------------------------- sums */

/* What one picture adds up, lane by lane of its packets. Lanes are added at its end, in order. */
struct sums {
    double r[RAY_PACKET], g[RAY_PACKET], b[RAY_PACKET], factor[RAY_PACKET];
};

struct picture {
    const struct hemicube *cube;
    const struct light_field *field;
    struct gather_point at;
    struct vec3 ahead, right, up; /* the ray through (u, v), each -1..1, is ahead + u right + v up */
    bool is_side;
    struct sums sums[PARITIES]; /* pixels of even and of odd i + j */
    double from[LIGHT_SOURCES], nearest, mean_inverse;
};

/* The rays of the pixels (i, j) .. (i + 7, j), their factors, and which of them there are. */
static unsigned aim(struct vec3 direction[RAY_PACKET], double factor[RAY_PACKET], const struct picture *p, int i, int j)
{
    const int n = p->cube->n, half = n / 2, count = n - i < RAY_PACKET ? n - i : RAY_PACKET;
    const int row = p->is_side ? j : j < half ? half - 1 - j : j - half;
    const double *factors = (p->is_side ? p->cube->side : p->cube->top) + (size_t)row * (size_t)half;
    const double v = p->is_side ? (j + 0.5) / half : (2 * j + 1.0) / n - 1;
    const struct vec3 base = vec3_add(p->ahead, vec3_scale(p->up, v));
    for (int k = 0; k < RAY_PACKET; k++) {
        const double u = (2 * (i + k) + 1.0) / n - 1;
        const double x = base.x + u * p->right.x, y = base.y + u * p->right.y, z = base.z + u * p->right.z;
        const double scale = 1 / sqrt(x * x + y * y + z * z);
        direction[k] = vec3_make(x * scale, y * scale, z * scale);
    }
    for (int k = 0; k < RAY_PACKET; k++) {
        const int column = i + k < half ? half - 1 - i - k : i + k - half;
        factor[k] = k < count ? factors[column] : 0;
    }
    return (1u << count) - 1;
}

static void add_packet(struct picture *p, const double factor[RAY_PACKET], const struct light_look seen[RAY_PACKET],
                       unsigned active, int i, int j)
{
    for (int k = 0; k < RAY_PACKET; k++) {
        struct sums *s = &p->sums[(i + j + k) & 1];
        s->r[k] += factor[k] * seen[k].radiance.r;
        s->g[k] += factor[k] * seen[k].radiance.g;
        s->b[k] += factor[k] * seen[k].radiance.b;
        s->factor[k] += factor[k];
    }
    for (int k = 0; k < RAY_PACKET && active >> k & 1; k++) {
        p->from[seen[k].source] += factor[k] * rgb_luminance(seen[k].radiance);
        if (!(seen[k].distance > 0)) continue;
        p->mean_inverse += factor[k] / seen[k].distance;
        if (seen[k].distance < p->nearest) p->nearest = seen[k].distance;
    }
}

static void gather_picture(struct picture *p)
{
    const int rows = p->is_side ? p->cube->n / 2 : p->cube->n;
    struct vec3 from[RAY_PACKET];
    for (int k = 0; k < RAY_PACKET; k++) from[k] = p->at.at;
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < p->cube->n; i += RAY_PACKET) {
            struct vec3 direction[RAY_PACKET];
            struct light_look seen[RAY_PACKET] = {0};
            double factor[RAY_PACKET];
            const unsigned active = aim(direction, factor, p, i, j);
            p->field->look(p->field->ctx, from, p->at.normal, direction, active, seen);
            add_packet(p, factor, seen, active, i, j);
        }
}

static struct rgb add_lanes(const struct sums *s, double *factor)
{
    struct rgb sum = {0, 0, 0};
    *factor = 0;
    for (int k = 0; k < RAY_PACKET; k++) {
        sum = rgb_add(sum, rgb_make(s->r[k], s->g[k], s->b[k]));
        *factor += s->factor[k];
    }
    return sum;
}

static double squared_difference(double a, double b) { return (a - b) * (a - b); }

/* Adds a picture's irradiance to *value and its squared error to *error. */
static void add_picture(struct rgb *value, struct rgb *error, const struct picture *p)
{
    double even_factor, odd_factor;
    const struct rgb even = add_lanes(&p->sums[0], &even_factor), odd = add_lanes(&p->sums[1], &odd_factor);
    *value = rgb_add(*value, rgb_scale(rgb_add(even, odd), PI));
    if (!(even_factor > 0 && odd_factor > 0)) return;
    const double half = 0.5 * PI * (even_factor + odd_factor);
    const struct rgb a = rgb_scale(even, half / even_factor), b = rgb_scale(odd, half / odd_factor);
    *error = rgb_add(
        *error, rgb_make(squared_difference(a.r, b.r), squared_difference(a.g, b.g), squared_difference(a.b, b.b)));
}

void hemicube_irradiance(struct irradiance *e, const struct hemicube *h, const struct light_field *f,
                         struct gather_point p)
{
    struct vec3 x, y;
    struct rgb squared = {0, 0, 0};
    double luminance = 0;
    frame_from_normal(p.normal, &x, &y);
    *e = (struct irradiance){.nearest = INFINITY, .rays = 3 * h->n * h->n};
    for (int face = 0; face <= SIDES; face++) {
        struct picture picture = {.cube = h, .field = f, .at = p, .nearest = e->nearest, .is_side = face > 0};
        const struct vec3 around[SIDES] = {x, y, vec3_scale(x, -1), vec3_scale(y, -1)};
        picture.ahead = face ? around[face - 1] : p.normal;
        picture.right = face ? around[face % SIDES] : x;
        picture.up = face ? p.normal : y;
        gather_picture(&picture);
        add_picture(&e->value, &squared, &picture);
        for (int s = 0; s < LIGHT_SOURCES; s++) e->from[s] += picture.from[s];
        e->mean_inverse += picture.mean_inverse;
        e->nearest = picture.nearest;
    }
    e->error = rgb_make(sqrt(squared.r), sqrt(squared.g), sqrt(squared.b));
    for (int s = 0; s < LIGHT_SOURCES; s++) luminance += e->from[s];
    for (int s = 0; s < LIGHT_SOURCES && luminance > 0; s++) e->from[s] /= luminance;
}
