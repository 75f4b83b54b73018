/* levels.c - see levels.h.
 *
 * Overview. Surfaces are cut into patches (patches.c), light is divided into groups (groups.c), rays say what each patch
 * gets directly and from other patches (rows.c), the photographs say what it reflects (colours.c), and one solve passes
 * all groups on between patches (radiosity.c). Then rays from the points of rooms and places (sensors.c) give what each
 * group brings there. All that follows is sums (level_sums.c): states of lamps and sky, daylight factors. */
#include "stages/light_levels/levels.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/light/surface_points.h"
#include "common/product/product.h"

void levels_release(struct levels_job *j)
{
    sheet_release(&j->sheet);
    sheet_release(&j->before);
    level_points_release(&j->levels);
    sensors_release(&j->sensors);
    level_light_release(&j->light);
    state_list_release(&j->states);
    place_list_release(&j->places);
    model_plan_release(&j->plan);
    level_scene_release(&j->scene);
    provenance_release(&j->prov);
}

/* --------------------------------------------------------------------------------------------------------------- sheet */

/* Which of the two sums counts, and its unit; NULL: the state cannot be summed. */
static const char *unit_of(double factors[2], const struct levels_job *j, const struct state_weights *w)
{
    factors[0] = j->scale > 0 ? j->scale : 1;
    factors[1] = 1;
    if (j->scale > 0 || !w->has_relative) return "lx";
    return w->has_absolute ? NULL : "relative";
}

static enum status add_faces(struct levels_job *j, const struct light_state *state, const struct state_weights *w,
                             const double factors[2], const char *unit, struct err *err)
{
    const struct light_patches *p = &j->light.patches;
    double(*sums)[2] = malloc(((size_t)p->count + 1) * sizeof *sums);
    double *values = malloc(2 * ((size_t)p->count + 1) * sizeof *values), *areas = values ? values + p->count : NULL;
    if (!sums || !values) err_nomem(err, "patches", (size_t)p->count * sizeof *sums);
    if (!err->status) level_patches_sum(sums, &j->light, w, err);
    for (int i = 0, next; !err->status && i < p->face_patches; i = next) {
        for (next = i; next < p->face_patches && p->list[next].face == p->list[i].face; next++) {
            values[next - i] = factors[0] * sums[next][0] + factors[1] * sums[next][1];
            areas[next - i] = p->list[next].area;
        }
        sheet_add(&j->sheet, state->name, "face", solid_face_name(&p->field->model.mesh, p->list[i].face), unit, values,
                  areas, next - i, err);
    }
    free(sums);
    free(values);
    return err->status;
}

static enum status add_areas(struct levels_job *j, const char *state, const char *unit, double *values, struct err *err)
{
    for (int i = 0; !err->status && i < j->sensors.area_count; i++) {
        const struct sensor_area *a = &j->sensors.areas[i];
        sheet_add(&j->sheet, state, sensor_kind_word(a->kind), a->name, unit, values + a->first, NULL, a->count, err);
    }
    return err->status;
}

static enum status add_state(struct levels_job *j, int number, struct err *err)
{
    const struct light_state *state = &j->states.items[number];
    struct state_weights w = {0};
    double factors[2], *values = malloc(((size_t)j->sensors.count + 1) * sizeof *values);
    const char *unit = NULL;
    if (!values) err_nomem(err, "points", (size_t)j->sensors.count * sizeof *values);
    if (!err->status && !state_weights_make(&w, state, &j->states, &j->light.groups, &j->params, err))
        unit = unit_of(factors, j, &w);
    if (!err->status && !unit)
        log_warn("the state %s has lamps and a sky that was not photographed: their sum needs the scale of the "
                 "photographs' light; give it by lux.txt or lamps off.",
                 state->name);
    for (int i = 0; unit && i < j->sensors.count; i++) {
        double sums[2];
        level_points_sum(sums, &j->levels, i, &w, j->levels.points ? level_scene_field(&j->scene) : NULL);
        values[i] = factors[0] * sums[0] + factors[1] * sums[1];
    }
    if (unit && !add_areas(j, state->name, unit, values, err)) add_faces(j, state, &w, factors, unit, err);
    if (unit && !err->status && number == STATE_OVERCAST) {
        for (int i = 0; i < j->sensors.count; i++) values[i] *= 100 / STATE_OVERCAST_LUX;
        add_areas(j, "daylight-factor", "%", values, err);
    }
    state_weights_release(&w);
    free(values);
    return err->status;
}

static enum status make_sheet(struct levels_job *j, struct err *err)
{
    char path[FILE_PATH];
    if (j->files.before && sheet_read(&j->before, j->files.before, &j->prov, err)) return err->status;
    for (int i = 0; !err->status && i < j->states.count; i++) add_state(j, i, err);
    if (err->status || product_path_in(path, j->out, PRODUCT_LIGHT_SHEET, &(struct product_key){0}, err))
        return err->status;
    return sheet_write(&j->sheet, j->files.before ? &j->before : NULL, path, &j->prov, err);
}

/* -------------------------------------------------------------------------------------------------------- given points */

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

/* ----------------------------------------------------------------------------------------------------------------- all */

static enum status read_inputs(struct levels_job *j, struct err *err)
{
    const struct levels_files *f = &j->files;
    if (f->places && place_list_read(&j->places, f->places, &j->prov, err)) return err->status;
    if (state_list_read(&j->states, f->states, &j->prov, err) || model_plan_read(&j->plan, f->plan, &j->prov, err) ||
        level_scene_read(&j->scene, &f->light, &j->prov, err))
        return err->status;
    if (!j->scene.axes.metric)
        log_warn("the scene has no scale: distances of points and the height of the work plane are in its own unit. "
                 "Give the scale as docs/model-script.md explains.");
    return ST_OK;
}

enum status levels_run(struct levels_job *j, struct err *err)
{
    if (read_inputs(j, err) || level_light_make(&j->light, &j->scene, &j->params, err)) return err->status;
    if (j->files.points) return print_points(j, err);
    if (sensors_make(&j->sensors, level_scene_field(&j->scene), &j->plan, &j->places, &j->params, err) ||
        level_points_make(&j->levels, &j->light, j->sensors.points, j->sensors.count, &j->params, err))
        return err->status;
    return make_sheet(j, err);
}
