/* parallax.c - amount of parallax between two cameras.
 *
 * [Colburn 2014, 3.4.2] measures the parallax of two viewpoints as the hole area when each is projected into the other.
 * Here: a pixel of one picture is hidden from the other camera if its point lies inside the other frame and is farther
 * than all four depths around its projection. Points outside the other frame do not count, since they result from
 * rotation and zoom, not from parallax. A pixel of unknown depth neither hides nor is hidden. */
#include "stages/plan_path/parallax.h"

#include <immintrin.h>
#include <stdlib.h>
#include <string.h>

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
    enum status st = layer_render(&frame, scene, &d->camera, &options, err);
    if (!st) st = parallax_picture_init(d, frame.z, err);
    rendered_frame_release(&frame);
    return st;
}

void parallax_picture_release(struct depth_picture *d)
{
    free(d->z);
    d->z = d->farthest = NULL;
}

double parallax_tolerance(const struct layer_scene *scene)
{
    return fmax(MIN_PARALLAX_TOLERANCE, SIGMAS * scene->sigma);
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
    const __m256 lanes = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7), none = _mm256_setzero_ps();
    const __m256 u_step = _mm256_set1_ps((float)(to->fx * step.x + cx * step.z)),
                 v_step = _mm256_set1_ps((float)(to->fy * step.y + cy * step.z)),
                 w_step = _mm256_set1_ps((float)step.z);
    const __m256 u_shift = _mm256_set1_ps((float)(to->fx * shift.x + cx * shift.z)),
                 v_shift = _mm256_set1_ps((float)(to->fy * shift.y + cy * shift.z)),
                 w_shift = _mm256_set1_ps((float)shift.z);
    const __m256 right = _mm256_set1_ps((float)(to->width - 1)), lower = _mm256_set1_ps((float)(to->height - 1));
    const __m256 nearer = _mm256_set1_ps((float)(1 / (1 + tolerance)));
    const __m256i stride = _mm256_set1_epi32(to->width);
    long hidden = 0;

    for (int y = 0; y < from->height; y++) {
        const struct vec3 d =
            mat3_apply(turn, vec3_make((0.5 - from->cx) / from->fx, (y + 0.5 - from->cy) / from->fy, 1));
        const __m256 u_first = _mm256_set1_ps((float)(to->fx * d.x + cx * d.z)),
                     v_first = _mm256_set1_ps((float)(to->fy * d.y + cy * d.z)), w_first = _mm256_set1_ps((float)d.z);
        const float *row = b->z + (size_t)y * (size_t)from->width;
        for (int x = 0; x < from->width; x += 8) {
            const __m256 along = _mm256_add_ps(_mm256_set1_ps((float)x), lanes);
            const __m256 within = _mm256_cmp_ps(along, _mm256_set1_ps((float)from->width), _CMP_LT_OQ);
            const __m256 z = _mm256_maskload_ps(row + x, _mm256_castps_si256(within));
            const __m256 w =
                _mm256_add_ps(_mm256_mul_ps(z, _mm256_add_ps(w_first, _mm256_mul_ps(along, w_step))), w_shift);
            const __m256 u = _mm256_div_ps(
                _mm256_add_ps(_mm256_mul_ps(z, _mm256_add_ps(u_first, _mm256_mul_ps(along, u_step))), u_shift), w);
            const __m256 v = _mm256_div_ps(
                _mm256_add_ps(_mm256_mul_ps(z, _mm256_add_ps(v_first, _mm256_mul_ps(along, v_step))), v_shift), w);
            __m256 seen = _mm256_and_ps(_mm256_cmp_ps(z, none, _CMP_GT_OQ), _mm256_cmp_ps(w, none, _CMP_GT_OQ));
            seen = _mm256_and_ps(
                seen, _mm256_and_ps(_mm256_cmp_ps(u, none, _CMP_GE_OQ), _mm256_cmp_ps(u, right, _CMP_LT_OQ)));
            seen = _mm256_and_ps(
                seen, _mm256_and_ps(_mm256_cmp_ps(v, none, _CMP_GE_OQ), _mm256_cmp_ps(v, lower, _CMP_LT_OQ)));
            if (!_mm256_movemask_ps(seen)) continue;
            const __m256i at =
                _mm256_add_epi32(_mm256_mullo_epi32(_mm256_cvttps_epi32(v), stride), _mm256_cvttps_epi32(u));
            const __m256 before = _mm256_mask_i32gather_ps(_mm256_set1_ps(INFINITY), a->farthest, at, seen, 4);
            const __m256 behind = _mm256_cmp_ps(before, _mm256_mul_ps(w, nearer), _CMP_LT_OQ);
            hidden += __builtin_popcount((unsigned)_mm256_movemask_ps(behind));
        }
    }
    return (double)hidden / ((double)from->width * from->height);
}

double parallax_between(const struct depth_picture *a, const struct depth_picture *b, double tolerance)
{
    return hidden_fraction(a, b, tolerance) + hidden_fraction(b, a, tolerance);
}
