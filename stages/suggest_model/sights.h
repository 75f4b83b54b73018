/* sights.h - thinned points with the lines of sight to them. */
#ifndef REMODEL_SIGHTS_H
#define REMODEL_SIGHTS_H

#include "stages/suggest_model/rays.h"
#include "stages/suggest_model/thin_points.h"
#include "stages/suggest_model/wall_line.h"

/* By which a line of sight must pass a face to cross it, as a fraction of the ceiling's height. */
#define BEYOND 0.06

struct sights {
    struct thin_points points;
    struct ray_list rays;
    const struct view *views; /* not owned */
    int view_count;
};

/* Thins the cloud to one point per cube of this edge, and finds the lines of sight. The views stay the caller's. The
 * caller releases the result, which a failure leaves empty. */
enum status sights_make(struct sights *sights, const struct point_cloud *cloud, double edge, const struct view *views,
                        int view_count, struct err *err);
void sights_release(struct sights *sights);

/* Whether a point faces the inside of a line. */
static inline bool sight_faces(const struct cloud_point *p, const struct wall_line *l, double min_cosine)
{
    return (double)p->normal[0] * l->n[0] + (double)p->normal[1] * l->n[1] >= min_cosine;
}

/* Whether a line of sight crosses a face from its front, and ends well behind it; *s, *z: where. */
static inline bool sight_crosses(const struct sights *sights, const struct ray *r, const struct wall_line *l,
                                 double height, double *s, double *z)
{
    const struct vec3 a = sights->views[r->view].center, b = sights->points.cloud.points[r->point].position;
    const double from = line_across(l, a.x, a.y), to = line_across(l, b.x, b.y);
    if (from <= 0 || to > -BEYOND * height) return false;
    const double t = from / (from - to), sa = line_along(l, a.x, a.y);
    *s = sa + t * (line_along(l, b.x, b.y) - sa);
    *z = a.z + t * (b.z - a.z);
    return true;
}

#endif
