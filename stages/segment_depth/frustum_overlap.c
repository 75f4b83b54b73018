/* frustum_overlap.c - overlap of views where sparse points say little.
 *
 * Points on blank walls are few, and a stray one says nothing of the rest of the picture. So each tile of the view is
 * given a place in space: its middle, at the median depth of the points nearest to it in the picture. Another view
 * shows it by the product of
 *   the angle between the two rays: little near 0, 1 from 5 to 20 degrees, falling slowly, since where views stand far
 *   apart there are no better ones; and the ratio of the pixels' footprints, at most 1.
 * A camera that the view would see behind the surface in front of it stands in another room, and shows nothing. */
#include "stages/segment_depth/frustum_overlap.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/math/numbers.h"

#define NEAREST    5    /* points whose median depth a tile takes */
#define WIDE_ANGLE 25.0 /* degrees beyond 20 at which a view counts 1 / e */
#define BEHIND     1.3  /* times the tile's depth, from which on a camera stands behind the surface */

/* The median inverse depth at which the scene's views observed their points; 0 if there are none. */
static double typical_inverse_depth(const struct camera_set *set)
{
    enum { MOST = 2001 };
    double inverse[MOST];
    const struct sfm_model *m = &set->model;
    const int stride = m->point_count / MOST + 1;
    int count = 0;
    for (int i = 0; i < m->point_count; i += stride) {
        double u, v;
        if (!m->points[i].track_count || m->points[i].track[0].image_idx >= set->view_count) continue;
        const double z = view_project(&set->views[m->points[i].track[0].image_idx], m->points[i].position, &u, &v);
        if (z > 0) inverse[count++] = 1 / z;
    }
    sort_doubles(inverse, (size_t)count);
    return count ? inverse[count / 2] : 0;
}

/* The median inverse depth of the points nearest to a pixel. */
static double nearby_inverse_depth(const struct observed_points *seen, double u, double v)
{
    double distance[NEAREST], inverse[NEAREST];
    int count = 0;
    for (int i = 0; i < seen->count; i++) {
        const double d = hypot(seen->points[i].u - u, seen->points[i].v - v);
        int at = count < NEAREST ? count++ : NEAREST - 1;
        if (at == NEAREST - 1 && count == NEAREST && i >= NEAREST && !(d < distance[at])) continue;
        for (; at > 0 && distance[at - 1] > d; at--) {
            distance[at] = distance[at - 1];
            inverse[at] = inverse[at - 1];
        }
        distance[at] = d;
        inverse[at] = seen->points[i].inverse_z;
    }
    sort_doubles(inverse, (size_t)count);
    return inverse[count / 2];
}

bool frustum_tiles_make(struct frustum_tiles *t, const struct camera_set *set, int view_idx,
                        const struct observed_points *seen)
{
    const struct view *view = &set->views[view_idx];
    const double typical = seen->count < NEAREST ? typical_inverse_depth(set) : 0;
    if (seen->count < NEAREST && !(typical > 0)) return false;
    for (int k = 0; k < FRUSTUM_TILES * FRUSTUM_TILES; k++) {
        const double u = (k % FRUSTUM_TILES + 0.5) / FRUSTUM_TILES * view->width,
                     v = (double)(k / FRUSTUM_TILES + 0.5) / FRUSTUM_TILES * view->height;
        t->inverse_z[k] = typical > 0 ? typical : nearby_inverse_depth(seen, u, v);
        t->place[k] = view_unproject(view, u, v, 1 / t->inverse_z[k]);
    }
    return true;
}

double frustum_angle_weight(double degrees, double wide)
{
    if (degrees < 5) return pow(degrees / 5, 1.5);
    return degrees <= 20 ? 1 : exp(-pow((degrees - 20) / wide, 2));
}

static double degrees_between(struct vec3 a, struct vec3 b)
{
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) / DEGREE;
}

/* Whether the view would see the other camera behind the surface in front of it. */
static bool stands_behind(const struct frustum_tiles *t, const struct view *view, const struct view *other)
{
    double u, v;
    const double z = view_project(view, other->center, &u, &v);
    if (!(z > 0) || !(u >= 0 && v >= 0 && u < view->width && v < view->height)) return false;
    const int x = (int)(u / view->width * FRUSTUM_TILES), y = (int)(v / view->height * FRUSTUM_TILES);
    return z * t->inverse_z[y * FRUSTUM_TILES + x] > BEHIND;
}

double frustum_overlap(double shown[FRUSTUM_TILES * FRUSTUM_TILES], const struct frustum_tiles *t,
                       const struct view *view, const struct view *other)
{
    const bool hidden = stands_behind(t, view, other);
    double sum = 0;
    for (int k = 0; k < FRUSTUM_TILES * FRUSTUM_TILES; k++) {
        double u, v;
        const double z = view_project(other, t->place[k], &u, &v);
        shown[k] = 0;
        if (hidden || !(z > 0) || !(u >= 0 && v >= 0 && u < other->width && v < other->height)) continue;
        const double scale = other->fx / z / (view->fx * t->inverse_z[k]);
        const double angle = degrees_between(vec3_sub(view->center, t->place[k]), vec3_sub(other->center, t->place[k]));
        shown[k] = frustum_angle_weight(angle, WIDE_ANGLE) * fmin(scale, 1 / scale);
        sum += shown[k];
    }
    return sum;
}
