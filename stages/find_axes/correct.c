/* correct.c - corrects axes by marked edges.
 *
 * In a view, the rays of a corner and of a point on an edge that starts there span a plane that contains the edge,
 * whatever the corner's distance: each edge gives its axis one equation, axis . normal = 0. An error of the pixel turns
 * the plane about the corner's ray, which gives the equation's standard error. The edges of a corner with two walls and
 * a vertical line determine all three rotations; rotations that the edges leave undetermined are kept by a weak prior.
 * The equations are solved by Gauss-Newton.
 *
 * Points determine the axes to hundredths of a degree, but a pixel at the end of an edge of 50 px only to one degree.
 * So the axes are corrected only if they contradict the marks: if the correction lowers chi^2 significantly. */
#include "stages/find_axes/correct.h"

#include <string.h>

#include "common/math/rotation_fit.h"
#include "stages/find_axes/directions.h"

enum { ITERATIONS = 20 };
static const double PRIOR = 1;                   /* standard error of the prior, radians */
static const double MAX_ANGLE = 30 * M_PI / 180; /* in the picture, between an edge and its axis, the nearest one */
static const double MIN_LENGTH = 5;              /* of an edge, px */
static const double SIGNIFICANT = 9; /* decrease of chi^2: by chance in 3 of 100 cases, for three rotations */
static const double HEAD_ON = 0.05;  /* floor of an edge's sensitivity: its axis points at the camera */

struct marked_edge {
    struct vec3 normal; /* of the plane that contains it, world */
    struct vec3 across; /* change of the normal as the pixel moves across the edge: normal x corner's ray */
    double error;       /* standard error of the plane's rotation about the corner's ray, radians */
};

static enum status find_edge(struct marked_edge *e, const struct mark *m, const struct mark_list *fix,
                             const struct mark_scene *scene, double click, struct err *err)
{
    const struct mark *c = fix->marks;
    struct photo_camera camera;
    struct vec3 ray, corner;
    while (c->kind != MARK_CORNER || strcmp(c->name, m->name) || strcmp(c->view, m->view)) c++;
    const double length = hypot(m->x - c->x, m->y - c->y);
    if (!(length >= MIN_LENGTH))
        return err_set(err, ST_DATA,
                       "%s:%d: the point on the edge is only %.3g px from its corner; mark one farther along the edge.",
                       fix->path, m->line, length);
    if (mark_ray(c, fix, scene, &camera, &corner, err) || mark_ray(m, fix, scene, &camera, &ray, err))
        return err->status;
    e->normal = vec3_normalize(vec3_cross(corner, ray));
    e->across = vec3_cross(e->normal, corner);
    e->error = sqrt(2) * click / length;
    return ST_OK;
}

/* The axis nearest to the edge, and the angle between them in the picture. */
static int axis_of(const struct marked_edge *e, const struct mat3 *axes, double *angle)
{
    int best = 0;
    *angle = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double off = fabs(vec3_dot(e->normal, mat3_row(*axes, k)));
        const double sensitivity = fabs(vec3_dot(e->across, mat3_row(*axes, k)));
        const double a = atan2(off, sensitivity);
        if (!(a < *angle)) continue;
        *angle = a;
        best = k;
    }
    return best;
}

struct normal_equations { /* of a small rotation of the axes */
    struct mat3 information;
    struct vec3 right;
    double chi2; /* of the current axes */
    int edges;
};

static enum status add_edges(struct normal_equations *o, const struct mat3 *axes, bool first,
                             const struct mark_list *fix, const struct mark_scene *scene, double click, struct err *err)
{
    *o = (struct normal_equations){0};
    for (int i = 0; i < fix->count; i++) {
        const struct mark *m = &fix->marks[i];
        struct marked_edge e = {0};
        double angle;
        if (m->kind != MARK_EDGE) continue;
        if (find_edge(&e, m, fix, scene, click, err)) return err->status;
        const int k = axis_of(&e, axes, &angle);
        if (first && !(angle < MAX_ANGLE))
            return err_set(err, ST_DATA,
                           "%s:%d: the edge follows none of the axes: in %s it is %.0f degrees off the nearest axis; "
                           "mark a point on a line where two walls, or a wall and the floor, meet at the corner %s.",
                           fix->path, m->line, m->view, angle * 180 / M_PI, m->name);
        /* a rotation by w, in the axes' frame, changes component k of the normal by w . (normal x e_k) */
        const struct vec3 n = mat3_apply(*axes, e.normal);
        const double off = k == 0 ? n.x : k == 1 ? n.y : n.z;
        const struct vec3 lever = vec3_cross(n, vec3_make(k == 0, k == 1, k == 2));
        const double sigma = e.error * fmax(fabs(vec3_dot(e.across, mat3_row(*axes, k))), HEAD_ON);
        const double w = 1 / (sigma * sigma), l[3] = {lever.x, lever.y, lever.z};
        for (int j = 0; j < 9; j++) o->information.m[j / 3][j % 3] += w * l[j / 3] * l[j % 3];
        o->right = vec3_sub(o->right, vec3_scale(lever, w * off));
        o->chi2 += w * off * off;
        o->edges++;
    }
    return ST_OK;
}

enum status correct_axes(struct mat3 *axes, struct vec3 *errors, struct correction *c, const struct mark_list *fix,
                         const struct mark_scene *scene, double click, struct err *err)
{
    struct mat3 turned = *axes, inverse = {0}, unknown;
    struct vec3 total = {0};
    struct normal_equations o;
    double before = 0;
    *c = (struct correction){0};
    for (int round = 0; round < ITERATIONS; round++) {
        if (add_edges(&o, &turned, !round, fix, scene, click, err)) return err->status;
        if (!o.edges) return ST_OK;
        if (!round) before = o.chi2;
        for (int k = 0; k < 3; k++) o.information.m[k][k] += 1 / (PRIOR * PRIOR);
        inverse = rotation_inverse_of_known(o.information, &unknown);
        const struct vec3 w = mat3_apply(inverse, vec3_sub(o.right, vec3_scale(total, 1 / (PRIOR * PRIOR))));
        turned = rotation_turn(turned, w);
        total = vec3_add(total, w);
    }
    c->edges = o.edges;
    if (before - o.chi2 < SIGNIFICANT) return ST_OK;
    *axes = turned;
    c->turn = vec3_length(total);
    errors->x = fmin(errors->x, sqrt(inverse.m[0][0]));
    errors->y = fmin(errors->y, sqrt(inverse.m[1][1]));
    errors->z = fmin(errors->z, sqrt(inverse.m[2][2]));
    return ST_OK;
}

enum status correct_edge_plane(struct vec3 *normal, const struct mark *edge, const struct mark_list *fix,
                               const struct mark_scene *scene, struct err *err)
{
    struct marked_edge e = {0};
    if (!find_edge(&e, edge, fix, scene, 1, err)) *normal = e.normal;
    return err->status;
}
