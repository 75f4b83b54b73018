/* overlay_picture.c - a model's edges on a photograph.
 *
 * Whether an edge is visible in a photograph is decided by a cube map of depth about the camera: six square perspective
 * pictures of the model's triangles. So any lens can ask in any direction. A side is drawn when it is first asked for:
 * most photographs look at two or three. */
#include "stages/build_model/picture/overlay_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stages/build_model/picture/raster.h"

enum { CUBE = 1024 };

struct cube {
    struct raster side[6]; /* empty until it is asked for */
    struct vec3 center;
    const struct solid_mesh *mesh;
    const struct solid_triangles *triangles;
};

/* Coordinates in the frame of one of the cube's six cameras: z the largest. */
static struct vec3 cube_turn(int side, struct vec3 p)
{
    switch (side) {
    case 0:
        return vec3_make(p.y, p.z, p.x);
    case 1:
        return vec3_make(p.y, p.z, -p.x);
    case 2:
        return vec3_make(p.x, p.z, p.y);
    case 3:
        return vec3_make(p.x, p.z, -p.y);
    case 4:
        return vec3_make(p.x, p.y, p.z);
    default:
        return vec3_make(p.x, p.y, -p.z);
    }
}

static struct vec3 cube_pixel(struct vec3 p)
{
    return vec3_make(0.5 * CUBE * (1 + p.x / p.z), 0.5 * CUBE * (1 + p.y / p.z), 1 / p.z);
}

static void draw_triangle(struct raster *r, int side, struct vec3 center, const struct vec3 corners[3])
{
    const double min_z = 1e-3;
    struct vec3 p[3], clipped[4];
    int n = 0;
    for (int k = 0; k < 3; k++) p[k] = cube_turn(side, vec3_sub(corners[k], center));
    for (int k = 0; k < 3; k++) { /* clip at min_z */
        const struct vec3 a = p[k], b = p[(k + 1) % 3];
        if (a.z > min_z) clipped[n++] = a;
        if ((a.z > min_z) != (b.z > min_z))
            clipped[n++] = vec3_add(a, vec3_scale(vec3_sub(b, a), (min_z - a.z) / (b.z - a.z)));
    }
    for (int k = 1; k + 1 < n; k++)
        raster_triangle(r, cube_pixel(clipped[0]), cube_pixel(clipped[k]), cube_pixel(clipped[k + 1]), NULL);
}

static enum status draw_side(struct cube *c, int side, struct err *err)
{
    if (raster_init(&c->side[side], CUBE, CUBE, NULL, err)) return err->status;
    for (int i = 0; i < c->triangles->count; i++) {
        const struct solid_triangle *t = &c->triangles->triangles[i];
        const struct vec3 corners[3] = {c->mesh->vertices[t->v[0]].p, c->mesh->vertices[t->v[1]].p,
                                        c->mesh->vertices[t->v[2]].p};
        if (!solid_face_is_pane(c->mesh, t->face)) draw_triangle(&c->side[side], side, c->center, corners);
    }
    return ST_OK;
}

static enum status cube_sees(struct cube *c, struct vec3 point, bool *sees, struct err *err)
{
    const struct vec3 to = vec3_sub(point, c->center);
    const double x = fabs(to.x), y = fabs(to.y), z = fabs(to.z);
    const int side = x >= y && x >= z ? (to.x < 0) : y >= z ? 2 + (to.y < 0) : 4 + (to.z < 0);
    const struct vec3 p = cube_turn(side, to);
    *sees = !(p.z > 1e-3);
    if (*sees) return ST_OK;
    if (!c->side[side].near && draw_side(c, side, err)) return err->status;
    const struct vec3 at = cube_pixel(p);
    /* visible if nothing is clearly in front of one of the 3 x 3 pixels: an edge lies on the border of its faces */
    for (int k = 0; k < 9 && !*sees; k++) {
        const int u = (int)at.x + k % 3 - 1, v = (int)at.y + k / 3 - 1;
        if (u < 0 || v < 0 || u >= CUBE || v >= CUBE) continue;
        *sees = (double)c->side[side].near[(size_t)v * CUBE + (size_t)u] <= at.z * 1.01;
    }
    return ST_OK;
}

static enum status draw_edge(unsigned char *rgb, int width, int height, double scale, const struct photo_camera *camera,
                             struct cube *cube, struct vec3 a, struct vec3 b, bool glass, struct err *err)
{
    static const unsigned char seen[3] = {255, 70, 20}, blue[3] = {60, 150, 255}, hidden[3] = {250, 240, 90};
    enum { STEPS = 4096 };
    double last[2] = {-1e9, -1e9};
    for (int i = 0; i <= STEPS; i++) {
        const struct vec3 p = vec3_add(a, vec3_scale(vec3_sub(b, a), (double)i / STEPS));
        double u, v;
        if (!photo_camera_project(camera, p, &u, &v)) continue;
        u *= scale, v *= scale;
        if (hypot(u - last[0], v - last[1]) < 0.7 || u < 0 || v < 0 || u > width || v > height) continue;
        last[0] = u, last[1] = v;
        bool sees;
        if (cube_sees(cube, p, &sees, err)) return err->status;
        raster_dot(rgb, width, height, u, v, sees ? 0.9 : 0.3, glass ? blue : sees ? seen : hidden, sees ? 0.75 : 0.22);
    }
    return ST_OK;
}

/* The photo, downsampled by an integer factor. */
static enum status shrink(unsigned char **rgb, int *width, int *height, double *scale, const struct photo *photo,
                          int side, struct err *err)
{
    const int longest = photo->info.width > photo->info.height ? photo->info.width : photo->info.height;
    const int k = (longest + side - 1) / side, shift = photo->info.bits == 16 ? 8 : 0;
    *width = photo->info.width / k;
    *height = photo->info.height / k;
    *scale = 1.0 / k;
    if (*width < 1 || *height < 1) *width = *height = 1;
    *rgb = malloc(3 * (size_t)*width * (size_t)*height);
    if (!*rgb) return err_nomem(err, "a picture", 3 * (size_t)*width * (size_t)*height);
    for (int y = 0; y < *height; y++)
        for (int x = 0; x < *width; x++)
            for (int c = 0; c < 3; c++) {
                int sum = 0, n = 0;
                for (int j = y * k; j < y * k + k && j < photo->info.height; j++)
                    for (int i = x * k; i < x * k + k && i < photo->info.width; i++, n++)
                        sum += photo->samples[3 * ((size_t)j * (size_t)photo->info.width + (size_t)i) + (size_t)c] >>
                               shift;
                (*rgb)[3 * ((size_t)y * (size_t)*width + (size_t)x) + (size_t)c] = (unsigned char)(sum / (n ? n : 1));
            }
    return ST_OK;
}

enum status overlay_write(const struct solid_mesh *mesh, const struct photo_camera *camera, const struct photo *photo,
                          int side, const char *path, struct err *err)
{
    struct solid_triangles tris = {0};
    struct cube cube = {.center = camera->center, .mesh = mesh, .triangles = &tris};
    unsigned char *rgb = NULL;
    int width = 0, height = 0;
    double scale = 1;
    if (!solid_mesh_triangulate(&tris, mesh, err)) shrink(&rgb, &width, &height, &scale, photo, side, err);
    for (int h = 0; !err->status && h < mesh->half_edge_count; h++) {
        const struct solid_half_edge *e = &mesh->half_edges[h];
        const int f = mesh->loops[e->loop].face;
        if (e->twin < h) continue;
        draw_edge(rgb, width, height, scale, camera, &cube, mesh->vertices[e->origin].p,
                  mesh->vertices[mesh->half_edges[e->next].origin].p, solid_face_is_pane(mesh, f), err);
    }
    if (!err->status) jpeg_write(path, rgb, width, height, 88, err);
    for (int i = 0; i < 6; i++) raster_release(&cube.side[i]);
    free(rgb);
    solid_triangles_release(&tris);
    return err->status;
}
