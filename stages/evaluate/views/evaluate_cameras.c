/* evaluate_cameras.c - found against true cameras: camera.* and the alignment that the other comparisons use. */
#include "stages/evaluate/views/views_metrics.h"

#include <stdlib.h>

/* The pose of the photo from that of one of its views. */
static struct pose photo_pose(const struct view_set *set, int view)
{
    struct mat3 photo_from_view =
        mat3_transpose(mat3_from_quat(photo_lens_of_view(&set->cameras, &set->lenses, view)->view_from_photo));
    const struct view *v = &set->cameras.views[view];
    return (struct pose){quat_from_mat3(mat3_multiply(photo_from_view, v->cam_from_world)),
                         mat3_apply(photo_from_view, v->translation)};
}

/* Poses of the photos that have both a view and a true camera, in order of photo; returns their number. */
static int common_poses(const struct evaluation *e, struct pose *found, struct pose *truth)
{
    int count = 0;
    for (int p = 0; p < e->photos.count; p++) {
        const struct view_set *sets[2] = {&e->views, &e->held};
        bool done = !e->truth.photos[p].lens.width;
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < sets[k]->cameras.view_count && !done; i++) {
                if (evaluation_photo(e, sets[k], i) != p) continue;
                found[count] = photo_pose(sets[k], i);
                truth[count++] = e->truth.photos[p].pose;
                done = true;
            }
    }
    return count;
}

enum status evaluate_cameras(struct evaluation *e, struct err *err)
{
    struct metric_table *t = &e->table;
    const size_t capacity = (size_t)e->photos.count + 1;
    struct pose *found = malloc(capacity * sizeof *found), *truth = malloc(capacity * sizeof *truth);
    struct err why = ERR_INIT;
    struct camera_errors errors;
    if (!found || !truth) err_nomem(err, "poses", capacity * sizeof *found);
    int known = e->truth.images - e->truth.unknown_images, count = err->status ? 0 : common_poses(e, found, truth);
    if (!err->status && e->truth.unknown_images)
        metric_note(t, err, "note: %d of %d images of the truth are none of the photos", e->truth.unknown_images,
                    e->truth.images);
    if (!err->status && known) metric_add(t, NULL, "camera.placed", 100.0 * count / known, err);
    if (!err->status && camera_alignment_find(&e->truth_from_scene, found, truth, count, &why)) {
        metric_note(t, err, "skipped camera errors and depth errors: %s", why.text);
    } else if (!err->status) {
        e->aligned = true;
        if (!camera_errors_measure(&errors, &e->truth_from_scene, found, truth, count, err) &&
            !metric_add(t, NULL, "camera.center_median", errors.center_median, err) &&
            !metric_add(t, NULL, "camera.center_max", errors.center_max, err) &&
            !metric_add(t, NULL, "camera.rotation_median", errors.rotation_median, err))
            metric_add(t, NULL, "camera.rotation_max", errors.rotation_max, err);
        if (!err->status) metric_add(t, NULL, "camera.scale", e->truth_from_scene.scale, err);
    }
    free(found);
    free(truth);
    return err->status;
}
