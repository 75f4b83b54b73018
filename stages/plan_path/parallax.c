/* parallax.c - amount of parallax between two cameras.
 *
 * [Colburn 2014, 3.4.2] measures the parallax of two viewpoints as the hole area when each is projected into the other.
 * Here: a pixel of one picture is hidden from the other camera if its point lies inside the other frame and is farther
 * than all four depths around its projection. Points outside the other frame do not count, since they result from
 * rotation and zoom, not from parallax. A pixel of unknown depth neither hides nor is hidden. */
#include "stages/plan_path/parallax.h"

#include <stdlib.h>
#include <string.h>

#include "common/math/lanes.h"

#define SIGMAS 4 /* depths this far apart belong to different surfaces */

/* farthest[p]: the largest of the four depths around the lower right corner of pixel p; INFINITY, which hides nothing,
 * if one of them is unknown. */
static void find_farthest(struct depth_picture *d)
{
    const size_t width = (size_t)d->camera.width, height = (size_t)d->camera.height;
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++) {
            const float *at = d->z + y * width + x;
            float *far = d->farthest + y * width + x;
            *far = INFINITY;
            if (x + 1 == width || y + 1 == height) continue;
            const float nearest = fminf(fminf(at[0], at[1]), fminf(at[width], at[width + 1]));
            if (nearest > 0) *far = fmaxf(fmaxf(at[0], at[1]), fmaxf(at[width], at[width + 1]));
        }
}

enum status parallax_picture_init(struct depth_picture *d, const float *z, struct err *err)
{
    const size_t pixels = (size_t)d->camera.width * (size_t)d->camera.height;
    d->z = malloc(2 * pixels * sizeof *d->z);
    if (!d->z) return err_nomem(err, "a depth map", 2 * pixels * sizeof *d->z);
    d->farthest = d->z + pixels;
    memcpy(d->z, z, pixels * sizeof *z);
    find_farthest(d);
    return ST_OK;
}

enum status parallax_picture_make(struct depth_picture *d, const struct layer_scene *scene, const struct view *camera,
                                  int side, struct err *err)
{
    static const struct layer_render_options options = {.soft_z = SOFT_Z_WIDTHS, .fill_diameter = 6};
    const int longer = camera->width > camera->height ? camera->width : camera->height;
    struct rendered_frame frame = {0};

    *d = (struct depth_picture){.camera = *camera};
    if (side < longer)
        view_resize(&d->camera, (int)fmax(1, round((double)camera->width * side / longer)),
                    (int)fmax(1, round((double)camera->height * side / longer)));
    if (!layer_render(&frame, scene, &d->camera, &options, err)) parallax_picture_init(d, frame.z, err);
    rendered_frame_release(&frame);
    return err->status;
}

void parallax_picture_release(struct depth_picture *d)
{
    free(d->z);
    d->z = d->farthest = NULL;
}

double parallax_tolerance(const struct layer_scene *scene)
{
    return fmin(fmax(MIN_PARALLAX_TOLERANCE, SIGMAS * scene->sigma), MAX_PARALLAX_TOLERANCE);
}

/* Fraction of b's picture that is hidden from a. A pixel's point in a's camera is its rotated ray times its depth plus
 * a translation, so its homogeneous pixel (u, v, w) in a is linear in x along a row. Eight pixels at a time. */
static double hidden_fraction(const struct depth_picture *a, const struct depth_picture *b, double tolerance)
{
    const struct view *from = &b->camera, *to = &a->camera;
    const struct mat3 turn = mat3_multiply(to->cam_from_world, mat3_transpose(from->cam_from_world));
    const struct vec3 shift = vec3_add(mat3_apply(to->cam_from_world, from->center), to->translation);
    const double cx = to->cx - 0.5, cy = to->cy - 0.5;
    const struct vec3 step = mat3_apply(turn, vec3_make(1 / from->fx, 0, 0));
    const f32x8 lanes = {0, 1, 2, 3, 4, 5, 6, 7}, none = {0};
    const f32x8 u_step = f32x8_all((float)(to->fx * step.x + cx * step.z)),
                v_step = f32x8_all((float)(to->fy * step.y + cy * step.z)), w_step = f32x8_all((float)step.z);
    const f32x8 u_shift = f32x8_all((float)(to->fx * shift.x + cx * shift.z)),
                v_shift = f32x8_all((float)(to->fy * shift.y + cy * shift.z)), w_shift = f32x8_all((float)shift.z);
    const f32x8 right = f32x8_all((float)(to->width - 1)), lower = f32x8_all((float)(to->height - 1));
    const f32x8 nearer = f32x8_all((float)(1 / (1 + tolerance)));
    long hidden = 0;

    for (int y = 0; y < from->height; y++) {
        const struct vec3 d =
            mat3_apply(turn, vec3_make((0.5 - from->cx) / from->fx, (y + 0.5 - from->cy) / from->fy, 1));
        const f32x8 u_first = f32x8_all((float)(to->fx * d.x + cx * d.z)),
                    v_first = f32x8_all((float)(to->fy * d.y + cy * d.z)), w_first = f32x8_all((float)d.z);
        const float *row = b->z + (size_t)y * (size_t)from->width;
        for (int x = 0; x < from->width; x += 8) {
            const f32x8 along = (float)x + lanes;
            const i32x8 within = along < (float)from->width;
            const f32x8 z = f32x8_load_if(within, row + x);
            const f32x8 w = z * (w_first + along * w_step) + w_shift;
            const f32x8 u = (z * (u_first + along * u_step) + u_shift) / w;
            const f32x8 v = (z * (v_first + along * v_step) + v_shift) / w;
            i32x8 seen = (z > none) & (w > none);
            seen &= (u >= none) & (u < right);
            seen &= (v >= none) & (v < lower);
            if (!i32x8_any(seen)) continue;
            const i32x8 at = i32x8_index(i32x8_truncate(v), to->width, i32x8_truncate(u));
            const f32x8 before = f32x8_gather_if(seen, a->farthest, at, f32x8_all(INFINITY));
            const i32x8 behind = before < w * nearer;
            hidden += __builtin_popcount(i32x8_signs(behind));
        }
    }
    return (double)hidden / ((double)from->width * from->height);
}

double parallax_between(const struct depth_picture *a, const struct depth_picture *b, double tolerance)
{
    return hidden_fraction(a, b, tolerance) + hidden_fraction(b, a, tolerance);
}
