/* lamp.c - radiance and irradiance of a lamp that nothing hides.
 *
 * Overview. The irradiance at a point p with normal m is E = integral of S cos(t)^e (m . w) over the directions w to
 * the lamp that lie above the horizon of m and within the cone t <= beta, where t is the angle at the lamp between its
 * normal and the direction to p. It does not change over a circle about p', the foot of p on the lamp's plane. So polar
 * coordinates about p' leave one integral to do numerically:
 *
 *   E = S integral over t of sin(t) cos(t)^e F(t) dt,   F(t) = integral over arcs of (m . w) d(phi)
 *
 * Mathematics. In the lamp's plane, in units of the height of p above it, a direction is the point tan(t) (cos(phi),
 * sin(phi)), and m . w = cos(t) (a + b . point) with a = -(m . normal) and b the part of m in the plane. The lamp's
 * edge and the horizon a + b . point = 0 cut the circle of radius tan(t) into arcs, over which F has a closed form. F
 * is smooth between the radii where a line or the lamp's rim touches the circle, and where two of them cross on it.
 * These radii split the range of t into panels. F behaves like a square root at the ends of a panel, so t = middle -
 * half cos(u), and Gauss-Legendre quadrature with 12 points in u, halved until two halves agree with the whole.
 *
 * A quad without a cone and with exponent 0 has a closed form: half the sum over the edges of the angle that an edge
 * spans at p times the cosine of m and the normal of the plane through p and the edge [Lambert 1760], after the quad is
 * clipped at the horizon.
 *
 * Source: the lamp is a disk with a cone and an exponent [Colburn 2014, 5.3.3; Warn 1983]. The thesis leaves the
 * exponent out and samples the lamp with the pixels of a hemicube; here the integral has an error near 1e-9. */
#include "common/gather/lamp.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"

struct rgb lamp_radiance(const struct lamp *l, struct vec3 direction)
{
    const double cosine = vec3_dot(l->normal, direction);
    if (!(cosine > 0) || l->beta <= 0 || cosine < cos(l->beta)) return rgb_grey(0);
    return l->exponent > 0 ? rgb_scale(l->radiance, pow(fmin(cosine, 1), l->exponent)) : l->radiance;
}

/* --- a quad without a cone
 * ------------------------------------------------------------------------------------------ */

/* Keeps what lies above the horizon of m. to: at most count + 1 corners. */
static int clip(struct vec3 *to, const struct vec3 *corners, int count, struct vec3 m)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        const struct vec3 p = corners[i], q = corners[(i + 1) % count];
        const double hp = vec3_dot(m, p), hq = vec3_dot(m, q);
        if (hp >= 0) to[kept++] = p;
        if ((hp < 0) != (hq < 0)) to[kept++] = vec3_add(p, vec3_scale(vec3_sub(q, p), hp / (hp - hq)));
    }
    return kept;
}

/* Irradiance from a quad of radiance 1 [Lambert 1760]. */
static double quad_irradiance(const struct lamp *l, struct vec3 at, struct vec3 m)
{
    const struct vec3 c = vec3_sub(l->centre, at);
    const struct vec3 corners[4] = {vec3_sub(vec3_sub(c, l->x), l->y), vec3_sub(vec3_add(c, l->x), l->y),
                                    vec3_add(vec3_add(c, l->x), l->y), vec3_add(vec3_sub(c, l->x), l->y)};
    struct vec3 v[6];
    const int count = clip(v, corners, 4, m);
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const struct vec3 p = v[i], q = v[(i + 1) % count], n = vec3_cross(p, q);
        const double sine = vec3_length(n);
        if (sine > 0) sum += atan2(sine, vec3_dot(p, q)) * vec3_dot(m, n) / sine;
    }
    return 0.5 * fabs(sum);
}

/* --- any lamp: one integral over the angle from its normal ------------------------------------------------------- */

enum { MAX_LINES = 5, MAX_RADII = 32, MAX_CUTS = 2 * MAX_LINES + 4, DEEPEST = 12 };

struct plane_line {
    double x, y, c; /* inside: x X + y Y <= c */
};

/* The lamp seen from p: its plane in units of the height of p, p' the origin. */
struct plane_lamp {
    struct plane_line lines[MAX_LINES]; /* the edges of a quad; the horizon */
    int line_count;
    double cx, cy, radius; /* of a disk */
    bool disk;
    double a, bx, by, exponent;
};

static bool inside(const struct plane_lamp *p, double x, double y)
{
    for (int i = 0; i < p->line_count; i++)
        if (p->lines[i].x * x + p->lines[i].y * y > p->lines[i].c) return false;
    return !p->disk || hypot(x - p->cx, y - p->cy) <= p->radius;
}

/* Adds the angles where the circle of radius r about the origin crosses the line x X + y Y = c. */
static int cross_line(double *cuts, int count, double x, double y, double c, double r)
{
    const double n = hypot(x, y), cosine = n > 0 ? c / (n * r) : 2;
    if (!(fabs(cosine) < 1)) return count;
    const double middle = atan2(y, x), half = acos(cosine);
    cuts[count++] = remainder(middle - half, 2 * M_PI);
    cuts[count++] = remainder(middle + half, 2 * M_PI);
    return count;
}

/* The integral of (m . w) over the circle at t that lies inside. */
static double over_arcs(const struct plane_lamp *p, double t)
{
    const double r = tan(t);
    double cuts[MAX_CUTS], sum = 0;
    int count = 0;
    for (int i = 0; i < p->line_count; i++)
        count = cross_line(cuts, count, p->lines[i].x, p->lines[i].y, p->lines[i].c, r);
    if (p->disk) { /* the rim crosses the circle on the line through both crossings */
        const double d2 = p->cx * p->cx + p->cy * p->cy;
        count = cross_line(cuts, count, 2 * p->cx, 2 * p->cy, r * r + d2 - p->radius * p->radius, r);
    }
    sort_doubles(cuts, (size_t)count);
    if (!count) cuts[count++] = -M_PI;
    for (int i = 0; i < count; i++) {
        const double from = cuts[i], to = i + 1 < count ? cuts[i + 1] : cuts[0] + 2 * M_PI, middle = 0.5 * (from + to);
        if (!inside(p, r * cos(middle), r * sin(middle))) continue;
        sum += p->a * cos(t) * (to - from) + sin(t) * (p->bx * (sin(to) - sin(from)) - p->by * (cos(to) - cos(from)));
    }
    return fmax(sum, 0);
}

static double integrand(const struct plane_lamp *p, double t)
{
    return sin(t) * (p->exponent > 0 ? pow(cos(t), p->exponent) : 1) * over_arcs(p, t);
}

struct panel {
    double middle, half;
};

/* Gauss-Legendre quadrature of the integrand over u from..to, t = middle - half cos(u). */
static double gauss(const struct plane_lamp *p, struct panel panel, double from, double to)
{
    static const double node[6] = {0.12523340851146892, 0.36783149899818019, 0.58731795428661745,
                                   0.76990267419430469, 0.90411725637047486, 0.98156063424671925};
    static const double weight[6] = {0.24914704581340279, 0.23349253653835481, 0.20316742672306592,
                                     0.16007832854334623, 0.10693932599531843, 0.04717533638651183};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double sum = 0;
    for (int i = 0; i < 6; i++)
        for (int side = -1; side <= 1; side += 2) {
            const double u = middle + side * half * node[i];
            sum += weight[i] * sin(u) * integrand(p, panel.middle - panel.half * cos(u));
        }
    return sum * half * panel.half;
}

static double halve(const struct plane_lamp *p, struct panel panel, double from, double to, double whole,
                    double tolerance, int depth)
{
    const double middle = 0.5 * (from + to);
    const double low = gauss(p, panel, from, middle), high = gauss(p, panel, middle, to);
    if (depth >= DEEPEST || fabs(low + high - whole) <= tolerance) return low + high;
    return halve(p, panel, from, middle, low, 0.5 * tolerance, depth + 1) +
           halve(p, panel, middle, to, high, 0.5 * tolerance, depth + 1);
}

/* --- the radii where the arcs change
 * ------------------------------------------------------------------------------- */

static int add_radius(double *radii, int count, double r)
{
    if (count < MAX_RADII && isfinite(r) && r > 0) radii[count++] = r;
    return count;
}

static int line_radii(double *radii, int count, const struct plane_lamp *p)
{
    for (int i = 0; i < p->line_count; i++) {
        const struct plane_line k = p->lines[i];
        count = add_radius(radii, count, fabs(k.c) / hypot(k.x, k.y));
        for (int j = 0; j < i; j++) {
            const struct plane_line o = p->lines[j];
            const double det = k.x * o.y - k.y * o.x;
            if (det != 0)
                count = add_radius(radii, count, hypot(k.c * o.y - o.c * k.y, k.x * o.c - o.x * k.c) / fabs(det));
        }
    }
    return count;
}

static int disk_radii(double *radii, int count, const struct plane_lamp *p)
{
    const double d = hypot(p->cx, p->cy);
    count = add_radius(radii, count, fabs(d - p->radius));
    count = add_radius(radii, count, d + p->radius);
    for (int i = 0; i < p->line_count; i++) { /* the horizon crosses the rim */
        const double n = hypot(p->lines[i].x, p->lines[i].y), x = p->lines[i].x / n, y = p->lines[i].y / n;
        const double off = p->lines[i].c / n - (x * p->cx + y * p->cy), half = p->radius * p->radius - off * off;
        if (!(half > 0)) continue;
        for (int side = -1; side <= 1; side += 2)
            count = add_radius(radii, count,
                               hypot(p->cx + off * x - side * sqrt(half) * y, p->cy + off * y + side * sqrt(half) * x));
    }
    return count;
}

/* --- a lamp in its plane ------------------------------------------------------------------------------------------ */

static void add_edges(struct plane_lamp *p, const double x[2], const double y[2])
{
    const double det = x[0] * y[1] - x[1] * y[0];
    for (int side = -1; side <= 1; side += 2) {
        const double s = side / det;
        /* the coordinate along x of a point q about the centre is (q cross y) / det, and within -1..1 */
        const double cx = p->cx, cy = p->cy;
        p->lines[p->line_count++] = (struct plane_line){s * y[1], -s * y[0], 1 + s * (cx * y[1] - cy * y[0])};
        p->lines[p->line_count++] = (struct plane_line){-s * x[1], s * x[0], 1 + s * (cy * x[0] - cx * x[1])};
    }
}

/* False: p sees only the back of the lamp, or nothing of it above its horizon. */
static bool view_lamp(struct plane_lamp *p, const struct lamp *l, struct vec3 at, struct vec3 m)
{
    const struct vec3 c = vec3_sub(l->centre, at), e1 = vec3_normalize(l->x), e2 = vec3_cross(l->normal, e1);
    const double h = -vec3_dot(c, l->normal);
    if (!(h > 0)) return false;
    *p = (struct plane_lamp){.cx = vec3_dot(c, e1) / h,
                             .cy = vec3_dot(c, e2) / h,
                             .radius = l->radius / h,
                             .disk = l->shape == LAMP_DISK,
                             .a = -vec3_dot(m, l->normal),
                             .bx = vec3_dot(m, e1),
                             .by = vec3_dot(m, e2),
                             .exponent = l->exponent};
    if (!p->disk)
        add_edges(p, (const double[]){vec3_dot(l->x, e1) / h, vec3_dot(l->x, e2) / h},
                  (const double[]){vec3_dot(l->y, e1) / h, vec3_dot(l->y, e2) / h});
    if (hypot(p->bx, p->by) > 1e-12) p->lines[p->line_count++] = (struct plane_line){-p->bx, -p->by, p->a};
    return hypot(p->bx, p->by) > 1e-12 || p->a > 0;
}

/* Irradiance from a lamp with S = 1. */
static double irradiance(const struct lamp *l, struct vec3 at, struct vec3 m)
{
    struct plane_lamp p;
    double ends[MAX_RADII + 4], panels[MAX_RADII + 4], total = 0, from = 0;
    if (!(l->beta > 0) || !view_lamp(&p, l, at, m)) return 0;
    int count = line_radii(ends, 0, &p);
    if (p.disk) count = disk_radii(ends, count, &p);
    for (int i = 0; i < count; i++) ends[i] = atan(ends[i]);
    if (l->exponent > 0) ends[count++] = 3 / sqrt(l->exponent + 2);
    ends[count++] = fmin(l->beta, 0.5 * M_PI);
    sort_doubles(ends, (size_t)count);

    int used = 0;
    for (int i = 0; i < count && ends[i] <= l->beta; i++) {
        const double whole =
            ends[i] > from ? gauss(&p, (struct panel){0.5 * (from + ends[i]), 0.5 * (ends[i] - from)}, 0, M_PI) : 0;
        panels[used] = whole;
        ends[used++] = ends[i];
        total += whole;
        from = ends[i];
    }
    double sum = 0;
    from = 0;
    for (int i = 0; i < used; i++) {
        if (panels[i] > 0)
            sum += halve(&p, (struct panel){0.5 * (from + ends[i]), 0.5 * (ends[i] - from)}, 0, M_PI, panels[i],
                         1e-9 * total, 0);
        from = ends[i];
    }
    return sum;
}

struct rgb lamp_irradiance(const struct lamp *l, struct vec3 at, struct vec3 normal)
{
    const bool closed = l->shape == LAMP_QUAD && l->beta >= 0.5 * M_PI - 1e-12 && l->exponent <= 0;
    if (!closed) return rgb_scale(l->radiance, irradiance(l, at, normal));
    if (!(vec3_dot(vec3_sub(at, l->centre), l->normal) > 0)) return rgb_grey(0);
    return rgb_scale(l->radiance, quad_irradiance(l, at, normal));
}
