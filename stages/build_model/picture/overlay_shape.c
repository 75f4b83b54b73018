/* overlay_shape.c - see overlay_shape.h.
 *
 * A plane face is its boundary, so two faces are the same if they have the same set of edges. Names, colours and
 * textures are not drawn.
 *
 * A photo cannot show a face if the face lies on one side of a plane through the camera, and the photo's rays, which a
 * cone about its axis holds, on the other. Planes that touch a slightly wider cone are tried. A lens whose cone is as
 * wide as a half-space or wider may show everything. */
#include "stages/build_model/picture/overlay_shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/numbers.h"

enum { SAMPLES = 16, PLANES = 48 };         /* of a side of the photo's border; around the cone */
static const double WIDER = 2, WIDEST = 85; /* degrees */

struct edge {
    double p[6]; /* its ends, the lesser first */
};

static int compare_points(const double *a, const double *b)
{
    for (int k = 0; k < 3; k++)
        if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
    return 0;
}

static int compare_edges(const void *a, const void *b)
{
    const double *p = ((const struct edge *)a)->p, *q = ((const struct edge *)b)->p;
    const int first = compare_points(p, q);
    return first ? first : compare_points(p + 3, q + 3);
}

static int compare_faces(const void *a, const void *b)
{
    const struct shape_face *p = a, *q = b;
    const int order = strcmp(p->hash, q->hash);
    return order ? order : (p->face > q->face) - (p->face < q->face);
}

static struct edge edge_of(const struct solid_mesh *m, int half_edge)
{
    const struct solid_half_edge *h = &m->half_edges[half_edge];
    const struct vec3 a = m->vertices[h->origin].p, b = m->vertices[m->half_edges[h->next].origin].p;
    /* -0 is 0 */
    const double p[3] = {a.x + 0.0, a.y + 0.0, a.z + 0.0}, q[3] = {b.x + 0.0, b.y + 0.0, b.z + 0.0};
    const bool turned = compare_points(p, q) > 0;
    struct edge e;
    memcpy(e.p, turned ? q : p, sizeof p);
    memcpy(e.p + 3, turned ? p : q, sizeof q);
    return e;
}

/* edges: room for those of a face, and one more. */
static void hash_face(struct shape_face *to, const struct solid_mesh *m, int face, struct edge *edges)
{
    const struct solid_face *f = &m->faces[face];
    size_t count = 0;
    for (int l = f->loop; l < f->loop + f->loops; l++) {
        int h = m->loops[l].half_edge;
        do {
            edges[count++] = edge_of(m, h);
            h = m->half_edges[h].next;
        } while (h != m->loops[l].half_edge);
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    edges[count] = (struct edge){{solid_face_is_pane(m, face)}};
    hash_bytes(to->hash, edges, (count + 1) * sizeof *edges);
    to->face = face;
}

enum status overlay_shape_make(struct overlay_shape *shape, const struct solid_mesh *mesh, struct err *err)
{
    struct edge *edges = malloc(((size_t)mesh->half_edge_count + 1) * sizeof *edges);
    shape->faces = calloc((size_t)mesh->face_count + 1, sizeof *shape->faces);
    if (!edges || !shape->faces) err_nomem(err, "edges", (size_t)mesh->half_edge_count * sizeof *edges);
    for (int f = 0; !err->status && f < mesh->face_count; f++) hash_face(&shape->faces[shape->count++], mesh, f, edges);
    if (shape->count) qsort(shape->faces, (size_t)shape->count, sizeof *shape->faces, compare_faces);
    free(edges);
    return err->status;
}

void overlay_shape_release(struct overlay_shape *shape)
{
    free(shape->faces);
    *shape = (struct overlay_shape){0};
}

enum status overlay_shape_hash(char hash[HASH_TEXT], const struct overlay_shape *shape, struct err *err)
{
    const size_t size = (size_t)shape->count * HASH_TEXT;
    char *all = malloc(size + 1);
    if (!all) return err_nomem(err, "a hash", size);
    for (int i = 0; i < shape->count; i++) memcpy(all + (size_t)i * HASH_TEXT, shape->faces[i].hash, HASH_TEXT);
    hash_bytes(hash, all, size);
    free(all);
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- photos */

/* Normals of planes through the camera that have all rays of the photo behind them; false: there are none. */
static bool cone_planes(struct vec3 planes[PLANES], const struct photo_camera *camera)
{
    const struct mat3 world_from_cam = mat3_transpose(camera->cam_from_world);
    double least = 1;
    for (int i = 0; i < 4 * SAMPLES; i++) {
        const double t = (i % SAMPLES + 0.5) / SAMPLES, w = camera->lens.width, h = camera->lens.height;
        const double u = i / SAMPLES < 2 ? t * w : i / SAMPLES == 2 ? 0 : w;
        const double v = i / SAMPLES < 2 ? (i / SAMPLES == 0 ? 0 : h) : t * h;
        struct vec3 ray;
        if (!photo_camera_ray(camera, u, v, &ray)) return false;
        least = fmin(least, mat3_apply(camera->cam_from_world, ray).z);
    }
    for (int i = 0; i < 4; i++) {
        struct vec3 ray;
        if (!photo_camera_ray(camera, i & 1 ? camera->lens.width : 0, i & 2 ? camera->lens.height : 0, &ray))
            return false;
        least = fmin(least, mat3_apply(camera->cam_from_world, ray).z);
    }
    const double angle = acos(least) + WIDER * DEGREE;
    if (!(angle < WIDEST * DEGREE)) return false;
    for (int i = 0; i < PLANES; i++) {
        const double turn = 2 * PI * i / PLANES;
        planes[i] = mat3_apply(world_from_cam, vec3_make(cos(angle) * cos(turn), cos(angle) * sin(turn), -sin(angle)));
    }
    return true;
}

static bool is_before(const struct solid_mesh *m, int face, struct vec3 plane, struct vec3 centre)
{
    const struct solid_loop *outer = &m->loops[m->faces[face].loop];
    int h = outer->half_edge;
    do {
        if (!(vec3_dot(plane, vec3_sub(m->vertices[m->half_edges[h].origin].p, centre)) > 0)) return false;
        h = m->half_edges[h].next;
    } while (h != outer->half_edge);
    return true;
}

static bool may_show(const struct solid_mesh *m, int face, const struct vec3 *planes, struct vec3 centre)
{
    for (int i = 0; i < PLANES; i++)
        if (is_before(m, face, planes[i], centre)) return false;
    return true;
}

bool overlay_shape_differs(const struct solid_mesh *a, const struct overlay_shape *of_a, const struct solid_mesh *b,
                           const struct overlay_shape *of_b, const struct photo_camera *camera)
{
    struct vec3 planes[PLANES];
    const bool narrow = cone_planes(planes, camera);
    for (int i = 0, k = 0; i < of_a->count || k < of_b->count;) {
        const int order = i == of_a->count   ? 1
                          : k == of_b->count ? -1
                                             : strcmp(of_a->faces[i].hash, of_b->faces[k].hash);
        if (order < 0 && (!narrow || may_show(a, of_a->faces[i].face, planes, camera->center))) return true;
        if (order > 0 && (!narrow || may_show(b, of_b->faces[k].face, planes, camera->center))) return true;
        i += order <= 0;
        k += order >= 0;
    }
    return false;
}
