/* clutter.c - view_faces_find_clutter(): where something that the model does not hold stands in front of it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/layers/depth_sigma.h"
#include "common/math/distance.h"
#include "stages/trace_ids/view_faces.h"

static const double SIGMAS = 3;          /* of depth, within which it agrees with the model */
static const double MODEL_ERROR = 0.015; /* relative error of the model's inverse depth */
static const double UNKNOWN = 0.5;
static const double DOUBT = 0.6; /* of what unsure depth says, the rest being unknown */
static const double OUTLINE = 3; /* pixels around clutter that count as clutter */
static const double SURE_CLUTTER = 0.6;

static bool is_glass(const struct solid_mesh *m, int face)
{
    return !strncmp(m->bodies[m->faces[face].body].name, "glass/", 6);
}

/* Of a depth, with the segment that it is of: 0 agrees, 1 in front. */
static double clutter_of(double z, const struct depth_segment *s, double model_z, bool glass)
{
    const double nearer = model_z / z - 1; /* relative difference of inverse depth */
    const double sigma = depth_sigma(s), tolerance = hypot(SIGMAS * sigma, MODEL_ERROR);
    const enum depth_class class = depth_class(s->confidence);
    if (class == DEPTH_CLASS_INHERITED) return glass && nearer < 0 ? 0 : UNKNOWN;
    double c = fmax(0, fmin(1, (nearer / tolerance - 0.7) / 0.6));
    if (!glass && nearer < -2 * tolerance) c = UNKNOWN;
    return class == DEPTH_CLASS_SURE ? c : UNKNOWN + DOUBT * (c - UNKNOWN);
}

enum status view_faces_find_clutter(struct view_faces *f, const struct solid_mesh *mesh, const struct layered_depth *d,
                                    double scale, struct err *err)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    if (d->width != f->width || d->height != f->height)
        return err_set(err, ST_DATA, "the depth has %d x %d pixels, but the view %d x %d; make the depth again.",
                       d->width, d->height, f->width, f->height);
    uint8_t *clear = calloc(pixels, 1);
    float *squared = malloc(pixels * sizeof *squared);
    enum status st = clear && squared ? ST_OK : err_nomem(err, "clutter", pixels * sizeof *squared);
    for (size_t i = 0; !st && i < pixels; i++) {
        const uint32_t id = d->interior.id[i];
        f->clutter[i] = (float)UNKNOWN;
        if (id && f->face[i] >= 0 && d->interior.z[i] > 0)
            f->clutter[i] =
                (float)clutter_of(scale * d->interior.z[i], &d->segments[id - 1], f->z[i], is_glass(mesh, f->face[i]));
        clear[i] = f->clutter[i] < (float)SURE_CLUTTER;
    }
    if (!st) st = distance_squared(squared, clear, f->width, f->height, err);
    for (size_t i = 0; !st && i < pixels; i++)
        if (squared[i] <= (float)(OUTLINE * OUTLINE)) f->clutter[i] = fmaxf(f->clutter[i], 1);
    free(clear);
    free(squared);
    return st;
}
