/* levels.c - see levels.h.
 *
 * Overview. Surfaces are cut into patches (patches.c), light is divided into groups (groups.c), rays say what each
 * patch gets directly and from other patches (rows.c), the photographs say what it reflects (colours.c), and one
 * solve passes all groups on between patches (radiosity.c). Then rays from the points of rooms and places
 * (sensors.c) give what each group brings there. All that follows is sums (level_sums.c, level_sheet.c): states of
 * lamps and sky, daylight factors, hours of a year. */
#include "stages/light_levels/levels.h"

#include <stdlib.h>

#include "common/base/log.h"
#include "common/product/product.h"
#include "stages/light_levels/level_file.h"
#include "stages/light_levels/level_film.h"
#include "stages/light_levels/level_script.h"
#include "stages/light_levels/level_sheet.h"
#include "stages/light_levels/level_table.h"
#include "stages/light_levels/place_marks.h"
#include "stages/light_levels/quantities.h"
#include "stages/light_levels/relit_file.h"

enum { PER_HOUR = 2 }; /* of days on the page */

void levels_release(struct levels_job *j)
{
    sheet_release(&j->sheet);
    sheet_release(&j->before);
    level_points_release(&j->levels);
    level_factors_release(&j->factors);
    other_light_release(&j->other);
    level_views_release(&j->views);
    cli_list_release(&j->files.shown.names);
    lux_scale_release(&j->scale);
    weather_release(&j->weather);
    sensors_release(&j->sensors);
    light_errors_release(&j->errors);
    level_light_release(&j->light);
    state_list_release(&j->states);
    place_list_release(&j->places);
    model_plan_release(&j->plan);
    level_scene_release(&j->scene);
    provenance_release(&j->prov);
}

/* -------------------------------------------------------------------------------------------------------------- all */

static enum status add_lamps_of_edit(struct levels_job *j, struct err *err)
{
    const struct texture_map *map = &j->scene.change.map;
    for (int i = 0; !err->status && i < map->planned_count; i++)
        planned_lamps_add(&j->states.planned, &map->planned[i], j->files.light.scene, &j->prov, err);
    if (!err->status && map->planned_count) state_list_add_edit_lamps(&j->states, err);
    return err->status;
}

static enum status read_inputs(struct levels_job *j, struct err *err)
{
    const struct levels_files *f = &j->files;
    if (f->day && level_date_read(&j->day, f->day, err)) return err->status;
    if (f->places && place_list_read(&j->places, f->places, &j->prov, err)) return err->status;
    if (f->before && sheet_read(&j->before, f->before, &j->prov, err)) return err->status;
    if (f->scale && lux_scale_read(&j->scale, f->scale, &j->prov, err)) return err->status;
    if (f->weather && weather_read(&j->weather, f->weather, &j->prov, err)) return err->status;
    if (state_list_read(&j->states, f->states, &j->prov, err) ||
        state_list_take_weather(&j->states, f->weather ? &j->weather : NULL, err) ||
        model_plan_read(&j->plan, f->plan, &j->prov, err) || level_scene_read(&j->scene, &f->light, &j->prov, err) ||
        add_lamps_of_edit(j, err) || level_lamps_check(&j->states, &level_scene_field(&j->scene)->lights, err) ||
        level_blinds_check(&j->states, &j->scene, err) ||
        model_metre_find(&j->scene.metre, &j->scene.axes, &j->plan, j->params.room_height, err))
        return err->status;
    j->scene.planned = &j->states.planned;
    if (!j->plan.room_count)
        log_warn(
            "the model has no room, so that the sky shines in where floors and ceilings should be, and there are "
            "no work planes. Add lines `room NAME WALL WALL WALL ...` to model.txt, as docs/model-script.md explains.");
    if (j->scene.metre.guessed)
        log_warn("the scene has no scale, so that a metre is a guess: %.3g units (%.3g to %.3g), by rooms %g m high "
                 "(%g to %g). It sets the work plane and the distances of points%s. Give the scale as "
                 "docs/model-script.md explains.",
                 j->scene.metre.units, j->scene.metre.low, j->scene.metre.high, j->params.room_height,
                 model_metre_heights[0], model_metre_heights[1],
                 j->states.planned.count ? ", and how bright planned lamps are" : "");
    return ST_OK;
}

static enum status write_relit(const struct levels_job *j, const struct relit_light *relit,
                               const struct script_points *chosen, const struct level_days *days, struct err *err)
{
    const struct level_script s = {.chosen = chosen,
                                   .relit = relit,
                                   .days = days,
                                   .sensors = &j->sensors,
                                   .plan = &j->plan,
                                   .states = &j->states,
                                   .params = &j->params,
                                   .scale = &j->scale,
                                   .errors = &j->errors,
                                   .metre = &j->scene.metre,
                                   .metric = j->scene.axes.metric};
    const struct product_key key = {0};
    char path[FILE_PATH];
    if (product_path_in(path, j->out, PRODUCT_LIGHT_RELIT, &key, err) || relit_file_write(relit, path, err) ||
        product_path_in(path, j->out, PRODUCT_LIGHT_SCRIPT, &key, err))
        return err->status;
    return level_script_write(&s, path, err);
}

/* What the page adds up. */
static enum status write_scripts(const struct levels_job *j, struct err *err)
{
    struct script_points chosen = {NULL, 0, 0};
    struct level_days days = {.day_count = 0};
    struct relit_light relit = {.places = 0};
    if (!level_script_choose(&chosen, &j->sensors, err) &&
        !level_days_make(&days, &j->states, j->files.day ? &j->day : NULL, PER_HOUR, err)) {
        const struct relit_sources from = {.light = &j->light,
                                           .views = &j->views,
                                           .states = &j->states,
                                           .params = &j->params,
                                           .days = &days,
                                           .points = &j->levels,
                                           .chosen = chosen.chosen,
                                           .chosen_count = chosen.count,
                                           .scale = j->scale.is.scale};
        if (!relit_light_make(&relit, &from, err)) write_relit(j, &relit, &chosen, &days, err);
    }
    relit_light_release(&relit);
    level_days_release(&days);
    free(chosen.chosen);
    return err->status;
}

/* The film of the day that was asked for: OUT/DATE.mp4. */
static enum status write_film(const struct levels_job *j, struct err *err)
{
    const struct level_film f = {.points = &j->levels,
                                 .sensors = &j->sensors,
                                 .plan = &j->plan,
                                 .light = &j->light,
                                 .views = &j->views,
                                 .states = &j->states,
                                 .params = &j->params,
                                 .weather = j->files.weather ? &j->weather : NULL,
                                 .day = &j->day};
    char path[FILE_PATH];
    if (!j->files.day ||
        product_path_in(path, j->out, PRODUCT_LIGHT_FILM, &(struct product_key){.name = j->files.day}, err))
        return err->status;
    return level_film_write(&f, path, err);
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
    if (quantities_write_openings(&j->plan, j->scene.axes.metric, path, err)) return err->status;
    if (!j->scene.edited && (product_path_in(path, j->out, PRODUCT_LIGHT_FACTORS, &key, err) ||
                             level_factors_write(&j->factors, &j->light.groups, path, &j->prov, err)))
        return err->status;
    return write_scripts(j, err);
}

/* What was measured or photographed in states of switches; of an edit, what it says of the unedited room. */
static enum status find_factors(struct levels_job *j, struct err *err)
{
    const struct factor_sources from = {.light = &j->light,
                                        .points = &j->levels,
                                        .sensors = &j->sensors,
                                        .states = &j->states,
                                        .params = &j->params,
                                        .photos = &j->other,
                                        .scale = j->scale.is};
    if (j->files.factors)
        level_factors_read(&j->factors, &j->light.groups, j->files.factors, &j->prov, err);
    else if (!j->scene.edited && !other_light_make(&j->other, &j->files.other, &j->light, &j->states, &j->scene.axes,
                                                   &j->params, &j->prov, err))
        level_factors_make(&j->factors, &from, err);
    if (err->status) return err->status;
    if (j->factors.count) {
        j->light.groups.factors = j->factors.of_groups;
        if (!(j->scale.is.scale > 0)) j->scale.is = j->factors.scale;
    }
    j->light.groups.scaled = j->scale.is.scale > 0;
    if (j->scene.change.map.planned_count && !j->light.groups.scaled)
        log_warn("lx of the photographs' light are not known, so that the lamps of the edit shine in the state "
                 "edit-lamps alone, and on the page. Measure a point (lux.txt).");
    return ST_OK;
}

static enum status resolve_places(struct levels_job *j, struct err *err)
{
    const struct place_marks with = {.views = j->files.shown.views,
                                     .axes = &j->scene.axes,
                                     .plan = &j->plan,
                                     .model = &level_scene_field(&j->scene)->model,
                                     .work_plane = j->params.work_plane * j->scene.metre.units};
    return place_marks_resolve(&j->places, &with, &j->prov, err);
}

enum status levels_run(struct levels_job *j, struct err *err)
{
    const bool hours = !j->files.points || j->files.table;
    if (read_inputs(j, err) || resolve_places(j, err) ||
        level_light_make(&j->light, &j->scene, hours, &j->params, err) ||
        light_errors_read(&j->errors, j->files.fit, j->files.sky, &j->light.groups, &j->prov, err))
        return err->status;
    if (j->files.points) return j->files.table ? level_table_print_states(j, err) : level_table_print(j, err);
    if (sensors_make(&j->sensors, level_scene_field(&j->scene), &j->plan, &j->places, &j->params, &j->scene.metre,
                     err) ||
        level_points_make(&j->levels, &j->light, j->sensors.points, j->sensors.count, &j->params, err) ||
        find_factors(j, err) ||
        level_views_make(&j->views, &j->files.shown, &j->scene.axes, &j->light, &j->prov, err) || write_film(j, err) ||
        write_others(j, err))
        return err->status;
    return level_sheet_make(j, err);
}
