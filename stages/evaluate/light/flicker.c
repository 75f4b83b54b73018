/* flicker.c - see flicker.h.
 *
 * A frame's depth and camera give the place that a pixel shows; the next frame's give where that is then. The quotient
 * there is bilinear in the quotients of four pixels, which must show the same face at the place's depth. */
#include "stages/evaluate/light/flicker.h"

#include <math.h>
#include <stdlib.h>

#include "common/image/luminance.h"
#include "stages/evaluate/light/relit_error.h"

#define SAME_DEPTH 0.02 /* largest relative difference of depth of one surface */

void flicker_frame_release(struct film_frame *f)
{
    model_picture_release(&f->unlit);
    free(f->quotient);
    *f = (struct film_frame){.quotient = NULL};
}

static float quotient(const struct film_frame *f, const struct exr_plane *const relit[4], double exposure, size_t i)
{
    const struct model_picture *p = &f->unlit;
    if (p->made[i] < MADE_ORIGINAL || p->made[i] > MADE_COLOUR || !p->id[i] || !(p->z[i] > 0)) return -1;
    if (relit[3]->u[i] != p->made[i]) return -1; /* an object */
    const float after[3] = {relit[0]->f[i], relit[1]->f[i], relit[2]->f[i]};
    const double before = exposure * (double)luminance_of(p->rgb + 3 * i);
    return before > 1e-3 ? (float)((double)luminance_of(after) / before) : -1;
}

enum status flicker_frame_set_quotients(struct film_frame *f, const struct exr_image *relit, const char *path,
                                        struct err *err)
{
    static const char *const names[4] = {"R", "G", "B", "made"};
    const struct exr_plane *planes[4];
    const char *text = exr_attribute(relit, "remodel:exposure");
    const double exposure = text ? atof(text) : 0;
    const size_t pixels = (size_t)f->unlit.width * (size_t)f->unlit.height;
    for (int k = 0; k < 4; k++) {
        planes[k] = exr_find(relit, names[k]);
        if (!planes[k] || !(k < 3 ? (const void *)planes[k]->f : (const void *)planes[k]->u))
            return err_set(err, ST_DATA,
                           "%s has no channel %s, so it is not a frame of a relit film; run make relit-tour again.",
                           path, names[k]);
    }
    if (!f->unlit.has_camera || relit->width != f->unlit.width || relit->height != f->unlit.height || !(exposure > 0))
        return err_set(err, ST_DATA,
                       "%s does not match the frame before it was relit in size, or lacks its exposure or camera; run "
                       "make relit-tour again.",
                       path);
    float *quotients = realloc(f->quotient, pixels * sizeof *quotients);
    if (!quotients) return err_nomem(err, "quotients", pixels * sizeof *quotients);
    f->quotient = quotients;
    for (size_t i = 0; i < pixels; i++) f->quotient[i] = quotient(f, planes, exposure, i);
    return ST_OK;
}

static bool place_of(struct vec3 *at, const struct model_picture *p, int x, int y)
{
    const double z = (double)p->z[(size_t)y * (size_t)p->width + (size_t)x];
    struct vec3 ray;
    if (!camera_unproject(&p->lens, x + 0.5, y + 0.5, &ray) || !(ray.z > 0)) return false;
    const struct vec3 local = vec3_sub(vec3_scale(ray, z / ray.z), p->pose.translation);
    *at = mat3_apply(mat3_transpose(mat3_from_quat(p->pose.rotation)), local);
    return true;
}

/* The quotient of a place in a frame; below 0: the frame does not show it, or it does not count there. */
static double quotient_at(const struct film_frame *f, struct vec3 at, uint32_t id)
{
    const struct model_picture *p = &f->unlit;
    const struct vec3 local = pose_apply(&p->pose, at);
    double u, v, sum = 0;
    if (!(local.z > 0) || !camera_project(&p->lens, local, &u, &v)) return -1;
    const double x = floor(u - 0.5), y = floor(v - 0.5);
    if (!(x >= 0 && y >= 0 && x < p->width - 1 && y < p->height - 1)) return -1;
    for (int k = 0; k < 4; k++) {
        const size_t i = ((size_t)y + (size_t)(k >> 1)) * (size_t)p->width + (size_t)x + (size_t)(k & 1);
        const double weight = (k & 1 ? u - 0.5 - x : 1.5 + x - u) * (k >> 1 ? v - 0.5 - y : 1.5 + y - v);
        const double q = (double)f->quotient[i];
        if (q < 0 || p->id[i] != id || fabs((double)p->z[i] - local.z) > SAME_DEPTH * local.z) return -1;
        sum += weight * q;
    }
    return sum;
}

uint64_t flicker_add(struct quantiles *differences, const struct film_frame *frame, const struct film_frame *next)
{
    const struct model_picture *p = &frame->unlit;
    uint64_t count = 0;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            const size_t i = (size_t)y * (size_t)p->width + (size_t)x;
            const double q = (double)frame->quotient[i];
            struct vec3 at;
            if (!(q > 0) || !place_of(&at, p, x, y)) continue;
            const double then = quotient_at(next, at, p->id[i]);
            if (!(then > 0) || (fabs(q - 1) <= RELIT_CHANGE && fabs(then - 1) <= RELIT_CHANGE)) continue;
            quantiles_add(differences, (float)(fabs(then - q) / fmin(q, then)));
            count++;
        }
    return count;
}
