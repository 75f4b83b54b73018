/* parallax.c - see parallax.h. */
#include "stages/plan_path/parallax.h"

#include <stdlib.h>
#include <string.h>

#define SIGMAS 4 /* two depths this far apart are not the same one */

enum status depth_picture_make(struct depth_picture *d, const struct layer_scene *scene, const struct view *camera,
                               int side, struct err *err)
{
    static const struct layer_render_options options = {.soft_z = SOFT_Z_WIDTHS, .fill_diameter = 6};
    const int longer = camera->width > camera->height ? camera->width : camera->height;
    struct rendered_frame frame = {0};

    *d = (struct depth_picture){.camera = *camera};
    if (side < longer)
        view_resize(&d->camera, (int)fmax(1, round((double)camera->width * side / longer)),
                    (int)fmax(1, round((double)camera->height * side / longer)));
    const size_t bytes = (size_t)d->camera.width * (size_t)d->camera.height * sizeof *d->z;
    enum status st = layer_render(&frame, scene, &d->camera, &options, err);
    if (!st && !(d->z = malloc(bytes))) st = err_nomem(err, "a depth map", bytes);
    if (!st) memcpy(d->z, frame.z, bytes);
    rendered_frame_release(&frame);
    return st;
}

void depth_picture_release(struct depth_picture *d)
{
    free(d->z);
    d->z = NULL;
}

double parallax_tolerance(const struct layer_scene *scene)
{
    return fmax(PARALLAX_LEAST_TOLERANCE, SIGMAS * scene->sigma);
}

/* The part of b's picture that a does not see. Both lie in one frame of reference, so a pixel's point goes from one
 * camera to the other by a rotation of its direction, times depth, and a shift. */
static double hidden_part(const struct depth_picture *a, const struct depth_picture *b, double tolerance)
{
    const struct view *from = &b->camera, *to = &a->camera;
    const struct mat3 turn = mat3_multiply(to->cam_from_world, mat3_transpose(from->cam_from_world));
    const struct vec3 shift = vec3_add(mat3_apply(to->cam_from_world, from->center), to->translation);
    long hidden = 0;

    for (int y = 0; y < from->height; y++) {
        const double dy = (y + 0.5 - from->cy) / from->fy;
        for (int x = 0; x < from->width; x++) {
            const double z = (double)b->z[(size_t)y * (size_t)from->width + (size_t)x],
                         dx = (x + 0.5 - from->cx) / from->fx;
            if (!(z > 0)) continue;
            const struct vec3 p = vec3_add(vec3_scale(mat3_apply(turn, vec3_make(dx, dy, 1)), z), shift);
            if (!(p.z > 0)) continue;
            const double u = to->fx * p.x / p.z + to->cx - 0.5, v = to->fy * p.y / p.z + to->cy - 0.5;
            if (!(u >= 0 && v >= 0 && u < to->width - 1 && v < to->height - 1)) continue;
            const float *at = a->z + (size_t)v * (size_t)to->width + (size_t)u;
            const float limit = (float)(p.z / (1 + tolerance));
            const float *below = at + to->width;
            hidden += at[0] > 0 && at[1] > 0 && below[0] > 0 && below[1] > 0 && at[0] < limit && at[1] < limit &&
                      below[0] < limit && below[1] < limit;
        }
    }
    return (double)hidden / ((double)from->width * from->height);
}

double parallax_between(const struct depth_picture *a, const struct depth_picture *b, double tolerance)
{
    return hidden_part(a, b, tolerance) + hidden_part(b, a, tolerance);
}
