/* clutter.c - view_faces_find_clutter(): where something that the model does not hold stands in front of it.
 *
 * The clutter of a pixel is about the chance that something stands in front, by how much nearer its depth is than the
 * model's: on pixels of a simulated room of which that is known, depth within 3 % of the model's had something in front in
 * 1 to 4 % of the pixels even where it is inherited from neighbouring segments, and depth nearer by 20 % in 80 % of them,
 * in 94 % and more where other views confirm it. In between nothing is certain. A view from afar cannot tell a bookcase
 * from the wall behind it, so what counts as near the model shrinks with the distance. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/layers/depth_sigma.h"
#include "common/math/distance.h"
#include "stages/trace_ids/view_faces.h"

static const double NEAR_MIN = 0.008,
                    NEAR_MAX = 0.03;             /* relative difference of inverse depth up to which depth agrees */
static const double FURNITURE = 0.037;           /* of the model's height: a depth that must be told apart */
static const double BETWEEN = 1.67;              /* times that from which on nothing is certain */
static const double FAR_BEGIN = 0.15, FAR = 0.2; /* from where, and where, something surely stands in front */
static const double OUTLINE = 3;                 /* pixels around clutter that count as clutter */
static const double SURE_CLUTTER = 0.6, UNKNOWN = 0.5;

static const struct {
    double near, between, far;
} chances[DEPTH_CLASSES] = {
    [DEPTH_CLASS_INHERITED] = {0.1, 0.4, 0.8},
    [DEPTH_CLASS_UNSURE] = {0, 0.4, 0.95},
    [DEPTH_CLASS_SURE] = {0, 0.75, 0.95},
};

static bool is_glass(const struct solid_mesh *m, int face)
{
    return !strncmp(m->bodies[m->faces[face].body].name, "glass/", 6);
}

static double between(double a, double b, double from, double to, double x)
{
    return a + (b - a) * fmax(0, fmin(1, (x - from) / (to - from)));
}

/* z: of the depth, with the segment that it is of; furniture: as a fraction of the model's depth. */
static double clutter_of(double z, const struct depth_segment *s, double model_z, double furniture, bool glass)
{
    const double nearer = model_z / z - 1;
    const double near = fmax(NEAR_MIN, fmin(NEAR_MAX, furniture));
    const enum depth_class c = depth_class(s->confidence);
    if (glass && nearer < 0) return 0; /* what is seen through a pane is its texture */
    if (nearer < FAR_BEGIN) return between(chances[c].near, chances[c].between, near, BETWEEN * near, nearer);
    return between(chances[c].between, chances[c].far, FAR_BEGIN, FAR, nearer);
}

static double height_of(const struct solid_mesh *m)
{
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < m->vertex_count; i++) {
        low = fmin(low, m->vertices[i].p.z);
        high = fmax(high, m->vertices[i].p.z);
    }
    return high > low ? high - low : 0;
}

enum status view_faces_find_clutter(struct view_faces *f, const struct solid_mesh *mesh, const struct layered_depth *d,
                                    double scale, struct err *err)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    const double furniture = FURNITURE * height_of(mesh);
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
            f->clutter[i] = (float)clutter_of(scale * d->interior.z[i], &d->segments[id - 1], f->z[i],
                                              furniture / f->z[i], is_glass(mesh, f->face[i]));
        clear[i] = f->clutter[i] < (float)SURE_CLUTTER;
    }
    if (!st) st = distance_squared(squared, clear, f->width, f->height, err);
    for (size_t i = 0; !st && i < pixels; i++)
        if (squared[i] <= (float)(OUTLINE * OUTLINE)) f->clutter[i] = 1;
    free(clear);
    free(squared);
    return st;
}
