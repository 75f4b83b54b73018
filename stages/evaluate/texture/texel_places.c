/* texel_places.c - see texel_places.h.
 *
 * The tile's matrix M takes points to pixels, (x w, y w, w) = M (P, 1), and the plane adds the row (n, -d) (P, 1) = 0.
 * Together they are a 4 x 4 matrix Q with Q (P, 1) = w (x, y, 1, 0), so (P, 1) is proportional to the first three
 * columns of its inverse times (x, y, 1). The inverse is exact up to rounding: a texel has one place. */
#include "stages/evaluate/texture/texel_places.h"

#include <math.h>
#include <string.h>

#include "common/math/inverse.h"

enum { N = 4 };
#define SINGULAR 1e-12 /* a pivot this much smaller than its row: the plane contains the centre */

bool texel_places_init(struct texel_places *places, const struct atlas_tile *tile, struct vec3 normal, double offset)
{
    double q[N][N] = {{0}};
    const double plane[N] = {normal.x, normal.y, normal.z, -offset};
    memcpy(q, tile->matrix, sizeof tile->matrix);
    memcpy(q[3], plane, sizeof plane);
    if (!inverse_of(&q[0][0], N, SINGULAR)) return false;
    for (int i = 0; i < N; i++)
        for (int k = 0; k < 3; k++) places->inverse[i][k] = q[i][k];
    memcpy(places->w, tile->matrix[2], sizeof places->w);
    return true;
}

bool texel_place(struct vec3 *p, const struct texel_places *places, double x, double y)
{
    double h[N];
    for (int i = 0; i < N; i++) h[i] = places->inverse[i][0] * x + places->inverse[i][1] * y + places->inverse[i][2];
    if (!(h[3] != 0)) return false;
    *p = vec3_make(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
    const double w = places->w[0] * p->x + places->w[1] * p->y + places->w[2] * p->z + places->w[3];
    return isfinite(p->x) && isfinite(p->y) && isfinite(p->z) && w > 0;
}
