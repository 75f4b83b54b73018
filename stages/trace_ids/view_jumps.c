/* view_jumps.c - how far each pixel of a view is from the nearest jump of the model's depth.
 *
 * Near a depth discontinuity a photograph that is off by a pixel shows the other surface; texture is not taken from
 * there [Colburn 2014, 4.5.2]. Two neighbouring pixels p, q that show different faces have a jump between them unless
 * the faces meet there. Each face has a plane, whose inverse depth w is linear in the pixel; so is D = w_p - w_q. Where
 * faces meet in an edge, D changes its sign between the pixels (half a pixel is allowed on either side, as a ray
 * through an edge may be given to either face); on one plane D is 0: neither is a jump, however steep the faces are.
 * Otherwise the planes are apart by |D| at least in one of the two pixels, and it is a jump if the smaller |D| exceeds
 * `jump` times the larger w. Faces that do not share an edge of the model are different things (a rug on the floor, a
 * step): a tenth of that is enough for them.
 *
 * The distance is Euclidean, to the nearest pixel that has a jump beside it, plus 1. The picture's border and pixels
 * that the view does not have count as jumps. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/distance.h"
#include "stages/trace_ids/view_layers.h"

#define SAME_PLANE 1e-9
#define STRANGERS  0.1 /* of `jump`, between faces that share no edge */

static bool share_edge(const struct solid_mesh *mesh, int a, int b)
{
    const struct solid_face *f = &mesh->faces[a];
    for (int l = f->loop; l < f->loop + f->loops; l++) {
        const int first = mesh->loops[l].half_edge;
        int at = first;
        do {
            const struct solid_half_edge *h = &mesh->half_edges[at];
            if (mesh->loops[mesh->half_edges[h->twin].loop].face == b) return true;
            at = h->next;
        } while (at != first);
    }
    return false;
}

/* Whether there is a jump between pixel (x, y) and the one dx to the right, dy below. */
static bool is_jump(const struct view_trace *t, int x, int y, int dx, int dy, double jump)
{
    const uint32_t p = t->faces[(size_t)y * (size_t)t->width + (size_t)x];
    const uint32_t q = t->faces[(size_t)(y + dy) * (size_t)t->width + (size_t)(x + dx)];
    if (p == q) return false;
    if (!p || !q) return true;
    double gap[4], largest = 0; /* of the planes, half a pixel before the first centre, there, at the second, behind */
    for (int k = 0; k < 4; k++) {
        static const double at[4] = {-0.5, 0, 1, 1.5};
        const double u = x + 0.5 + at[k] * dx, v = y + 0.5 + at[k] * dy;
        const double a = view_trace_inverse_depth(t, p, u, v), b = view_trace_inverse_depth(t, q, u, v);
        gap[k] = a - b;
        if (k == 1) largest = fmax(largest, fabs(a));
        if (k == 2) largest = fmax(largest, fabs(b));
    }
    if (gap[0] <= 0 ? gap[3] >= 0 : gap[3] <= 0) return false;
    const double relative = fmin(fabs(gap[1]), fabs(gap[2])) / largest;
    if (relative <= SAME_PLANE) return false;
    if (relative > jump) return true;
    return relative > STRANGERS * jump && !share_edge(&t->model->mesh, (int)p - 1, (int)q - 1);
}

static void mark_jumps(uint8_t *inside, const struct view_trace *t, const struct layered_depth *depth, double jump)
{
    const int w = t->width, h = t->height;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const size_t i = (size_t)y * (size_t)w + (size_t)x, right = i + 1, below = i + (size_t)w;
            const bool has = depth->interior.id[i] != 0;
            if (x == 0 || y == 0 || x == w - 1 || y == h - 1) inside[i] = 0;
            if (x + 1 < w && (has != (depth->interior.id[right] != 0) || is_jump(t, x, y, 1, 0, jump)))
                inside[i] = inside[right] = 0;
            if (y + 1 < h && (has != (depth->interior.id[below] != 0) || is_jump(t, x, y, 0, 1, jump)))
                inside[i] = inside[below] = 0;
        }
}

enum status view_jumps_find(struct view_ids *ids, const struct view_trace *t, const struct layered_depth *depth,
                            const struct trace_params *params, struct err *err)
{
    const size_t pixels = (size_t)t->width * (size_t)t->height;
    uint8_t *inside = malloc(pixels);
    if (!inside) err_nomem(err, "depth jumps", pixels);
    if (!err->status) {
        memset(inside, 1, pixels);
        mark_jumps(inside, t, depth, params->jump);
    }
    if (!err->status) distance_squared(ids->jump, inside, t->width, t->height, err);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        const bool shown = ids->id[i] && depth->interior.id[i];
        ids->jump[i] = shown ? fminf(VIEW_IDS_FAR, sqrtf(ids->jump[i]) + 1) : 0;
    }
    free(inside);
    return err->status;
}
