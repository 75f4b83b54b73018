/* refine_ends.c - continuous refinement of a move's ends. Not in the thesis.
 *
 * Hidden area is not differentiable, so a surrogate S replaces it: for every depth edge in the picture from the origin,
 * the distance by which the two cameras separate its near and far side, across the edge, summed.
 *
 * Unknowns: x, y and z of both ends in the shot's reference frame, in units of half the bounding box of the views'
 * centres (z: of its larger half). Residuals, minimised by Levenberg-Marquardt (Ceres): S_0 / S, where S_0 is S on
 * entry; and for each limit (z range and valid area of the region, interpolated between cells; angle) a penalty that is
 * 0.01 at the limit and grows exponentially beyond it. */
#include "stages/plan_path/refine_ends.h"

#include <stdlib.h>

#include "common/math/ceres_least_squares.h"
#include "common/math/numbers.h"
#include "stages/plan_path/parallax.h"

#define EDGE_SIDE  160  /* longer side of the picture in which depth edges are found, px */
#define EDGE_RATIO 1.03 /* smallest ratio of the depths at an edge */
#define SOFT_PIXEL 0.25 /* displacements below this many px hardly change S */
#define ITERATIONS 40
#define STIFFNESS  20 /* growth rate of a penalty */

enum { UNKNOWNS = 6, PENALTIES = 3, LIMITS = 2 * PENALTIES + 1, RESIDUALS = 1 + LIMITS };

struct depth_edge { /* two neighbouring pixels of different depths */
    struct vec3 near, far;
    bool across; /* the pixels are side by side, else one above the other */
};

struct surrogate {
    const struct validity *v;
    double unit[3]; /* units of x, y and z in scene units */
    double max_angle;
    struct depth_edge *edges;
    size_t edge_count;
    double initial; /* S on entry */
};

static void ends_of_unknowns(const struct surrogate *s, const double *x, struct vec3 at[2])
{
    for (int k = 0; k < 2; k++)
        at[k] =
            world_from_shot(&s->v->shot, x[3 * k] * s->unit[0], x[3 * k + 1] * s->unit[1], x[3 * k + 2] * s->unit[2]);
}

/* The surrogate S, px of the film. */
static double edge_separation(const struct surrogate *s, const struct vec3 at[2])
{
    struct view cameras[2];
    double sum = 0;
    for (int k = 0; k < 2; k++) cameras[k] = shot_end_camera(&s->v->shot, &s->v->move.end[k], at[k]);
    for (size_t i = 0; i < s->edge_count; i++) {
        const struct depth_edge *e = &s->edges[i];
        double d[2][2];
        bool visible = true;
        for (int k = 0; k < 2; k++) {
            double u[2] = {0}, v[2] = {0};
            visible &= view_project(&cameras[k], e->near, &u[0], &v[0]) > 0 &&
                       view_project(&cameras[k], e->far, &u[1], &v[1]) > 0;
            d[k][0] = u[0] - u[1];
            d[k][1] = v[0] - v[1];
        }
        if (!visible) continue;
        const double change = e->across ? d[1][0] - d[0][0] : d[1][1] - d[0][1];
        sum += sqrt(change * change + SOFT_PIXEL * SOFT_PIXEL);
    }
    return sum;
}

static double penalty(double excess) { return 0.01 * exp(fmin(STIFFNESS * excess, 20)); }

static void residuals(void *ctx, const double *x, double *r)
{
    const struct surrogate *s = ctx;
    const struct shot_setup *shot = &s->v->shot;
    struct vec3 at[2];
    int n = 0;

    ends_of_unknowns(s, x, at);
    r[n++] = s->initial / fmax(edge_separation(s, at), 1e-6 * s->initial);
    for (int k = 0; k < 2; k++) {
        const double px = x[3 * k] * s->unit[0], py = x[3 * k + 1] * s->unit[1], pz = x[3 * k + 2] * s->unit[2];
        double low, high;
        const double valid = validity_region_at(&s->v->region[k], px, py, &low, &high);
        r[n++] = penalty((pz - high) / shot->median_depth * 4);
        r[n++] = penalty((low - pz) / shot->median_depth * 4);
        r[n++] = penalty(0.5 - valid);
    }
    const struct vec3 a = vec3_sub(at[0], shot->centroid), b = vec3_sub(at[1], shot->centroid);
    r[n++] = penalty(atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) * 180 / PI / s->max_angle - 1);
}

static enum status find_edges(struct surrogate *s, const struct layer_scene *scene, struct err *err)
{
    const struct shot_setup *shot = &s->v->shot;
    const struct view camera = shot_aim(shot, shot->origin, shot->centroid, shot->lens.fx);
    struct depth_picture d;
    parallax_picture_make(&d, scene, &camera, EDGE_SIDE, err);
    const int w = d.camera.width, h = d.camera.height;

    if (!err->status && !(s->edges = malloc(2 * (size_t)w * (size_t)h * sizeof *s->edges)))
        err_nomem(err, "depth edges", 2 * (size_t)w * (size_t)h * sizeof *s->edges);
    for (int y = 0; !err->status && y + 1 < h; y++)
        for (int x = 0; x + 1 < w; x++)
            for (int down = 0; down < 2; down++) {
                const int x1 = x + !down, y1 = y + down;
                const double z0 = (double)d.z[y * w + x], z1 = (double)d.z[y1 * w + x1];
                if (!(z0 > 0 && z1 > 0) || !(fmax(z0, z1) > EDGE_RATIO * fmin(z0, z1))) continue;
                const struct vec3 a = view_unproject(&d.camera, x + 0.5, y + 0.5, z0);
                const struct vec3 b = view_unproject(&d.camera, x1 + 0.5, y1 + 0.5, z1);
                s->edges[s->edge_count++] = (struct depth_edge){z0 < z1 ? a : b, z0 < z1 ? b : a, !down};
            }
    parallax_picture_release(&d);
    return err->status;
}

enum status refine_ends(struct vec3 at[2], const struct layer_scene *scene, const struct validity *v, double max_angle,
                        struct err *err)
{
    struct surrogate s = {.v = v, .max_angle = max_angle};
    double x[UNKNOWNS];

    for (int k = 0; k < 2; k++) s.unit[k] = 0.5 * (v->shot.high[k] - v->shot.low[k]);
    s.unit[2] = fmax(s.unit[0], s.unit[1]);
    if (!find_edges(&s, scene, err)) {
        for (int k = 0; k < 2; k++) {
            const struct vec3 c = shot_from_world(&v->shot, at[k]);
            x[3 * k] = c.x / s.unit[0];
            x[3 * k + 1] = c.y / s.unit[1];
            x[3 * k + 2] = c.z / s.unit[2];
        }
        s.initial = edge_separation(&s, at);
        const struct least_squares problem = {UNKNOWNS, RESIDUALS, residuals, &s, ITERATIONS};
        if (s.edge_count && s.initial > 0) ceres_least_squares(&problem, x, err);
    }
    if (!err->status) ends_of_unknowns(&s, x, at);
    free(s.edges);
    return err->status;
}
