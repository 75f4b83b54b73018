/* correct.c - see correct.h.
 *
 * In a view, the rays of a corner and of a point on an edge from it span a plane in which the edge lies, however far
 * away the corner is: each edge gives its axis one equation, axis . normal = 0. A pixel's error turns the plane about the
 * corner's ray, so that what it does to the equation is known too. The edges of a corner with two walls and a vertical
 * line fix all three turns; what they leave open stays as it was found, by a prior that is too weak to hold against any
 * edge.
 *
 * Points tell axes to hundredths of a degree, a pixel at the end of an edge of 50 px only to one degree. So the axes turn
 * only if what was found contradicts the marks: if the turn lowers chi^2 by more than chance would. */
#include "stages/find_axes/correct.h"

#include <string.h>

#include "stages/find_axes/directions.h"

enum { ITERATIONS = 20 };
static const double PRIOR = 1;              /* radians */
static const double MOST = 30 * M_PI / 180; /* an edge follows the axis that is nearest in the picture, within this */
static const double LEAST_LENGTH = 5;       /* px */
static const double SIGNIFICANT = 9;        /* of chi^2: three turns lower it as much by chance in 3 of 100 cases */
static const double HEAD_ON = 0.05;         /* an axis that points at the camera is told by no edge */

struct edge {
    struct vec3 normal; /* of the plane in which it lies, world */
    struct vec3 across; /* how the normal changes as the pixel moves across the edge: normal x corner's ray */
    double error;       /* radians, of the plane's turn about the corner's ray */
};

static enum status find_edge(struct edge *e, const struct mark *m, const struct mark_list *fix,
                             const struct mark_scene *scene, double click, struct err *err)
{
    const struct mark *c = fix->marks;
    struct photo_camera camera;
    struct vec3 ray, corner;
    while (c->kind != MARK_CORNER || strcmp(c->name, m->name) || strcmp(c->view, m->view)) c++;
    const double length = hypot(m->x - c->x, m->y - c->y);
    if (!(length >= LEAST_LENGTH))
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

/* The axis that the edge follows, and its angle to it in the picture. */
static int axis_of(const struct edge *e, const struct mat3 *axes, double *angle)
{
    int best = 0;
    *angle = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        const double off = fabs(vec3_dot(e->normal, mat3_row(*axes, k)));
        const double seen = fabs(vec3_dot(e->across, mat3_row(*axes, k)));
        const double a = atan2(off, seen);
        if (!(a < *angle)) continue;
        *angle = a;
        best = k;
    }
    return best;
}

/* What the edges say of a small turn of the axes: its information, right-hand side, and the misfit of now, chi^2. */
struct opinion {
    struct mat3 information;
    struct vec3 right;
    double misfit;
    int edges;
};

static enum status ask_edges(struct opinion *o, const struct mat3 *axes, bool first, const struct mark_list *fix,
                             const struct mark_scene *scene, double click, struct err *err)
{
    *o = (struct opinion){0};
    for (int i = 0; i < fix->count; i++) {
        const struct mark *m = &fix->marks[i];
        struct edge e = {0};
        double angle;
        if (m->kind != MARK_EDGE) continue;
        if (find_edge(&e, m, fix, scene, click, err)) return err->status;
        const int k = axis_of(&e, axes, &angle);
        if (first && !(angle < MOST))
            return err_set(err, ST_DATA,
                           "%s:%d: the edge follows none of the axes: in %s it is %.0f degrees off the nearest one; "
                           "mark a point on a line where two walls, or a wall and the floor, meet at the corner %s.",
                           fix->path, m->line, m->view, angle * 180 / M_PI, m->name);
        /* a turn by w, in the axes' frame, changes component k of the normal by w . (normal x e_k) */
        const struct vec3 n = mat3_apply(*axes, e.normal);
        const double off = k == 0 ? n.x : k == 1 ? n.y : n.z;
        const struct vec3 lever = vec3_cross(n, vec3_make(k == 0, k == 1, k == 2));
        const double sigma = e.error * fmax(fabs(vec3_dot(e.across, mat3_row(*axes, k))), HEAD_ON);
        const double w = 1 / (sigma * sigma), l[3] = {lever.x, lever.y, lever.z};
        for (int j = 0; j < 9; j++) o->information.m[j / 3][j % 3] += w * l[j / 3] * l[j % 3];
        o->right = vec3_sub(o->right, vec3_scale(lever, w * off));
        o->misfit += w * off * off;
        o->edges++;
    }
    return ST_OK;
}

enum status correct_axes(struct mat3 *axes, struct vec3 *errors, struct correction *c, const struct mark_list *fix,
                         const struct mark_scene *scene, double click, struct err *err)
{
    struct mat3 turned = *axes, inverse = {0}, unknown;
    struct vec3 total = {0};
    struct opinion o;
    double before = 0;
    *c = (struct correction){0};
    for (int round = 0; round < ITERATIONS; round++) {
        if (ask_edges(&o, &turned, !round, fix, scene, click, err)) return err->status;
        if (!o.edges) return ST_OK;
        if (!round) before = o.misfit;
        for (int k = 0; k < 3; k++) o.information.m[k][k] += 1 / (PRIOR * PRIOR);
        inverse = inverse_of_known(o.information, &unknown);
        const struct vec3 w = mat3_apply(inverse, vec3_sub(o.right, vec3_scale(total, 1 / (PRIOR * PRIOR))));
        turned = turned_by(turned, w);
        total = vec3_add(total, w);
    }
    c->edges = o.edges;
    if (before - o.misfit < SIGNIFICANT) return ST_OK;
    *axes = turned;
    c->turn = vec3_length(total);
    errors->x = fmin(errors->x, sqrt(inverse.m[0][0]));
    errors->y = fmin(errors->y, sqrt(inverse.m[1][1]));
    errors->z = fmin(errors->z, sqrt(inverse.m[2][2]));
    return ST_OK;
}
