/* evaluate_walls.c - walls, openings and heights of the model and of its edits against the truth: model.*,
 * edited.E.* */
#include "stages/evaluate/model/model_metrics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "stages/evaluate/model/room_heights.h"
#include "stages/evaluate/scene/model_frame.h"
#include "stages/evaluate/truth/true_room.h"
#include "stages/evaluate/truth/wall_plan.h"

#define MAX_DISTANCE 0.5 /* m: a wall farther away is another one */

static enum status add_parts(struct evaluation *e, const char *prefix, const char *name, const struct part_errors *p,
                             struct err *err)
{
    char middle[64];
    snprintf(middle, sizeof middle, "%s_median", name);
    if (!p->count) return ST_OK;
    if (evaluation_metric(e, NULL, prefix, name, p->errors[p->count - 1], err) ||
        evaluation_metric(e, NULL, prefix, middle, sort_median(p->errors, (size_t)p->count), err))
        return err->status;
    return metric_note(&e->table, err, "note: %s.%s is that of %s", prefix, name, p->worst);
}

static enum status add_walls(struct evaluation *e, const char *prefix, const struct wall_errors *w,
                             const struct room_height_errors *h, struct err *err)
{
    if (add_parts(e, prefix, "walls", &w->faces, err) || add_parts(e, prefix, "openings", &w->openings, err) ||
        evaluation_metric(e, NULL, prefix, "strange", w->extra, err) ||
        evaluation_metric(e, NULL, prefix, "missing", w->missing, err))
        return err->status;
    if (h->rooms && (evaluation_metric(e, NULL, prefix, "floors", h->floor, err) ||
                     evaluation_metric(e, NULL, prefix, "ceilings", h->ceiling, err)))
        return err->status;
    if (!h->outside) return ST_OK;
    return metric_note(&e->table, err, "skipped the heights of %d rooms of %s: no true room is there", h->outside,
                       prefix);
}

static void parts_to_room(struct measured_parts *list, const struct model_frame *frame)
{
    for (int i = 0; i < list->count; i++)
        for (int k = 0; k < 2; k++) list->parts[i].at[k] = truth_from_model_point(frame, list->parts[i].at[k]);
}

/* Compares WHERE/plan.txt with the rooms of a file of the truth. frame: to the frame of that file's rooms. */
static enum status compare(struct evaluation *e, const char *prefix, const char *where, const char *truth_file,
                           enum measured_plan_kind kind, const struct model_frame *frame, struct err *err)
{
    struct measured_plan model = {0}, truth = {0};
    struct wall_errors errors = {0};
    char path[FILE_PATH];
    if (!evaluation_path(path, e, PRODUCT_PLAN, &(struct product_key){.model = where}, err) &&
        !provenance_add_file(e->prov, product_name(PRODUCT_PLAN, path), path, err) &&
        !wall_plan_read(&model, path, PLAN_FROM_MODEL, err))
        wall_plan_read(&truth, truth_file, kind, err);
    if (!err->status) {
        parts_to_room(&model.faces, frame);
        parts_to_room(&model.openings, frame);
        parts_to_room(&model.rooms, frame);
        wall_errors_find(&errors, &model, &truth, MAX_DISTANCE, err);
    }
    if (!err->status) {
        const struct room_height_errors heights = room_heights_compare(&model.rooms, &truth.rooms);
        add_walls(e, prefix, &errors, &heights, err);
    }
    wall_errors_release(&errors);
    wall_plan_release(&truth);
    wall_plan_release(&model);
    return err->status;
}

enum status evaluate_walls(struct evaluation *e, struct err *err)
{
    struct metric_table *t = &e->table;
    struct model_frame frame;
    struct true_room room = {0};
    char path[FILE_PATH];
    if (evaluation_path(path, e, PRODUCT_PLAN, NULL, err)) return err->status;
    if (!path_is_file(path)) return metric_note(t, err, "skipped walls: model/plan.txt is missing");
    if (!e->truth_folder) return metric_note(t, err, "skipped walls: no TRUTH is given");
    if (!e->aligned) return metric_note(t, err, "skipped walls: the cameras do not tell where the truth is");
    struct provenance unused = {0}; /* evaluate_axes() has added these files to e->prov */
    true_room_read(&room, e->truth_folder, &unused, err);
    provenance_release(&unused);
    if (!err->status && !room.known)
        return metric_note(t, err, "skipped walls: the truth holds neither scene.txt nor scene-truth.txt");
    if (!err->status && !model_frame_read(&frame, e, room.room_from_world, room.origin, err))
        file_path(path, e->truth_folder, room.framed ? "scene-truth.txt" : "scene.txt", "", err);
    if (!err->status)
        compare(e, "model", "model", path, room.framed ? PLAN_FROM_SCENE_TRUTH : PLAN_FROM_SCENE, &frame, err);
    true_room_release(&room);
    return err->status;
}

/* Of one edit: remodel/E/plan.txt against TRUTH/edited-E/scene.txt, whose frame is the world. */
static enum status evaluate_edit(struct evaluation *e, const char *edit, struct err *err)
{
    static const struct mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    struct model_frame frame;
    char where[64], prefix[64], name[64], path[FILE_PATH], plan[FILE_PATH];
    snprintf(where, sizeof where, "remodel/%s", edit);
    snprintf(prefix, sizeof prefix, "edited.%s", edit);
    snprintf(name, sizeof name, "edited-%s/scene.txt", edit);
    if (file_path(path, e->truth_folder, name, "", err) ||
        evaluation_path(plan, e, PRODUCT_PLAN, &(struct product_key){.model = where}, err))
        return err->status;
    if (!path_is_file(plan))
        return metric_note(&e->table, err, "skipped walls of %s: %s/plan.txt is missing", prefix, where);
    if (!e->aligned)
        return metric_note(&e->table, err, "skipped walls of %s: the cameras do not tell where the truth is", prefix);
    if (!path_is_file(path))
        return metric_note(&e->table, err, "skipped walls of %s: the truth holds no %s", prefix, name);
    if (provenance_add_in(e->prov, "truth", e->truth_folder, name, "", NULL, err) ||
        model_frame_read(&frame, e, same, vec3_make(0, 0, 0), err))
        return err->status;
    return compare(e, prefix, where, path, PLAN_FROM_SCENE, &frame, err);
}

enum status evaluate_edited_walls(struct evaluation *e, struct err *err)
{
    struct true_edits edits = {0};
    true_edits_find(&edits, e->truth_folder, err);
    for (int i = 0; !err->status && i < edits.count; i++) evaluate_edit(e, edits.names[i], err);
    true_edits_release(&edits);
    return err->status;
}
