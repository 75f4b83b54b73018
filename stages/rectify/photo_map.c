/* photo_map.c - where the pixels of a view lie in the photo.
 *
 * Lens projection would take most of the time of resampling. Along a row of the view the map is smooth: it is computed
 * at knots, every 16th or else every 8th pixel, and interpolated by the cubic through four knots where fourth
 * differences show that this is exact enough (the error is 3/128 of them); elsewhere it is computed at every pixel. */
#include "stages/rectify/photo_map.h"

#include <math.h>

#define SMOOTH 0.004 /* px: largest fourth difference of knots to interpolate; 1e-4 px of error */
enum { KNOTS = PHOTO_MAP_KNOTS, MARGIN = 4 };

/* Weights of four knots, `step` apart, for each pixel between the second and the third. */
static void make_cubic(double cubic[4][2 * KNOTS], int step)
{
    for (int i = 0; i < step; i++) {
        const double t = (double)i / step;
        cubic[0][i] = -t * (t - 1) * (t - 2) / 6;
        cubic[1][i] = (t + 1) * (t - 1) * (t - 2) / 2;
        cubic[2][i] = -(t + 1) * t * (t - 2) / 2;
        cubic[3][i] = (t + 1) * t * (t - 1) / 6;
    }
}

struct photo_point photo_map_point(const struct photo_map *m, int x, int y)
{
    const struct view *view = m->view;
    struct vec3 ray = {(x + 0.5 - view->cx) / view->fx, (y + 0.5 - view->cy) / view->fy, 1};
    struct photo_point p;
    return camera_project(m->lens, mat3_apply(m->photo_from_view, ray), &p.u, &p.v) ? p
                                                                                    : (struct photo_point){NAN, NAN};
}

/* Are the knots around the interval from knot[0] to knot[n] close to cubics? */
static bool is_smooth(const double *knot, int n)
{
    for (const double *k = knot; k <= knot + n; k += n)
        if (!(fabs(k[-2 * n] - 4 * k[-n] + 6 * k[0] - 4 * k[n] + k[2 * n]) <= SMOOTH)) return false;
    return true;
}

/* Interpolates the interval from knot[0] to knot[n]. n: 1 for neighbouring knots, 2 for every other one. */
static void interpolate(const struct photo_map *m, double *to, const double *knot, int n)
{
    const double(*w)[2 * KNOTS] = m->cubic[n - 1];
    for (int i = 0; i < n * KNOTS; i++)
        to[i] = w[0][i] * knot[-n] + w[1][i] * knot[0] + w[2][i] * knot[n] + w[3][i] * knot[2 * n];
}

static void project_at(const struct photo_map *m, const struct map_row *to, int i, int x, int y)
{
    const struct photo_point p = photo_map_point(m, x, y);
    to->u[i] = p.u;
    to->v[i] = p.v;
}

/* Uses every other knot where the map is smooth enough, as it is in large views. */
void photo_map_row(const struct photo_map *m, int y, const struct map_row *row, const struct map_row *knots)
{
    const int width = m->view->width, intervals = width / KNOTS + 1;
    for (int k = -MARGIN; k <= intervals + MARGIN; k += 2) project_at(m, knots, k + MARGIN, k * KNOTS, y);
    for (int k = 0, odd = 1 - MARGIN; k < intervals; k += 2) {
        const struct map_row at = {knots->u + k + MARGIN, knots->v + k + MARGIN};
        const struct map_row to = {row->u + k * KNOTS, row->v + k * KNOTS};
        if (is_smooth(at.u, 2) && is_smooth(at.v, 2)) {
            interpolate(m, to.u, at.u, 2);
            interpolate(m, to.v, at.v, 2);
            continue;
        }
        if (odd < k - 1) odd = k - 1;
        for (; odd <= k + 3; odd += 2) project_at(m, knots, odd + MARGIN, odd * KNOTS, y);
        for (int n = 0; n < 2; n++) {
            if (is_smooth(at.u + n, 1) && is_smooth(at.v + n, 1)) {
                interpolate(m, to.u + n * KNOTS, at.u + n, 1);
                interpolate(m, to.v + n * KNOTS, at.v + n, 1);
                continue;
            }
            for (int i = n * KNOTS; i < (n + 1) * KNOTS && k * KNOTS + i <= width; i++)
                project_at(m, &to, i, k * KNOTS + i, y);
        }
    }
}

void photo_map_init(struct photo_map *m, const struct camera *lens, const struct mat3 *photo_from_view,
                    const struct view *view)
{
    *m = (struct photo_map){.lens = lens, .photo_from_view = *photo_from_view, .view = view};
    const size_t pairs = (size_t)view->width / (2 * KNOTS) + 1; /* of intervals between knots */
    m->row = pairs * 2 * KNOTS;
    m->knots = 2 * pairs + 2 * MARGIN + 1;
    for (int i = 0; i < 2; i++) make_cubic(m->cubic[i], (i + 1) * KNOTS);
}
