/* ceiling_places.c - see ceiling_places.h. */
#include "common/light/ceiling_places.h"

#include <math.h>

enum { MAX_STOREYS = 16 };
static const double ROOM = 0.4; /* of the model's height: lower spaces are no rooms */

double ceiling_places_spacing(const struct ceiling_grid *g)
{
    struct vec3 low, high;
    model_rays_bounds(g->rays, &low, &high);
    return fmax(g->spacing * (high.z - low.z), sqrt((high.x - low.x) * (high.y - low.y) / g->most));
}

/* Adds a place below each ceiling that a line upwards meets. Going up it leaves a floor, then enters a ceiling. */
static void add_places_above(struct vec3 *places, int *count, const struct ceiling_grid *g, double x, double y,
                             double bottom)
{
    const double least = ROOM * model_rays_height(g->rays);
    struct vec3 from = vec3_make(x, y, bottom);
    double floor = INFINITY;
    for (int k = 0; k < MAX_STOREYS && *count < g->most; k++) {
        struct ray_hit hit;
        if (!ray_scene_hit(&g->rays->rays, from, vec3_make(0, 0, 1), &hit)) return;
        const double height = hit.point.z - floor;
        const struct vec3 at = vec3_make(x, y, hit.point.z - g->below * height);
        if (hit.front && height >= least && (!g->may_be || g->may_be(g->ctx, at))) places[(*count)++] = at;
        floor = hit.front ? INFINITY : hit.point.z;
        from.z = hit.point.z + 4 * g->rays->rays.epsilon;
    }
}

int ceiling_places_list(struct vec3 *places, const struct ceiling_grid *g)
{
    struct vec3 low, high;
    const double spacing = ceiling_places_spacing(g);
    int count = 0;
    model_rays_bounds(g->rays, &low, &high);
    for (double y = low.y + spacing / 2; y < high.y; y += spacing)
        for (double x = low.x + spacing / 2; x < high.x; x += spacing)
            add_places_above(places, &count, g, x, y, low.z - spacing);
    return count;
}
