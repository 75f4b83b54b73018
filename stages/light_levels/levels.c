/* levels.c - see levels.h.
 *
 * Overview. Surfaces are cut into patches (patches.c), light is divided into groups (groups.c), rays say what each
 * patch gets directly and from other patches (rows.c), the photographs say what it reflects (colours.c), and one
 * solve passes all groups on between patches (radiosity.c). Then rays from the points of rooms and places
 * (sensors.c) give what each group brings there. All that follows is sums (level_sums.c, level_sheet.c): states of
 * lamps and sky, daylight factors, hours of a year. */
#include "stages/light_levels/levels.h"

#include <stdio.h>
#include <stdlib.h>

#include "common/base/log.h"
#include "common/light/surface_points.h"
#include "common/product/product.h"
#include "stages/light_levels/level_file.h"
#include "stages/light_levels/level_sheet.h"
#include "stages/light_levels/quantities.h"

void levels_release(struct levels_job *j)
{
    sheet_release(&j->sheet);
    sheet_release(&j->before);
    level_points_release(&j->levels);
    lux_scale_release(&j->scale);
    weather_release(&j->weather);
    sensors_release(&j->sensors);
    level_light_release(&j->light);
    state_list_release(&j->states);
    place_list_release(&j->places);
    model_plan_release(&j->plan);
    level_scene_release(&j->scene);
    provenance_release(&j->prov);
}

/* ----------------------------------------------------------------------------------------------------- given points */

/* Irradiance of the photographed state at points in the frame of the scene: lines X Y Z NX NY NZ R G B on stdout. */
static enum status print_points(struct levels_job *j, struct err *err)
{
    struct surface_points list = {0};
    struct gather_point *points = NULL;
    struct light_rows direct = {0};
    float *found = NULL;
    const struct light_groups *g = &j->light.groups;
    if (!surface_points_read(&list, j->files.points, err)) {
        points = malloc(((size_t)list.count + 1) * sizeof *points);
        if (!points) err_nomem(err, "points", (size_t)list.count * sizeof *points);
    }
    for (int i = 0; !err->status && i < list.count; i++) {
        points[i] =
            (struct gather_point){model_from_world_point(&j->scene.axes, list.list[i].at),
                                  vec3_normalize(model_from_world_direction(&j->scene.axes, list.list[i].normal))};
        model_field_lift(level_scene_field(&j->scene), &points[i],
                         0.02 * model_rays_size(&level_scene_field(&j->scene)->model));
    }
    if (!err->status) level_light_at(&found, &direct, &j->light, points, list.count, &j->params, err);
    for (int i = 0; !err->status && i < list.count; i++) {
        double sum[3] = {0, 0, 0};
        for (int k = 0; k < 3 * g->patch; k++)
            sum[k % 3] += (double)found[3 * (size_t)g->count * (size_t)i + (size_t)k];
        const struct surface_point *p = &list.list[i];
        printf("%.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", p->at.x, p->at.y, p->at.z, p->normal.x, p->normal.y,
               p->normal.z, sum[0], sum[1], sum[2]);
    }
    free(found);
    rows_release(&direct);
    free(points);
    surface_points_release(&list);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------------- all */

static enum status read_inputs(struct levels_job *j, struct err *err)
{
    const struct levels_files *f = &j->files;
    if (f->places && place_list_read(&j->places, f->places, &j->prov, err)) return err->status;
    if (f->before && sheet_read(&j->before, f->before, &j->prov, err)) return err->status;
    if (f->scale && lux_scale_read(&j->scale, f->scale, &j->prov, err)) return err->status;
    if (f->weather && weather_read(&j->weather, f->weather, &j->prov, err)) return err->status;
    if (state_list_read(&j->states, f->states, &j->prov, err) || model_plan_read(&j->plan, f->plan, &j->prov, err) ||
        level_scene_read(&j->scene, &f->light, &j->prov, err) ||
        level_lamps_check(&j->states, &level_scene_field(&j->scene)->lights, err))
        return err->status;
    if (!j->scene.axes.metric)
        log_warn("the scene has no scale: distances of points and the height of the work plane are in its own unit. "
                 "Give the scale as docs/model-script.md explains.");
    return ST_OK;
}

/* Beside the sheet, which comes last: if it is new, so are the others. */
static enum status write_others(struct levels_job *j, struct err *err)
{
    const struct product_key key = {0};
    char path[FILE_PATH];
    if (level_file_write(&j->levels, &j->sensors, &j->light.groups, j->out, &j->prov, err) ||
        product_path_in(path, j->out, PRODUCT_QUANTITIES, &key, err) ||
        quantities_write(&j->light, j->scene.axes.metric, path, err) ||
        product_path_in(path, j->out, PRODUCT_OPENING_SCHEDULE, &key, err))
        return err->status;
    return quantities_write_openings(&j->plan, j->scene.axes.metric, path, err);
}

enum status levels_run(struct levels_job *j, struct err *err)
{
    if (read_inputs(j, err) || level_light_make(&j->light, &j->scene, &j->params, err)) return err->status;
    if (j->files.points) return print_points(j, err);
    if (sensors_make(&j->sensors, level_scene_field(&j->scene), &j->plan, &j->places, &j->params, err) ||
        level_points_make(&j->levels, &j->light, j->sensors.points, j->sensors.count, &j->params, err) ||
        write_others(j, err))
        return err->status;
    return level_sheet_make(j, err);
}
