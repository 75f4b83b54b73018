/* view_mesh.c - the view mesh [Colburn 2014, 3.6], a form of unstructured lumigraph blending [Buehler 2001].
 *
 * A triangle mesh with its vertices at the views' centres: a plane is fitted to them, and their projections are
 * triangulated (Delaunay). Boundary vertices are duplicated at 4.0 times their offset from the centroid, and the mesh
 * is triangulated again. A pixel's ray, forward or (novel camera in front of the mesh) backward, hits one triangle:
 * three views with barycentric blending weights. A ray that misses the mesh takes the weights of the boundary point in
 * its direction. Near the mesh, where its projection is singular, the weights of the nearest mesh point hold for the
 * whole picture; they fade in over a band. Views with the same centre (a tripod, a photo split into several views)
 * share a vertex, whose weight goes to the views whose pictures contain the ray best.
 *
 * Triangles. Let A, B, C be a triangle's corners relative to the novel camera's centre and d a ray. Then
 *   d det(A, B, C) = e_a A + e_b B + e_c C   with e_a = d . (B x C), e_b = d . (C x A), e_c = d . (A x B),
 * so the line along d meets the triangle where the e have one sign, with barycentric weights e / (e_a + e_b + e_c), at
 * t = det / (e_a + e_b + e_c). All triangles are counter-clockwise in the plane, so e >= 0 means that the line crosses
 * the mesh towards the scene, and the sign of det says whether forward (the camera is behind the mesh) or backward (in
 * front). The e are linear along a row of pixels: a triangle covers an interval of a row, found by three divisions.
 *
 * Beyond the boundary. Lines that miss the triangles meet the plane beyond the rim, at a point p. Seen from the
 * centroid, p lies between two rim vertices a, b, whose edge gives the weights. In the plane's coordinates about the
 * centroid p = o - (o_z / d_z) d, so that q = d_z p = d_z o - o_z d is linear in the pixel as well, and q = alpha a +
 * beta b by two cross products. The weights depend on the direction of q only and are continuous when d turns parallel
 * to the plane; rays that look away from the scene (d_z < 0) keep q = -o_z d.
 *
 * What differs from the thesis:
 * - the plane must face the scene: on an orbit, the best plane through the centres contains the scene, and rays would
 *   run along it; then the plane through the main axis that faces the mean viewing direction is used;
 * - duplicates lie in the fitted plane, so that uneven centres are not exaggerated four times and the extension is
 *   flat;
 * - if the centres spread much more in width than in height, duplicates are stretched across; in the limit of collinear
 *   centres, weights depend only on the position along the line;
 * - the distance to the mesh is measured along the normal, which is continuous even over a bent mesh. */
#include "common/layers/view_mesh.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/math/delaunay.h"

#define DUPLICATE_REACH 4.0  /* times the offset from the centroid */
#define MIN_FACING      0.7  /* min cosine between the fitted plane's normal and the mean viewing direction */
#define SAME_CENTER     1e-6 /* max distance of equal centres, of the spread */
#define SAME_ALONG_LINE 1e-3 /* the same along the line of collinear centres, of its length */
#define COINCIDENT      1e-4 /* max spread of coincident centres, of the distance to the scene */
#define COLLINEAR       0.05 /* max spread across / spread along of collinear centres */
#define FADE_FULL       0.1  /* height, of the spacing, below which only the nearest point's weights count ... */
#define FADE_NONE       0.5  /* ... and above which they do not count */
#define ROW_CHUNK       2048

/* ------------------------------------------------------------------------------------------------------- building */

/* Coordinates along axis_x, axis_y, normal, about the centroid. */
static struct vec3 to_plane(const struct view_mesh *mesh, struct vec3 p)
{
    struct vec3 r = vec3_sub(p, mesh->centroid);
    return vec3_make(vec3_dot(mesh->axis_x, r), vec3_dot(mesh->axis_y, r), vec3_dot(mesh->normal, r));
}

static struct vec3 perpendicular_part(struct vec3 v, struct vec3 unit)
{
    return vec3_sub(v, vec3_scale(unit, vec3_dot(v, unit)));
}

/* Mean direction of a camera axis (row of cam_from_world); the first view's if they cancel out. */
static struct vec3 mean_axis(const struct camera_set *set, int row)
{
    struct vec3 sum = {0};
    for (int i = 0; i < set->view_count; i++) sum = vec3_add(sum, mat3_row(set->views[i].cam_from_world, row));
    if (vec3_length(sum) < 1e-3 * set->view_count) sum = mat3_row(set->views[0].cam_from_world, row);
    return vec3_normalize(sum);
}

/* Unit vector perpendicular to `unit`, close to the cameras' mean axis `row`, or to `other_row` if that is parallel to
 * `unit`. */
static struct vec3 perpendicular_axis(const struct camera_set *set, int row, int other_row, struct vec3 unit)
{
    struct vec3 axis = mean_axis(set, row);
    if (fabs(vec3_dot(axis, unit)) > 0.9) axis = mean_axis(set, other_row);
    return vec3_normalize(perpendicular_part(axis, unit));
}

/* Median distance of the sparse points to the centroid; 0 without points. */
static enum status scene_distance(const struct view_mesh *mesh, double *distance, struct err *err)
{
    int n = mesh->set->model.point_count;
    *distance = 0;
    if (!n) return ST_OK;
    double *d = malloc((size_t)n * sizeof *d);
    if (!d) return err_nomem(err, "the distances of the sparse points", (size_t)n * sizeof *d);
    for (int i = 0; i < n; i++) d[i] = vec3_length(vec3_sub(mesh->set->model.points[i].position, mesh->centroid));
    sort_doubles(d, (size_t)n);
    *distance = d[n / 2];
    free(d);
    return ST_OK;
}

/* Fits the plane and finds the rank. *spread: standard deviation of the centres along their main axis; *aspect: spread
 * across / spread along, within the plane. */
static enum status fit_plane(struct view_mesh *mesh, double *spread, double *aspect, struct err *err)
{
    const struct camera_set *set = mesh->set;
    int n = set->view_count;
    struct vec3 sum = {0};
    double farthest = 0, distance;
    for (int i = 0; i < n; i++) sum = vec3_add(sum, set->views[i].center);
    mesh->centroid = vec3_scale(sum, 1.0 / n);
    struct mat3 cov = {0};
    for (int i = 0; i < n; i++) {
        struct vec3 r = vec3_sub(set->views[i].center, mesh->centroid);
        double v[3] = {r.x, r.y, r.z};
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) cov.m[j][k] += v[j] * v[k] / n;
        farthest = fmax(farthest, vec3_length(set->views[i].center));
    }
    if (scene_distance(mesh, &distance, err)) return err->status;

    double values[3];
    struct mat3 vectors;
    mat3_eigen_symmetric(cov, values, &vectors);
    *spread = sqrt(fmax(values[2], 0));
    struct vec3 ahead = mean_axis(set, 2), main_axis = mat3_row(vectors, 2), fitted = mat3_row(vectors, 0);
    bool coincident = *spread <= fmax(COINCIDENT * distance, 1e-12 * farthest);
    struct vec3 across = perpendicular_part(ahead, main_axis);
    if (coincident)
        mesh->normal = ahead;
    else if (fabs(vec3_dot(fitted, ahead)) >= MIN_FACING && values[1] > 1e-12 * values[2])
        mesh->normal = vec3_dot(fitted, ahead) < 0 ? vec3_scale(fitted, -1) : fitted;
    else if (vec3_length(across) >= 0.2)
        mesh->normal = vec3_normalize(across);
    else if (values[1] >= COLLINEAR * COLLINEAR * values[2])
        mesh->normal = ahead;
    else /* a straight move into the scene: any plane along the line would do, the level one is used */
        mesh->normal = perpendicular_axis(set, 1, 0, main_axis);

    if (coincident) {
        mesh->axis_x = perpendicular_axis(set, 0, 1, mesh->normal);
    } else { /* main axis of the spread within the plane */
        struct mat3 project;
        double nn[3] = {mesh->normal.x, mesh->normal.y, mesh->normal.z};
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) project.m[j][k] = (j == k) - nn[j] * nn[k];
        mat3_eigen_symmetric(mat3_multiply(project, mat3_multiply(cov, project)), values, &vectors);
        mesh->axis_x = vec3_normalize(perpendicular_part(mat3_row(vectors, 2), mesh->normal));
    }
    mesh->axis_y = vec3_cross(mesh->normal, mesh->axis_x);

    double xx = 0, yy = 0;
    for (int i = 0; i < n; i++) {
        struct vec3 p = to_plane(mesh, set->views[i].center);
        xx += p.x * p.x;
        yy += p.y * p.y;
    }
    *aspect = xx > 0 ? sqrt(yy / xx) : 0;
    mesh->rank = coincident ? 0 : *aspect < COLLINEAR ? 1 : 2;
    return ST_OK;
}

/* Links views with the same centre and makes one vertex for each group. */
static void make_vertices(struct view_mesh *mesh, double spread)
{
    const struct view *views = mesh->set->views;
    int n = mesh->view_count;
    double low = 0, high = 0;
    for (int i = 0; i < n; i++) {
        double x = to_plane(mesh, views[i].center).x;
        low = fmin(low, x);
        high = fmax(high, x);
    }
    for (int i = 0; i < n; i++) {
        mesh->next_same[i] = i;
        int same = -1;
        for (int v = 0; v < mesh->vertex_count && same < 0; v++) {
            struct vec3 apart = vec3_sub(views[i].center, mesh->vertices[v]);
            if (mesh->rank == 0 || vec3_length(apart) <= SAME_CENTER * spread ||
                (mesh->rank == 1 && fabs(vec3_dot(mesh->axis_x, apart)) <= SAME_ALONG_LINE * (high - low)))
                same = mesh->vertex_view[v];
        }
        if (same < 0) {
            mesh->vertices[mesh->vertex_count] = views[i].center;
            mesh->vertex_view[mesh->vertex_count++] = i;
        } else {
            mesh->next_same[i] = mesh->next_same[same];
            mesh->next_same[same] = i;
            mesh->shared = true;
        }
    }
}

static enum status median_spacing(struct view_mesh *mesh, struct err *err)
{
    int n = mesh->vertex_count;
    if (n < 2) return ST_OK;
    double *d = malloc((size_t)n * sizeof *d);
    if (!d) return err_nomem(err, "the distances of the views", (size_t)n * sizeof *d);
    for (int i = 0; i < n; i++) {
        d[i] = HUGE_VAL;
        for (int j = 0; j < n; j++)
            if (j != i) d[i] = fmin(d[i], vec3_length(vec3_sub(mesh->vertices[i], mesh->vertices[j])));
    }
    sort_doubles(d, (size_t)n);
    mesh->spacing = n % 2 ? d[n / 2] : (d[n / 2 - 1] + d[n / 2]) / 2;
    free(d);
    return ST_OK;
}

/* A vertex of a view at (x, y) of the plane. */
static int add_duplicate(struct view_mesh *mesh, double x, double y, int view)
{
    struct vec3 in_plane = vec3_add(vec3_scale(mesh->axis_x, x), vec3_scale(mesh->axis_y, y));
    mesh->vertices[mesh->vertex_count] = vec3_add(mesh->centroid, in_plane);
    mesh->vertex_view[mesh->vertex_count] = view;
    return mesh->vertex_count++;
}

static void add_triangle(struct view_mesh *mesh, int a, int b, int c)
{
    memcpy(mesh->triangles[mesh->triangle_count++], (int[3]){a, b, c}, sizeof mesh->triangles[0]);
}

static void add_rim(struct view_mesh *mesh, int a, int b)
{
    memcpy(mesh->rim[mesh->rim_count++], (int[2]){a, b}, sizeof mesh->rim[0]);
}

struct line_vertex {
    double x; /* along the line */
    int vertex;
};

static int compare_line_vertices(const void *a, const void *b)
{
    const struct line_vertex *p = a, *q = b;
    return p->x < q->x ? -1 : p->x > q->x ? 1 : p->vertex - q->vertex;
}

/* Mesh of collinear centres: a strip of columns. Each centre has a duplicate above and below, and both ends of the line
 * are duplicated outwards. */
static enum status mesh_of_line(struct view_mesh *mesh, struct err *err)
{
    int n = mesh->vertex_count;
    if (n < 2) return ST_OK;
    struct line_vertex *line = malloc((size_t)n * sizeof *line);
    mesh->triangles = malloc(((size_t)n * 4 + 8) * sizeof *mesh->triangles);
    mesh->rim = malloc(((size_t)n * 2 + 8) * sizeof *mesh->rim);
    if (!line || !mesh->triangles || !mesh->rim) {
        free(line);
        return err_nomem(err, "the view mesh", (size_t)n * sizeof *mesh->triangles * 4);
    }
    double reach = 0;
    for (int i = 0; i < n; i++) {
        line[i].vertex = i;
        line[i].x = to_plane(mesh, mesh->vertices[i]).x;
        /* not fmax: gcc 12 for arm64 stops with an internal error */
        const double outward = DUPLICATE_REACH * fabs(line[i].x);
        if (outward > reach) reach = outward;
    }
    qsort(line, (size_t)n, sizeof *line, compare_line_vertices);

    /* columns -1 and n are the outward duplicates, 0 .. n - 1 the centres */
    int below = -1, middle = -1, above = -1;
    for (int i = -1; i <= n; i++) {
        int at = i < 0 ? 0 : i == n ? n - 1 : i, vertex = line[at].vertex, view = mesh->vertex_view[vertex];
        double x = line[at].x * (at == i ? 1 : DUPLICATE_REACH);
        int b = add_duplicate(mesh, x, -reach, view), a = add_duplicate(mesh, x, reach, view);
        int m = at == i ? vertex : add_duplicate(mesh, x, 0, view);
        if (i >= 0) {
            add_triangle(mesh, below, b, middle);
            add_triangle(mesh, b, m, middle);
            add_triangle(mesh, middle, m, above);
            add_triangle(mesh, m, a, above);
            add_rim(mesh, below, b);
            add_rim(mesh, a, above);
        }
        if (at != i) {
            add_rim(mesh, i < 0 ? m : b, i < 0 ? b : m);
            add_rim(mesh, i < 0 ? a : m, i < 0 ? m : a);
        }
        below = b, middle = m, above = a;
    }
    free(line);
    return ST_OK;
}

/* edges: those with a triangle on one side only. Returns their number, at most 3 * count. */
static int boundary_edges(const int (*triangles)[3], int count, int (*edges)[2])
{
    int n = 0;
    for (int i = 0; i < 3 * count; i++) {
        int a = triangles[i / 3][i % 3], b = triangles[i / 3][(i + 1) % 3];
        bool inner = false;
        for (int j = 0; j < 3 * count && !inner; j++)
            inner = triangles[j / 3][j % 3] == b && triangles[j / 3][(j + 1) % 3] == a;
        if (inner) continue;
        edges[n][0] = a;
        edges[n++][1] = b;
    }
    return n;
}

static enum status triangulate(struct view_mesh *mesh, struct err *err)
{
    int n = mesh->vertex_count;
    double(*flat)[2] = malloc((size_t)n * sizeof *flat);
    if (!flat) return err_nomem(err, "the view mesh", (size_t)n * sizeof *flat);
    for (int i = 0; i < n; i++) {
        struct vec3 p = to_plane(mesh, mesh->vertices[i]);
        flat[i][0] = p.x;
        flat[i][1] = p.y;
    }
    free(mesh->triangles);
    mesh->triangles = NULL;
    delaunay((const double(*)[2])flat, n, &mesh->triangles, &mesh->triangle_count, err);
    free(flat);
    if (err->status) return err->status;
    free(mesh->rim);
    mesh->rim = malloc(((size_t)mesh->triangle_count * 3 + 1) * sizeof *mesh->rim);
    if (!mesh->rim) return err_nomem(err, "the view mesh", (size_t)mesh->triangle_count * 3 * sizeof *mesh->rim);
    mesh->rim_count = boundary_edges((const int(*)[3])mesh->triangles, mesh->triangle_count, mesh->rim);
    return ST_OK;
}

static enum status mesh_of_plane(struct view_mesh *mesh, double aspect, struct err *err)
{
    if (triangulate(mesh, err)) return err->status;
    double stretch = fmax(1, 0.5 / aspect);
    int corners = mesh->rim_count; /* each boundary vertex begins one boundary edge */
    for (int i = 0; i < corners; i++) {
        int v = mesh->rim[i][0];
        struct vec3 p = to_plane(mesh, mesh->vertices[v]);
        add_duplicate(mesh, DUPLICATE_REACH * p.x, DUPLICATE_REACH * stretch * p.y, mesh->vertex_view[v]);
    }
    return triangulate(mesh, err);
}

enum status view_mesh_build(struct view_mesh *mesh, const struct camera_set *set, struct err *err)
{
    double spread = 0, aspect = 0;
    int n = set->view_count;
    *mesh = (struct view_mesh){.set = set, .view_count = n};
    if (n < 1) return err_set(err, ST_DATA, "a view mesh needs at least one view; the scene has none.");
    size_t max_vertices = 3 * (size_t)n + 6; /* of a strip, the largest case */
    mesh->vertices = malloc(max_vertices * sizeof *mesh->vertices);
    mesh->vertex_view = malloc(max_vertices * sizeof *mesh->vertex_view);
    mesh->next_same = malloc((size_t)n * sizeof *mesh->next_same);
    if (!mesh->vertices || !mesh->vertex_view || !mesh->next_same) {
        err_nomem(err, "the view mesh", max_vertices * sizeof *mesh->vertices);
        goto fail;
    }
    if (fit_plane(mesh, &spread, &aspect, err)) goto fail;
    make_vertices(mesh, spread);
    if (median_spacing(mesh, err)) goto fail;
    if (mesh->rank == 1 && mesh_of_line(mesh, err)) goto fail;
    if (mesh->rank == 2 && mesh_of_plane(mesh, aspect, err)) goto fail;
    return ST_OK;
fail:
    view_mesh_release(mesh);
    return err->status;
}

void view_mesh_release(struct view_mesh *mesh)
{
    if (!mesh) return;
    free(mesh->vertices);
    free(mesh->vertex_view);
    free(mesh->triangles);
    free(mesh->rim);
    free(mesh->next_same);
    *mesh = (struct view_mesh){0};
}

/* ------------------------------------------------------------------------------------------------- weights of rays */

/* Rays of a row of pixels: from + u step, in world coordinates and in the plane's. */
struct ray_row {
    struct vec3 from, step, plane_from, plane_step;
};

/* The part of a row that one triangle (three corners) or the region beyond one rim edge (two) covers. The weight of
 * corner k at u is a[k] + b[k] u, up to a common factor. The span covers the u where all weights and the gate, a
 * further linear function, are >= 0. */
struct span {
    int corners;
    double a[4], b[4]; /* of the corners, then of the gate */
    double volume;     /* of a triangle: det(A, B, C); t = volume / sum of the corners' weights */
    int view[3];
};

/* A span's weights blended with those of the nearest mesh point. */
struct weight_blend {
    struct view_weights base; /* the nearest point's, times the fade */
    int slot[3];              /* of the span's corners in base */
    float keep;               /* 1 - fade: factor of the span's own weights */
};

/* v . (from + u step) = a + b u */
static void line_of(double *a, double *b, struct vec3 v, struct vec3 from, struct vec3 step)
{
    *a = vec3_dot(v, from);
    *b = vec3_dot(v, step);
}

/* False: the camera is on the other side of the triangle. side: 1 behind the mesh, -1 in front, 0 either. */
static bool triangle_span(struct span *s, const struct view_mesh *mesh, int triangle, struct vec3 eye,
                          const struct ray_row *rays, int side)
{
    struct vec3 p[3];
    *s = (struct span){.corners = 3};
    for (int k = 0; k < 3; k++) {
        int v = mesh->triangles[triangle][k];
        p[k] = vec3_sub(mesh->vertices[v], eye);
        s->view[k] = mesh->vertex_view[v];
    }
    struct vec3 bc = vec3_cross(p[1], p[2]);
    double det = vec3_dot(p[0], bc);
    if (side && !(det * side > 0)) return false;
    line_of(&s->a[0], &s->b[0], bc, rays->from, rays->step);
    line_of(&s->a[1], &s->b[1], vec3_cross(p[2], p[0]), rays->from, rays->step);
    line_of(&s->a[2], &s->b[2], vec3_cross(p[0], p[1]), rays->from, rays->step);
    s->volume = det;
    return true;
}

/* away: the span of rays that point away from the scene. */
static void rim_span(struct span *s, const struct view_mesh *mesh, int edge, struct vec3 eye_plane,
                     const struct ray_row *rays, bool away)
{
    const int *v = mesh->rim[edge];
    struct vec3 a = to_plane(mesh, mesh->vertices[v[0]]), b = to_plane(mesh, mesh->vertices[v[1]]);
    double q[2][2]; /* x and y of q: constant and linear part */
    const struct vec3 *d[2] = {&rays->plane_from, &rays->plane_step};
    for (int k = 0; k < 2; k++) {
        double dz = away ? 0 : d[k]->z;
        q[0][k] = dz * eye_plane.x - eye_plane.z * d[k]->x;
        q[1][k] = dz * eye_plane.y - eye_plane.z * d[k]->y;
    }
    double sign = away ? -1 : 1;
    *s = (struct span){.corners = 2,
                       .a = {q[0][0] * b.y - q[1][0] * b.x, a.x * q[1][0] - a.y * q[0][0]},
                       .b = {q[0][1] * b.y - q[1][1] * b.x, a.x * q[1][1] - a.y * q[0][1]},
                       .view = {mesh->vertex_view[v[0]], mesh->vertex_view[v[1]]}};
    s->a[2] = sign * d[0]->z;
    s->b[2] = sign * d[1]->z;
}

/* The view's slot in w; inserted in ascending order if missing. */
static int insert_view(struct view_weights *w, int view)
{
    int at = 0;
    while (at < w->count && w->view[at] < view) at++;
    if (at < w->count && w->view[at] == view) return at;
    for (int k = w->count++; k > at; k--) {
        w->view[k] = w->view[k - 1];
        w->weight[k] = w->weight[k - 1];
    }
    w->view[at] = view;
    w->weight[at] = 0;
    return at;
}

static void make_blend(struct weight_blend *b, const struct span *s, const struct view_weights *nearest, double fade)
{
    b->base = (struct view_weights){0};
    b->keep = (float)(1 - fade);
    if (fade > 0) {
        b->base = *nearest;
        for (int k = 0; k < nearest->count; k++) b->base.weight[k] *= (float)fade;
    }
    for (int k = 0; k < s->corners; k++) insert_view(&b->base, s->view[k]);
    for (int k = 0; k < s->corners; k++) b->slot[k] = insert_view(&b->base, s->view[k]);
}

/* Pixels of [begin, end) that the span covers, with slack so that no gap opens between neighbours; false: none. */
static bool span_pixels(const struct span *s, int begin, int end, int *first, int *last)
{
    const double slack = 1e-6;
    double low = begin, high = end - 1;
    for (int k = 0; k <= s->corners; k++) {
        double root = -s->a[k] / s->b[k] - 0.5;
        if (s->b[k] > 0)
            low = fmax(low, ceil(root - slack));
        else if (s->b[k] < 0)
            high = fmin(high, floor(root + slack));
        else if (s->a[k] < 0)
            return false;
    }
    if (!(low <= high)) return false;
    *first = (int)low;
    *last = (int)high;
    return true;
}

/* The corners' weights at u, which sum to 1; false if all vanish. *sum: the sum before normalisation. */
static inline bool span_weights(const struct span *s, double u, float weight[3], double *sum)
{
    double e[3] = {0};
    for (int k = 0; k < s->corners; k++) {
        e[k] = s->a[k] + s->b[k] * u;
        e[k] = e[k] > 0 ? e[k] : 0;
    }
    *sum = e[0] + e[1] + e[2];
    if (!(*sum > 0)) return false;
    double scale = 1 / *sum;
    for (int k = 0; k < 3; k++) weight[k] = (float)(e[k] * scale);
    return true;
}

static inline void store(struct view_weights *w, const struct weight_blend *b, int corners, const float weight[3])
{
    *w = b->base;
    for (int k = 0; k < corners; k++) w->weight[b->slot[k]] += b->keep * weight[k];
}

/* --------------------------------------------------------------------------------------- views that share a centre */

/* Score of a view by how far inside its picture a ray is: 1 in the middle, 0.05 at the border, decreasing outside, but
 * always above 0. */
static double containment(const struct view *view, struct vec3 ray)
{
    struct vec3 c = mat3_apply(view->cam_from_world, ray);
    double length = vec3_length(c), faint = 1e-6 * (2 + (length > 0 ? c.z / length : 0));
    if (!(c.z > 1e-9 * length)) return faint;
    double u = view->fx * c.x / c.z + view->cx, v = view->fy * c.y / c.z + view->cy;
    double margin = fmin(fmin(u, view->width - u), fmin(v, view->height - v)) / (0.5 * fmin(view->width, view->height));
    return faint + (margin > 0 ? 0.05 + 0.95 * margin : 0.05 / (1 - margin));
}

struct scored_view {
    int view;
    double score;
};

/* Inserts into a list of at most max_count views in descending order. */
static void keep_best(struct scored_view *list, int *count, int max_count, int view, double score)
{
    int at = *count;
    while (at > 0 && list[at - 1].score < score) at--;
    if (at == max_count) return;
    if (*count < max_count) ++*count;
    for (int k = *count - 1; k > at; k--) list[k] = list[k - 1];
    list[at] = (struct scored_view){view, score};
}

/* Splits each vertex's weight among the views that share its centre: the best three, in proportion to their lead over
 * the fourth, so that weights stay continuous where the choice changes. */
static void share_weights(const struct view_mesh *mesh, struct vec3 ray, struct view_weights *w)
{
    struct scored_view all[VIEW_WEIGHTS_MAX + 1];
    int n = 0;
    for (int k = 0; k < w->count; k++) {
        int first = w->view[k];
        if (mesh->next_same[first] == first) {
            keep_best(all, &n, VIEW_WEIGHTS_MAX + 1, first, w->weight[k]);
            continue;
        }
        struct scored_view best[4];
        int found = 0, view = first;
        do { /* the slight preference breaks ties between identical pictures */
            double prefer = 1 - 1e-3 * view / mesh->view_count;
            keep_best(best, &found, 4, view, prefer * containment(&mesh->set->views[view], ray));
            view = mesh->next_same[view];
        } while (view != first);
        double floor_score = found > 3 ? best[3].score : 0, sum = 0;
        int used = found > 3 ? 3 : found;
        for (int i = 0; i < used; i++) sum += best[i].score - floor_score;
        for (int i = 0; i < used; i++) {
            double part = sum > 0 ? (best[i].score - floor_score) / sum : 1.0 / used;
            keep_best(all, &n, VIEW_WEIGHTS_MAX + 1, best[i].view, w->weight[k] * part);
        }
    }
    double floor_score = n > VIEW_WEIGHTS_MAX ? all[VIEW_WEIGHTS_MAX].score : 0, sum = 0;
    if (n > VIEW_WEIGHTS_MAX) n = VIEW_WEIGHTS_MAX;
    for (int i = 0; i < n; i++) sum += all[i].score - floor_score;
    w->count = 0;
    for (int i = 0; i < n; i++) insert_view(w, all[i].view);
    for (int i = 0; i < n; i++)
        w->weight[insert_view(w, all[i].view)] = (float)(sum > 0 ? (all[i].score - floor_score) / sum : 1.0 / n);
}

/* -------------------------------------------------------------------------------------------------- a novel camera */

static struct vec3 to_plane_direction(const struct view_mesh *mesh, struct vec3 d)
{
    return vec3_make(vec3_dot(mesh->axis_x, d), vec3_dot(mesh->axis_y, d), vec3_dot(mesh->normal, d));
}

/* Weights of the mesh point below `eye` along the normal, and the height of the eye above it. */
static void nearest_point(const struct view_mesh *mesh, struct vec3 eye, struct view_weights *w, double *height)
{
    struct ray_row rays = {.from = mesh->normal, .plane_from = {0, 0, 1}};
    struct span s;
    struct weight_blend b;
    float weight[3];
    double sum;
    int first, last;
    struct vec3 at = to_plane(mesh, eye);
    for (int i = 0; i < mesh->triangle_count; i++) {
        if (!triangle_span(&s, mesh, i, eye, &rays, 0) || !span_pixels(&s, 0, 1, &first, &last) ||
            !span_weights(&s, 0, weight, &sum))
            continue;
        make_blend(&b, &s, NULL, 0);
        store(w, &b, 3, weight);
        *height = -s.volume / sum;
        return;
    }
    *height = at.z;
    for (int i = 0; i < mesh->rim_count; i++) {
        rim_span(&s, mesh, i, at, &rays, false);
        if (!span_pixels(&s, 0, 1, &first, &last) || !span_weights(&s, 0, weight, &sum)) continue;
        make_blend(&b, &s, NULL, 0);
        store(w, &b, 2, weight);
        return;
    }
    *w = (struct view_weights){.count = 1, .view = {mesh->vertex_view[0]}, .weight = {1}};
}

void view_mesh_prepare(struct view_mesh_camera *mc, const struct view_mesh *mesh, const struct view *novel)
{
    *mc = (struct view_mesh_camera){.mesh = mesh, .camera = *novel, .fade = 1};
    nearest_point(mesh, novel->center, &mc->nearest, &mc->height);
    if (mesh->triangle_count == 0) return;
    double full = FADE_FULL * mesh->spacing, none = FADE_NONE * mesh->spacing;
    double x = (none - fabs(mc->height)) / (none - full);
    mc->fade = x <= 0 ? 0 : x >= 1 ? 1 : x * x * (3 - 2 * x);
}

static void draw_triangle(const struct span *s, const struct weight_blend *b, int begin, int end, float *nearness,
                          struct view_weights *out)
{
    int first, last;
    if (!span_pixels(s, begin, end, &first, &last)) return;
    double scale = 1 / fabs(s->volume);
    for (int x = first; x <= last; x++) {
        float weight[3];
        double sum;
        if (!span_weights(s, x + 0.5, weight, &sum)) continue;
        float near = (float)(sum * scale);         /* 1 / t */
        if (near <= nearness[x - begin]) continue; /* a bent mesh may be hit several times: the nearest hit counts */
        nearness[x - begin] = near;
        store(&out[x], b, 3, weight);
    }
}

static void draw_beyond(const struct span *s, const struct weight_blend *b, int begin, int end,
                        struct view_weights *out)
{
    int first, last;
    if (!span_pixels(s, begin, end, &first, &last)) return;
    for (int x = first; x <= last; x++) {
        float weight[3];
        double sum;
        if (!out[x].count && span_weights(s, x + 0.5, weight, &sum)) store(&out[x], b, 2, weight);
    }
}

/* Pixels [begin, end) of a row, at most ROW_CHUNK of them. */
static void draw_mesh(const struct view_mesh_camera *mc, const struct ray_row *rays, int begin, int end,
                      struct view_weights *out)
{
    const struct view_mesh *mesh = mc->mesh;
    struct span s;
    struct weight_blend b;
    float nearness[ROW_CHUNK] = {0};
    for (int x = begin; x < end; x++) out[x].count = 0;
    for (int i = 0; i < mesh->triangle_count; i++)
        if (triangle_span(&s, mesh, i, mc->camera.center, rays, mc->height < 0 ? 1 : -1)) {
            make_blend(&b, &s, &mc->nearest, mc->fade);
            draw_triangle(&s, &b, begin, end, nearness, out);
        }
    struct vec3 eye_plane = to_plane(mesh, mc->camera.center);
    for (int x = begin; x < end; x++) {
        if (out[x].count) continue;
        for (int i = 0; i < 2 * mesh->rim_count; i++) { /* for the rest of the row, if any pixel needs it */
            rim_span(&s, mesh, i / 2, eye_plane, rays, i % 2);
            make_blend(&b, &s, &mc->nearest, mc->fade);
            draw_beyond(&s, &b, x, end, out);
        }
        break;
    }
    for (int x = begin; x < end; x++)
        if (!out[x].count) out[x] = mc->nearest;
}

void view_mesh_row(const struct view_mesh_camera *mc, int y, struct view_weights *weights)
{
    const struct view_mesh *mesh = mc->mesh;
    const struct view *cam = &mc->camera;
    struct mat3 world_from_cam = mat3_transpose(cam->cam_from_world);
    struct vec3 left = {-cam->cx / cam->fx, (y + 0.5 - cam->cy) / cam->fy, 1}, step = {1 / cam->fx, 0, 0};
    struct ray_row rays = {.from = mat3_apply(world_from_cam, left), .step = mat3_apply(world_from_cam, step)};
    rays.plane_from = to_plane_direction(mesh, rays.from);
    rays.plane_step = to_plane_direction(mesh, rays.step);
    if (mc->fade >= 1)
        for (int x = 0; x < cam->width; x++) weights[x] = mc->nearest;
    else
        for (int x = 0; x < cam->width; x += ROW_CHUNK)
            draw_mesh(mc, &rays, x, x + ROW_CHUNK < cam->width ? x + ROW_CHUNK : cam->width, weights);
    if (!mesh->shared) return;
    for (int x = 0; x < cam->width; x++)
        share_weights(mesh, vec3_add(rays.from, vec3_scale(rays.step, x + 0.5)), &weights[x]);
}
