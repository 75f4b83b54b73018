/* level_table.c - see level_table.h. */
#include "stages/light_levels/level_table.h"

#include <stdio.h>
#include <stdlib.h>

#include "common/base/scan.h"
#include "common/light/surface_points.h"
#include "stages/light_levels/level_spread.h"

/* {0} is the empty state; everything is owned. */
struct given_points {
    struct surface_points list;  /* in the frame of the scene */
    struct gather_point *points; /* in that of the model */
};

static void points_release(struct given_points *p)
{
    free(p->points);
    surface_points_release(&p->list);
}

static enum status points_read(struct given_points *p, const struct levels_job *j, struct err *err)
{
    const struct model_field *field = level_scene_field(&j->scene);
    if (surface_points_read(&p->list, j->files.points, err)) return err->status;
    p->points = malloc(((size_t)p->list.count + 1) * sizeof *p->points);
    if (!p->points) return err_nomem(err, "points", (size_t)p->list.count * sizeof *p->points);
    for (int i = 0; i < p->list.count; i++) {
        const struct surface_point *at = &p->list.list[i];
        p->points[i] = (struct gather_point){model_from_world_point(&j->scene.axes, at->at),
                                             vec3_normalize(model_from_world_direction(&j->scene.axes, at->normal))};
        model_field_lift(field, &p->points[i], 0.02 * model_rays_size(&field->model));
    }
    return ST_OK;
}

static void put_point(const struct surface_point *p)
{
    printf("%.9g %.9g %.9g %.9g %.9g %.9g", p->at.x, p->at.y, p->at.z, p->normal.x, p->normal.y, p->normal.z);
}

static void put_colour(const float *found, const struct light_groups *g)
{
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < 3 * g->patch; k++) sum[k % 3] += (double)found[k];
    printf(" %.9g %.9g %.9g", sum[0], sum[1], sum[2]);
}

static void put_interval(struct level_spread *spread, const struct levels_job *j, const struct level_points *levels,
                         int point, const struct state_weights *w)
{
    static const double factors[2] = {1, 1}, variance[2] = {0, 0};
    const struct light_groups *g = &j->light.groups;
    double sums[2], ends[2];
    level_points_sum(sums, levels, point, w, NULL);
    level_spread_clear(spread);
    level_spread_add_point(spread, levels, point, g, w, factors, 1);
    level_spread_ends(ends, spread, sums[0], &j->errors, g, w, &j->params, variance);
    printf(" %.4g %.4g\n", ends[0], ends[1]);
}

enum status level_table_print(struct levels_job *j, struct err *err)
{
    const struct light_groups *g = &j->light.groups;
    struct given_points given = {.points = NULL};
    struct level_points levels = {0};
    struct level_spread spread = {0};
    struct state_weights w = {0};
    float *found = NULL;
    if (!points_read(&given, j, err) && !level_spread_init(&spread, &j->errors, err) &&
        !level_weights_make(&w, &j->states.items[0], &j->states, g, &j->params, err))
        level_points_find(&levels, &found, &j->light, given.points, given.list.count, &j->params, err);
    for (int i = 0; !err->status && i < given.list.count; i++) {
        put_point(&given.list.list[i]);
        put_colour(found + 3 * (size_t)g->count * (size_t)i, g);
        put_interval(&spread, j, &levels, i, &w);
    }
    free(found);
    level_weights_release(&w);
    level_spread_release(&spread);
    level_points_release(&levels);
    points_release(&given);
    return err->status;
}

static void put_states(const struct levels_job *j, const struct given_points *given, const struct level_points *levels,
                       const struct state_weights *weights)
{
    const double scale = j->scale.is.scale;
    printf("# X Y Z NX NY NZ");
    for (int s = 0; s < j->states.count; s++) printf(" %s", j->states.items[s].name);
    printf("\n");
    for (int i = 0; i < given->list.count; i++) {
        put_point(&given->list.list[i]);
        for (int s = 0; s < j->states.count; s++) {
            const struct state_weights *w = &weights[s];
            double sums[2];
            level_points_sum(sums, levels, i, w, j->light.groups.field);
            if (!(scale > 0) && w->has_relative && w->has_absolute)
                printf(" -");
            else
                printf(" %.9g", (scale > 0 ? scale : 1) * sums[0] + sums[1]);
        }
        printf("\n");
    }
}

enum status level_table_print_states(struct levels_job *j, struct err *err)
{
    const int states = j->states.count;
    struct given_points given = {.points = NULL};
    struct level_points levels = {0};
    struct state_weights *weights = calloc((size_t)states + 1, sizeof *weights);
    if (!weights) return err_nomem(err, "states", (size_t)states * sizeof *weights);
    if (!points_read(&given, j, err))
        level_points_make(&levels, &j->light, given.points, given.list.count, &j->params, err);
    for (int s = 0; !err->status && s < states; s++)
        level_weights_make(&weights[s], &j->states.items[s], &j->states, &j->light.groups, &j->params, err);
    if (!err->status) {
        const locale_t was = uselocale(scan_c_locale());
        put_states(j, &given, &levels, weights);
        uselocale(was);
    }
    for (int s = 0; s < states; s++) level_weights_release(&weights[s]);
    free(weights);
    level_points_release(&levels);
    points_release(&given);
    return err->status;
}
