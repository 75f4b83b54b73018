/* strategy.c - directions of rays and their densities.
 *
 * Overview. Irradiance is the mean of L cos / p over directions that are chosen with density p. The cosine suits light
 * from everywhere. An emitter fills a small part of the hemisphere; rays towards it leave the noise to what hides it.
 *
 * Mathematics. Density per solid angle:
 *   cosine     cos / pi
 *   lobe       that of brdf_sample(); directions below the horizon are lost, as brdf_sample() says
 *   sun        1 / (2 pi (1 - cone)) within its cone
 *   rectangle  1 / solid angle, uniform over the spherical rectangle [Urena 2013]
 *   disk, quad t^2 / (A cos'), t the distance and cos' the cosine at the emitter: uniform over its area A
 * Disks by area have a smooth density too, and need no special case where the horizon cuts them. Rectangles that are
 * seen under less than 1e-6 sr are chosen by area, because their solid angle is a difference of angles near pi.
 *
 * The estimate of an emitter's irradiance is the mean over a lattice of 4 x 4 points of its area, each with the lamp's
 * fall-off and cut and without what hides it. An emitter that does not rise above the horizon, that the point is behind
 * or whose cone misses the point cannot light it. Cones are kept unless all 16 points are two cells' width outside, so
 * that a cone's edge is not lost between points. A cone that is narrower than the emitter is sampled itself: the disk
 * that it cuts out of the emitter's plane.
 *
 * Source: [Veach 1995], [Urena 2013]. */
#include "common/gather/strategy.h"

#include <math.h>

#include "common/light/frame.h"
#include "common/math/numbers.h"

static const double SMALL_ANGLE = 1e-6; /* sr */
static const double FLAT = 1e-9;        /* of an emitter's size: how near to its plane a point lies in it */

static void start(struct strategy *s, enum strategy_kind kind, struct gather_point p)
{
    *s = (struct strategy){.kind = kind, .point = p};
    frame_from_normal(p.normal, &s->x, &s->y);
}

void strategy_cosine(struct strategy *s, struct gather_point p) { start(s, STRATEGY_COSINE, p); }

void strategy_lobe(struct strategy *s, struct gather_point p, const struct brdf *lobe, struct vec3 view)
{
    start(s, STRATEGY_LOBE, p);
    s->lobe = lobe;
    s->view = view;
}

/* --------------------------------------------------------------------------------------------------------- emitters */

static bool see_sun(struct strategy *s, const struct emitter *e)
{
    const double rise = vec3_dot(e->normal, s->point.normal), sine = sqrt(fast_max(0, 1 - e->cone * e->cone));
    if (!(e->cone < 1) || !(rise > -sine)) return false;
    s->area = 2 * PI * (1 - e->cone);
    s->estimate = e->luminance * s->area * fast_max(rise, 0.25 * sine);
    return true;
}

/* The rectangle's corners in the frame of its axes, and the terms of its solid angle. */
static void see_rectangle(struct seen_rectangle *r, const struct emitter *e, struct vec3 to)
{
    const double half_x = vec3_length(e->x), half_y = vec3_length(e->y);
    r->x = vec3_scale(e->x, 1 / half_x);
    r->y = vec3_scale(e->y, 1 / half_y);
    r->z = vec3_cross(r->x, r->y);
    r->z0 = vec3_dot(to, r->z);
    if (r->z0 > 0) {
        r->z = vec3_scale(r->z, -1);
        r->z0 = -r->z0;
    }
    const double cx = vec3_dot(to, r->x), cy = vec3_dot(to, r->y), zz = r->z0 * r->z0;
    r->x0 = cx - half_x;
    r->x1 = cx + half_x;
    r->y0 = cy - half_y;
    r->y1 = cy + half_y;
    /* z of the unit normals of the planes through the point and an edge: y0, x1, y1, x0 */
    const double b0 = -r->y0 / sqrt(r->y0 * r->y0 + zz), a1 = r->x1 / sqrt(r->x1 * r->x1 + zz);
    const double b1 = r->y1 / sqrt(r->y1 * r->y1 + zz), a0 = -r->x0 / sqrt(r->x0 * r->x0 + zz);
    r->b0 = b0;
    r->b1 = b1;
    r->offset = 2 * PI - acos(-b1 * a0) - acos(-a0 * b0);
    r->solid_angle = acos(-b0 * a1) + acos(-a1 * b1) - r->offset;
}

/* Light that a place of the emitter sends to the point, per area; *in_cone: whether the lamp's cone, widened by
 * `margin`, reaches the point. */
static double place_light(const struct strategy *s, struct vec3 to, double margin, bool *in_cone)
{
    const struct emitter *e = s->emitter;
    const double distance = vec3_length(to);
    const double rise = vec3_dot(to, s->point.normal) / distance, cosine = -vec3_dot(to, e->normal) / distance;
    if (!(rise > 0 && cosine > 0)) return 0;
    const double angle = acos(fast_min(cosine, 1));
    if (angle <= e->beta + margin / distance) *in_cone = true;
    if (angle > e->beta) return 0;
    const double fall = e->exponent > 0 ? pow(cosine, e->exponent) : 1;
    return e->luminance * fall * rise * cosine / (distance * distance);
}

/* The estimate; false: no light. */
static bool estimate_area(struct strategy *s)
{
    enum { STEPS = 4 };
    const struct emitter *e = s->emitter;
    const double cell = (vec3_length(e->x) + vec3_length(e->y)) / STEPS;
    double sum = 0;
    bool in_cone = false, risen = false;
    for (int i = 0; i <= STEPS; i += STEPS)
        for (int j = 0; j <= STEPS; j += STEPS) {
            const double a = 2.0 * i / STEPS - 1, b = 2.0 * j / STEPS - 1;
            const struct vec3 to = vec3_add(s->to, vec3_add(vec3_scale(e->x, a), vec3_scale(e->y, b)));
            risen |= vec3_dot(to, s->point.normal) > 0;
        }
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            const double a = (2 * i + 1.0) / STEPS - 1, b = (2 * j + 1.0) / STEPS - 1;
            const struct vec3 to = vec3_add(s->to, vec3_add(vec3_scale(e->x, a), vec3_scale(e->y, b)));
            sum += place_light(s, to, 2 * cell, &in_cone);
        }
    s->estimate = fast_min(sum * s->area / (STEPS * STEPS), PI * e->luminance);
    return risen && (in_cone || (e->beta >= 0.49 * PI && sum == 0));
}

/* False: no area. */
static bool set_area(struct strategy *s, struct vec3 to, struct vec3 x, struct vec3 y)
{
    const struct vec3 n = vec3_cross(x, y);
    const double nn = vec3_dot(n, n);
    if (!(nn > 0)) return false;
    s->to = to;
    s->half[0] = x;
    s->half[1] = y;
    s->dual[0] = vec3_scale(vec3_cross(y, n), 1 / nn);
    s->dual[1] = vec3_scale(vec3_cross(n, x), 1 / nn);
    s->area = (s->kind == STRATEGY_DISK ? PI : 4) * sqrt(nn);
    return true;
}

/* What a narrow cone leaves of the emitter lies in a disk about the foot of the point's perpendicular. Takes that disk
 * if it is the smaller one. False: nothing is left. */
static bool narrow_to_cone(struct strategy *s, double height)
{
    const struct emitter *e = s->emitter;
    const double radius = e->beta < 0.5 * PI ? height * tan(e->beta) : INFINITY;
    struct vec3 x, y;
    if (!(PI * radius * radius < s->area)) return true;
    s->kind = STRATEGY_DISK;
    frame_from_normal(e->normal, &x, &y);
    return set_area(s, vec3_scale(e->normal, -height), vec3_scale(x, radius), vec3_scale(y, radius));
}

static bool see_area(struct strategy *s, const struct emitter *e)
{
    const double size = vec3_length(e->x) + vec3_length(e->y);
    const struct vec3 to = vec3_sub(e->centre, s->point.at);
    const double height = -vec3_dot(to, e->normal);
    if (!(height > FLAT * size) || !set_area(s, to, e->x, e->y) || !estimate_area(s)) return false;
    if (s->kind == STRATEGY_QUAD && fabs(vec3_dot(e->x, e->y)) <= 1e-9 * size * size) {
        see_rectangle(&s->rectangle, e, s->to);
        if (s->rectangle.solid_angle > SMALL_ANGLE) s->kind = STRATEGY_RECTANGLE;
    }
    return narrow_to_cone(s, height);
}

bool strategy_emitter(struct strategy *s, struct gather_point p, const struct emitter *e)
{
    static const enum strategy_kind kinds[] = {
        [EMITTER_DISK] = STRATEGY_DISK, [EMITTER_QUAD] = STRATEGY_QUAD, [EMITTER_SUN] = STRATEGY_SUN};
    start(s, kinds[e->kind], p);
    s->emitter = e;
    if (!(e->luminance > 0)) return false;
    return e->kind == EMITTER_SUN ? see_sun(s, e) : see_area(s, e);
}

/* ---------------------------------------------------------------------------------------------------------- samples */

/* a s + b t + c u, in each lane */
static struct directions4 sum4(struct vec3 a, f64x4 s, struct vec3 b, f64x4 t, struct vec3 c, f64x4 u)
{
    return (struct directions4){a.x * s + b.x * t + c.x * u, a.y * s + b.y * t + c.y * u, a.z * s + b.z * t + c.z * u};
}

static f64x4 dot4(const struct directions4 *d, struct vec3 v) { return d->x * v.x + d->y * v.y + d->z * v.z; }

static struct directions4 normalized4(struct directions4 d)
{
    const f64x4 scale = 1 / f64x4_sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    return (struct directions4){scale * d.x, scale * d.y, scale * d.z};
}

static f64x4 clamp4(f64x4 x, double low, double high)
{
    return f64x4_min(f64x4_max(x, f64x4_all(low)), f64x4_all(high));
}

static struct directions4 sample_cosine(const struct strategy *s, f64x4 u, f64x4 v)
{
    const f64x4 r = f64x4_sqrt(u);
    f64x4 c, sn;
    fast_cos_sin4(v, &c, &sn);
    return sum4(s->x, r * c, s->y, r * sn, s->point.normal, f64x4_sqrt(1 - u));
}

static struct directions4 sample_sun(const struct strategy *s, f64x4 u, f64x4 v)
{
    const f64x4 less = u * (1 - s->emitter->cone); /* 1 - cosine */
    const f64x4 sine = f64x4_sqrt(less * (2 - less));
    struct vec3 x, y;
    f64x4 c, sn;
    frame_from_normal(s->emitter->normal, &x, &y);
    fast_cos_sin4(v, &c, &sn);
    return sum4(x, sine * c, y, sine * sn, s->emitter->normal, 1 - less);
}

static struct directions4 sample_rectangle(const struct seen_rectangle *r, f64x4 u, f64x4 v)
{
    f64x4 c, sn;
    fast_cos_sin4((u * r->solid_angle + r->offset) / (2 * PI), &c, &sn);
    const f64x4 f = (c * r->b0 - r->b1) / sn, one = f64x4_if(f > 0, f64x4_all(1), f64x4_all(-1));
    const f64x4 cosine = clamp4(one / f64x4_sqrt(f * f + r->b0 * r->b0), -1, 1);
    const f64x4 sine = f64x4_sqrt(f64x4_max(1 - cosine * cosine, f64x4_all(1e-300)));
    const f64x4 x = clamp4(-cosine * r->z0 / sine, r->x0, r->x1), dd = x * x + r->z0 * r->z0;
    const f64x4 h0 = r->y0 / f64x4_sqrt(dd + r->y0 * r->y0), h1 = r->y1 / f64x4_sqrt(dd + r->y1 * r->y1);
    const f64x4 h = h0 + v * (h1 - h0), hh = h * h;
    const f64x4 end = f64x4_if(h > 0, f64x4_all(r->y1), f64x4_all(r->y0));
    const f64x4 y = f64x4_if(hh < 1 - 1e-12, h * f64x4_sqrt(dd / (1 - hh)), end);
    return normalized4(sum4(r->x, x, r->y, y, r->z, f64x4_all(r->z0)));
}

static struct directions4 sample_area(const struct strategy *s, f64x4 u, f64x4 v)
{
    f64x4 a = 2 * u - 1, b = 2 * v - 1;
    if (s->kind == STRATEGY_DISK) {
        const f64x4 r = f64x4_sqrt(u);
        fast_cos_sin4(v, &a, &b);
        a *= r;
        b *= r;
    }
    return normalized4(sum4(s->half[0], a, s->half[1], b, s->to, f64x4_all(1)));
}

static struct directions4 sample_lobe(const struct strategy *s, f64x4 u, f64x4 v)
{
    struct directions4 d = {{0}, {0}, {0}};
    for (int k = 0; k < 4; k++) {
        const double three[3] = {0, u[k], v[k]};
        struct vec3 direction;
        if (!brdf_sample(s->lobe, s->point.normal, s->view, three, &direction)) continue;
        d.x[k] = direction.x, d.y[k] = direction.y, d.z[k] = direction.z;
    }
    return d;
}

unsigned strategy_sample4(const struct strategy *s, f64x4 u, f64x4 v, struct directions4 *d)
{
    switch (s->kind) {
    case STRATEGY_COSINE:
        *d = sample_cosine(s, u, v);
        break;
    case STRATEGY_LOBE:
        *d = sample_lobe(s, u, v);
        break;
    case STRATEGY_SUN:
        *d = sample_sun(s, u, v);
        break;
    case STRATEGY_RECTANGLE:
        *d = sample_rectangle(&s->rectangle, u, v);
        break;
    case STRATEGY_DISK:
    case STRATEGY_QUAD:
        *d = sample_area(s, u, v);
        break;
    }
    return i64x4_signs(dot4(d, s->point.normal) > 0);
}

_Static_assert(RAY_PACKET == SOBOL_BATCH && RAY_PACKET % 4 == 0, "packets are batches of samples");

int strategy_packet(const struct strategy *s, const struct sobol *points, uint32_t group, int count,
                    struct vec3 directions[RAY_PACKET])
{
    double u[2][SOBOL_BATCH];
    int above = 0;
    sobol_pairs(points, group, u);
    for (int i = 0; i < count; i += 4) {
        struct directions4 d;
        const unsigned is_above = strategy_sample4(s, f64x4_load(u[0] + i), f64x4_load(u[1] + i), &d);
        for (int k = 0; k < 4 && i + k < count; k++)
            if (is_above >> k & 1) directions[above++] = vec3_make(d.x[k], d.y[k], d.z[k]);
    }
    return above;
}

bool strategy_sample(const struct strategy *s, const double u[2], struct vec3 *direction)
{
    struct directions4 d;
    const bool above = strategy_sample4(s, f64x4_all(u[0]), f64x4_all(u[1]), &d) & 1;
    *direction = vec3_make(d.x[0], d.y[0], d.z[0]);
    return above;
}

/* -------------------------------------------------------------------------------------------------------- densities */

static f64x4 area_density(const struct strategy *s, const struct directions4 *d)
{
    const f64x4 cosine = -dot4(d, s->emitter->normal), t = -vec3_dot(s->to, s->emitter->normal) / cosine;
    const struct directions4 q = {d->x * t - s->to.x, d->y * t - s->to.y, d->z * t - s->to.z};
    const f64x4 a = dot4(&q, s->dual[0]), b = dot4(&q, s->dual[1]), aa = a * a, bb = b * b;
    const f64x4 out = s->kind == STRATEGY_DISK ? aa + bb : f64x4_max(aa, bb);
    const f64x4 density =
        s->kind == STRATEGY_RECTANGLE ? f64x4_all(1 / s->rectangle.solid_angle) : t * t / (s->area * cosine);
    return f64x4_where((cosine > 0) & (out <= 1 + 2e-12), density);
}

static f64x4 lobe_density(const struct strategy *s, const struct directions4 *d)
{
    f64x4 density;
    for (int k = 0; k < 4; k++) {
        double one;
        brdf_eval(s->lobe, s->point.normal, s->view, vec3_make(d->x[k], d->y[k], d->z[k]), &one);
        density[k] = one;
    }
    return density;
}

f64x4 strategy_density4(const struct strategy *s, const struct directions4 *d)
{
    switch (s->kind) {
    case STRATEGY_COSINE:
        return f64x4_max(dot4(d, s->point.normal), f64x4_all(0)) / PI;
    case STRATEGY_LOBE:
        return lobe_density(s, d);
    case STRATEGY_SUN:
        return f64x4_where(dot4(d, s->emitter->normal) >= s->emitter->cone - 1e-15, f64x4_all(1 / s->area));
    default:
        return area_density(s, d);
    }
}

double strategy_density(const struct strategy *s, struct vec3 direction)
{
    const struct directions4 d = {f64x4_all(direction.x), f64x4_all(direction.y), f64x4_all(direction.z)};
    return strategy_density4(s, &d)[0];
}
