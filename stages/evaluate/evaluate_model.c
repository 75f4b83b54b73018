/* evaluate_model.c - the room's axes and heights, and the model's walls and openings, against the truth: axes.*,
 * model.* */
#include <math.h>
#include <stdio.h>

#include "common/model/model_axes.h"
#include "stages/evaluate/axes_error.h"
#include "stages/evaluate/evaluation_parts.h"
#include "stages/evaluate/true_room.h"
#include "stages/evaluate/wall_plan.h"

/* The found and the true room, in the truth's world with its origin at the mean of the true cameras: a small tilt would
 * change heights much at a distant origin. */
static void rooms_to_compare(struct room_axes *found, struct room_axes *truth, const struct evaluation *e,
                             const struct model_axes *a, const struct true_room *room)
{
    const struct similarity *s = &e->truth_from_scene;
    struct vec3 middle = {0};
    int cameras = 0;
    for (int p = 0; p < e->photos.count; p++) {
        if (!e->truth.photos[p].lens.width) continue;
        middle = vec3_add(middle, pose_center(&e->truth.photos[p].pose));
        cameras++;
    }
    middle = vec3_scale(middle, 1.0 / cameras);
    /* both floors below the middle, each along its own up axis */
    const struct vec3 scene =
        vec3_scale(mat3_apply(mat3_transpose(s->rotation), vec3_sub(middle, s->translation)), 1 / s->scale);
    const double unit = s->scale / a->scale; /* metres of one model unit, from the cameras */
    found->axes = mat3_multiply(mat3_from_quat(a->rotation), mat3_transpose(s->rotation));
    found->floor = -model_from_world_point(a, scene).z * unit;
    found->ceiling = found->floor + a->ceiling * unit;
    truth->axes = room->room_from_world;
    const double above = mat3_apply(room->room_from_world, vec3_sub(middle, room->origin)).z;
    truth->floor = room->floor - above;
    truth->ceiling = room->ceiling - above;
}

enum status evaluate_axes(struct evaluation *e, struct err *err)
{
    struct metric_table *t = &e->table;
    struct model_axes axes;
    struct true_room room = {0};
    struct room_axes found, true_axes;
    char path[FILE_PATH];
    if (file_path(path, e->folder, "model/axes.txt", "", err)) return err->status;
    if (!path_is_file(path)) return metric_note(t, err, "skipped axes and heights: there is no model/axes.txt");
    if (!e->truth_folder) return metric_note(t, err, "skipped axes and heights: no TRUTH is given");
    if (!e->aligned) return metric_note(t, err, "skipped axes and heights: the cameras do not tell where the truth is");
    if (true_room_read(&room, e->truth_folder, e->prov, err)) return err->status;
    if (!room.known)
        return metric_note(t, err, "skipped axes and heights: the truth holds neither scene.txt nor scene-truth.txt");
    if (evaluation_input(e, path, "model", "axes.txt", "", err) || model_axes_read(&axes, path, err))
        return err->status;
    rooms_to_compare(&found, &true_axes, e, &axes, &room);
    const struct axes_errors errors = axes_errors(&found, &true_axes);
    if (metric_add(t, NULL, "axes.angle", errors.all, "degrees", "lower", err) ||
        metric_add(t, NULL, "axes.up", errors.up, "degrees", "lower", err) ||
        metric_add(t, NULL, "axes.floor", errors.floor, "m", "lower", err))
        return err->status;
    if (axes.ceiling > 0 && metric_add(t, NULL, "axes.ceiling", errors.ceiling, "m", "lower", err)) return err->status;
    if (axes.metric &&
        metric_add(t, NULL, "axes.scale", 100 * fabs(axes.scale / e->truth_from_scene.scale - 1), "%", "lower", err))
        return err->status;
    return axes.ceiling > 0 ? ST_OK : metric_note(t, err, "skipped the ceiling: none was found");
}

/* A point of the model in the frame of the true rooms. */
static struct vec3 room_from_model(const struct evaluation *e, const struct model_axes *axes,
                                   const struct true_room *room, struct vec3 p)
{
    const struct similarity *s = &e->truth_from_scene;
    const struct vec3 scene = world_from_model_point(axes, p);
    const struct vec3 world = vec3_add(vec3_scale(mat3_apply(s->rotation, scene), s->scale), s->translation);
    return mat3_apply(room->room_from_world, vec3_sub(world, room->origin));
}

static enum status add_parts(struct metric_table *t, const char *name, const struct part_errors *p, struct err *err)
{
    char middle[64];
    snprintf(middle, sizeof middle, "%s_median", name);
    if (!p->count) return ST_OK;
    if (metric_add(t, NULL, name, p->errors[p->count - 1], "m", "lower", err) ||
        metric_add(t, NULL, middle, median(p->errors, p->count), "m", "lower", err))
        return err->status;
    return metric_note(t, err, "note: %s is that of %s", name, p->worst);
}

static enum status add_walls(struct metric_table *t, const struct wall_errors *w, struct err *err)
{
    if (add_parts(t, "model.walls", &w->faces, err) || add_parts(t, "model.openings", &w->openings, err) ||
        metric_add(t, NULL, "model.strange", w->extra, "1", "lower", err))
        return err->status;
    return metric_add(t, NULL, "model.missing", w->missing, "1", "lower", err);
}

static void parts_to_room(struct measured_parts *list, const struct evaluation *e, const struct model_axes *axes,
                          const struct true_room *room)
{
    for (int i = 0; i < list->count; i++)
        for (int k = 0; k < 2; k++) list->parts[i].at[k] = room_from_model(e, axes, room, list->parts[i].at[k]);
}

enum status evaluate_walls(struct evaluation *e, struct err *err)
{
    const double max_distance = 0.5; /* m: a wall farther away is another one */
    struct metric_table *t = &e->table;
    struct model_axes axes;
    struct true_room room = {0};
    struct measured_plan model = {0}, truth = {0};
    struct wall_errors errors = {0};
    char path[FILE_PATH];
    if (file_path(path, e->folder, "model/plan.txt", "", err)) return err->status;
    if (!path_is_file(path)) return metric_note(t, err, "skipped walls: there is no model/plan.txt");
    if (!e->truth_folder) return metric_note(t, err, "skipped walls: no TRUTH is given");
    if (!e->aligned) return metric_note(t, err, "skipped walls: the cameras do not tell where the truth is");
    struct provenance unused = {0}; /* evaluate_axes() has added these files to e->prov */
    enum status st = true_room_read(&room, e->truth_folder, &unused, err);
    provenance_release(&unused);
    if (!st && !room.known)
        return metric_note(t, err, "skipped walls: the truth holds neither scene.txt nor scene-truth.txt");
    if (!st) st = evaluation_input(e, path, "model", "plan.txt", "", err);
    if (!st) st = measured_plan_read(&model, path, PLAN_FROM_MODEL, err);
    if (!st) st = file_path(path, e->folder, "model/axes.txt", "", err);
    if (!st) st = model_axes_read(&axes, path, err);
    if (!st) st = file_path(path, e->truth_folder, room.framed ? "scene-truth.txt" : "scene.txt", "", err);
    if (!st) st = measured_plan_read(&truth, path, room.framed ? PLAN_FROM_SCENE_TRUTH : PLAN_FROM_SCENE, err);
    if (!st) {
        parts_to_room(&model.faces, e, &axes, &room);
        parts_to_room(&model.openings, e, &axes, &room);
        st = wall_errors_find(&errors, &model, &truth, max_distance, err);
    }
    if (!st) st = add_walls(t, &errors, err);
    wall_errors_release(&errors);
    measured_plan_release(&truth);
    measured_plan_release(&model);
    return st;
}
