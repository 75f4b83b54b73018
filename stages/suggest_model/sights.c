/* sights.c - makes and releases thinned points with lines of sight. */
#include "stages/suggest_model/sights.h"

enum status sights_make(struct sights *sights, const struct point_cloud *cloud, double edge, const struct view *views,
                        int view_count, struct err *err)
{
    *sights = (struct sights){.views = views, .view_count = view_count};
    if (!points_thin(&sights->points, cloud, edge, err))
        rays_find(&sights->rays, &sights->points.cloud, sights->points.weight, views, view_count, err);
    if (err->status) sights_release(sights);
    return err->status;
}

void sights_release(struct sights *sights)
{
    if (!sights) return;
    thin_points_release(&sights->points);
    ray_list_release(&sights->rays);
    *sights = (struct sights){0};
}
