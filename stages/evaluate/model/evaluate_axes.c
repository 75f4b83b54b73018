/* evaluate_axes.c - the room's axes and heights against the truth: axes.* */
#include "stages/evaluate/model/model_metrics.h"

#include <math.h>

#include "common/model/model_axes.h"
#include "stages/evaluate/model/axes_error.h"
#include "stages/evaluate/truth/true_room.h"

/* The found and the true room, in the truth's world with its origin at the mean of the true cameras: a small tilt would
 * change heights much at a distant origin. */
static void rooms_to_compare(struct room_axes *found, struct room_axes *truth, const struct evaluation *e,
                             const struct model_axes *a, const struct true_room *room, const struct true_heights *h)
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
    truth->floor = h->floor - above;
    truth->ceiling = h->ceiling - above;
}

/* The errors; of rooms with different heights, the nearest floor and the nearest ceiling count. */
static struct axes_errors nearest_errors(const struct evaluation *e, const struct model_axes *axes,
                                         const struct true_room *room)
{
    struct axes_errors nearest = {0};
    for (int i = 0; i < room->count; i++) {
        struct room_axes found, truth;
        rooms_to_compare(&found, &truth, e, axes, room, &room->heights[i]);
        const struct axes_errors errors = axes_errors(&found, &truth);
        if (!i) nearest = errors;
        nearest.floor = fmin(nearest.floor, errors.floor);
        nearest.ceiling = fmin(nearest.ceiling, errors.ceiling);
    }
    return nearest;
}

static enum status add_axes(struct evaluation *e, const struct model_axes *axes, const struct true_room *room,
                            struct err *err)
{
    struct metric_table *t = &e->table;
    const struct axes_errors errors = nearest_errors(e, axes, room);
    if (metric_add(t, NULL, "axes.angle", errors.all, err) || metric_add(t, NULL, "axes.up", errors.up, err) ||
        metric_add(t, NULL, "axes.floor", errors.floor, err))
        return err->status;
    if (axes->ceiling > 0 && metric_add(t, NULL, "axes.ceiling", errors.ceiling, err)) return err->status;
    if (axes->metric && metric_add(t, NULL, "axes.scale", 100 * fabs(axes->scale / e->truth_from_scene.scale - 1), err))
        return err->status;
    if (room->count > 1 &&
        metric_note(t, err,
                    "note: the true rooms have different heights; axes.floor and axes.ceiling are the errors "
                    "from the nearest ones"))
        return err->status;
    return axes->ceiling > 0 ? ST_OK : metric_note(t, err, "skipped the ceiling: none was found");
}

enum status evaluate_axes(struct evaluation *e, struct err *err)
{
    struct metric_table *t = &e->table;
    struct model_axes axes;
    struct true_room room = {0};
    char path[FILE_PATH];
    if (evaluation_path(path, e, PRODUCT_AXES, NULL, err)) return err->status;
    if (!path_is_file(path)) return metric_note(t, err, "skipped axes and heights: model/axes.txt is missing");
    if (!e->truth_folder) return metric_note(t, err, "skipped axes and heights: no TRUTH is given");
    if (!e->aligned) return metric_note(t, err, "skipped axes and heights: the cameras do not tell where the truth is");
    if (true_room_read(&room, e->truth_folder, e->prov, err)) return err->status;
    if (!room.known)
        return metric_note(t, err, "skipped axes and heights: the truth holds neither scene.txt nor scene-truth.txt");
    if (!model_axes_read(&axes, path, e->prov, err)) add_axes(e, &axes, &room, err);
    true_room_release(&room);
    return err->status;
}
