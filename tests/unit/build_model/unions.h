/* unions.h - shared by tests of unions: makes boxes and prisms, and checks what holds for every mesh. */
#ifndef REMODEL_TESTS_UNIONS_H
#define REMODEL_TESTS_UNIONS_H

#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/build_model/solid/unite.h"

/* A box; the faces names[0], [1] are at low and high x, [2], [3] y, [4], [5] z. */
static inline enum status add_named_box(struct solid_list *list, const char *body, struct vec3 low, struct vec3 high,
                                        const char *const names[6], struct err *err)
{
    const struct half_space h[6] = {
        {{-1, 0, 0}, -low.x, names[0]}, {{1, 0, 0}, high.x, names[1]},  {{0, -1, 0}, -low.y, names[2]},
        {{0, 1, 0}, high.y, names[3]},  {{0, 0, -1}, -low.z, names[4]}, {{0, 0, 1}, high.z, names[5]},
    };
    return solid_list_add(list, body, h, 6, err);
}

/* A box with faces NAME/x0, NAME/x1, ... */
static inline void layout_add_box(struct solid_list *list, const char *name, double x0, double y0, double z0, double x1,
                                  double y1, double z1)
{
    static const char *const sides[6] = {"x0", "x1", "y0", "y1", "z0", "z1"};
    char text[6][64];
    const char *names[6];
    struct err err = ERR_INIT;
    for (int i = 0; i < 6; i++) {
        snprintf(text[i], sizeof text[i], "%s/%s", name, sides[i]);
        names[i] = text[i];
    }
    assert_ok(add_named_box(list, "walls", vec3_make(x0, y0, z0), vec3_make(x1, y1, z1), names, &err), err);
}

/* An upright prism over a convex polygon, counter-clockwise; faces NAME/0, ..., NAME/z0, NAME/z1. */
static inline void add_prism(struct solid_list *list, const char *name, const double (*corners)[2], int count,
                             double z0, double z1)
{
    struct half_space h[16];
    char text[16][64];
    struct err err = ERR_INIT;
    assert_true(count <= 14);
    for (int i = 0; i < count; i++) {
        const double *a = corners[i], *b = corners[(i + 1) % count];
        const struct vec3 n = vec3_normalize(vec3_make(b[1] - a[1], a[0] - b[0], 0));
        snprintf(text[i], sizeof text[i], "%s/%d", name, i);
        h[i] = (struct half_space){n, n.x * a[0] + n.y * a[1], text[i]};
    }
    snprintf(text[count], sizeof *text, "%s/z0", name);
    snprintf(text[count + 1], sizeof *text, "%s/z1", name);
    h[count] = (struct half_space){{0, 0, -1}, -z0, text[count]};
    h[count + 1] = (struct half_space){{0, 0, 1}, z1, text[count + 1]};
    assert_ok(solid_list_add(list, "walls", h, count + 2, &err), err);
}

/* A wall from (x, y) at an angle, degrees, symmetric about its line. */
static inline void add_turned_wall(struct solid_list *list, const char *name, double x, double y, double degrees,
                                   double length, double thickness, double z0, double z1)
{
    static const char *const sides[6] = {"start", "end", "right", "left", "bottom", "top"};
    const double a = degrees * M_PI / 180;
    const struct vec3 u = {cos(a), sin(a), 0}, v = {-sin(a), cos(a), 0}, p = {x, y, 0};
    const double low[3] = {vec3_dot(u, p), vec3_dot(v, p) - thickness / 2, z0};
    const double high[3] = {low[0] + length, vec3_dot(v, p) + thickness / 2, z1};
    const struct vec3 axes[3] = {u, v, {0, 0, 1}};
    struct half_space h[6];
    char text[6][64];
    struct err err = ERR_INIT;
    for (int i = 0; i < 6; i++) {
        snprintf(text[i], sizeof text[i], "%s/%s", name, sides[i]);
        h[i].normal = i % 2 ? axes[i / 2] : vec3_scale(axes[i / 2], -1);
        h[i].offset = i % 2 ? high[i / 2] : -low[i / 2];
        h[i].name = text[i];
    }
    assert_ok(solid_list_add(list, "walls", h, 6, &err), err);
}

static inline int compare_edges(const void *a, const void *b)
{
    const int *p = a, *q = b;
    return p[0] != q[0] ? (p[0] > q[0]) - (p[0] < q[0]) : (p[1] > q[1]) - (p[1] < q[1]);
}

/* Triangles are not reversed (or are flatter than 1e-12), and each of their edges has its opposite exactly once. */
static inline void assert_triangles_closed(const struct solid_mesh *mesh)
{
    struct solid_triangles t = {0};
    struct err err = ERR_INIT;
    assert_ok(solid_mesh_triangulate(&t, mesh, &err), err);
    int(*edges)[2] = malloc((3 * (size_t)t.count + 1) * sizeof *edges), n = 0;
    assert_non_null(edges);
    for (int i = 0; i < t.count; i++) {
        const int *v = t.triangles[i].v;
        const struct vec3 a = mesh->vertices[v[0]].p, b = mesh->vertices[v[1]].p, c = mesh->vertices[v[2]].p;
        const struct vec3 n2 = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
        const double longest = fmax(vec3_length(vec3_sub(b, a)), vec3_length(vec3_sub(c, a)));
        const double area2 = vec3_dot(n2, mesh->faces[t.triangles[i].face].normal);
        assert_true(area2 > 0 || fabs(area2) < 1e-12 * longest);
        for (int k = 0; k < 3; k++, n++) {
            edges[n][0] = v[k];
            edges[n][1] = v[(k + 1) % 3];
        }
    }
    qsort(edges, (size_t)n, sizeof *edges, compare_edges);
    for (int i = 0; i < n; i++) {
        const int back[2] = {edges[i][1], edges[i][0]};
        assert_true(!i || compare_edges(edges[i - 1], edges[i]));
        assert_non_null(bsearch(back, edges, (size_t)n, sizeof *edges, compare_edges));
    }
    free(edges);
    solid_triangles_release(&t);
}

/* Unites, checks everything that does not depend on the solids, releases the list (unless there is a log). */
static inline void unite(struct solid_mesh *mesh, struct solid_report *report, struct unite_log *log,
                         struct solid_list *list)
{
    struct err err = ERR_INIT;
    assert_ok(unite_solids(mesh, list, log, &err), err);
    assert_ok(solid_mesh_check(mesh, 0, report, &err), err);
    assert_true(report->planarity < 1e-9);
    assert_triangles_closed(mesh);
    if (!log) solid_list_release(list); /* the log refers to its names */
}

#define assert_near(found, wanted, tolerance)                                                                      \
    do {                                                                                                           \
        const double found_ = (found), wanted_ = (wanted);                                                         \
        if (!(fabs(found_ - wanted_) <= (tolerance))) fail_msg("%s is %.17g, not %.17g", #found, found_, wanted_); \
    } while (0)

static inline int faces_called(const struct solid_mesh *mesh, const char *name)
{
    int n = 0;
    for (int i = 0; i < mesh->face_count; i++) n += !strcmp(solid_face_name(mesh, i), name);
    return n;
}

static inline int id_of(const struct solid_mesh *mesh, const char *name)
{
    for (int i = 0; i < mesh->name_count; i++)
        if (!strcmp(mesh->names[i].name, name)) return mesh->names[i].id;
    return 0;
}

#endif
