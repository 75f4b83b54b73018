/* photo_alignment.c - finds the frame of another model by the scene's photographs in it.
 *
 * SfM gives every model a frame and a unit of its own. If a model has photographs of the scene, the similarity that
 * maps their places in the scene to those in the model,
 *   p_model = s R p_scene + t,
 * is the least-squares one of their centres (camera_alignment.c). With x_cam = Q p_model + u, a camera of the model is
 *   x_cam / s = Q R p_scene + (Q t + u) / s
 * in the scene: the same picture in the scene's unit.
 *
 * The photographs' distances after alignment show whether the models are of one place: three centres always agree
 * somewhat, a wrong photograph or a bent model does not. */
#include "common/capture/photo_alignment.h"

#include <math.h>
#include <stdlib.h>

#include "common/capture/photo_camera.h"
#include "common/capture/photo_list.h"
#include "common/capture/photo_match.h"
#include "common/product/product.h"

enum { MIN_PHOTOS = 3 };

static const double max_turn = 2; /* degrees: median between the axes of common photographs; more is another place */

struct pose photo_alignment_pose(const struct pose *p, const struct similarity *model_from_scene)
{
    const struct mat3 turn = mat3_from_quat(p->rotation);
    const struct vec3 at = vec3_add(mat3_apply(turn, model_from_scene->translation), p->translation);
    return (struct pose){quat_from_mat3(mat3_multiply(turn, model_from_scene->rotation)),
                         vec3_scale(at, 1 / model_from_scene->scale)};
}

struct common_photos {
    struct pose *scene, *model; /* owned */
    int count;
};

/* Finds the images of the model that are photographs with a pose in the scene. */
static enum status find_common(struct common_photos *c, const struct sfm_model *model, const struct scene_photos *scene,
                               struct err *err)
{
    struct camera_set set = {0};
    struct lens_list lenses = {0};
    struct photo_list photos = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, scene->views, PRODUCT_LENSES, NULL, err) &&
        !camera_set_read(&set, scene->views, scene->prov, err) && !lens_list_read(&lenses, path, scene->prov, err))
        photo_list_read(&photos, scene->records, err);
    bool *taken = calloc((size_t)photos.count + 1, sizeof *taken);
    c->scene = calloc((size_t)model->image_count + 1, sizeof *c->scene);
    c->model = calloc((size_t)model->image_count + 1, sizeof *c->model);
    if (!err->status && (!taken || !c->scene || !c->model))
        err_nomem(err, "poses", (size_t)model->image_count * sizeof *c->scene);
    for (int i = 0; !err->status && i < model->image_count; i++) {
        const int photo = photo_list_match(&photos, model->images[i].name);
        struct photo_camera camera;
        struct err absent = ERR_INIT; /* a photo without a pose is no error */
        if (photo < 0 || taken[photo] ||
            photo_camera_find(&camera, photos.photos[photo].id, &set, &lenses, path, 0, &absent))
            continue;
        taken[photo] = true;
        c->scene[c->count] = (struct pose){quat_from_mat3(camera.cam_from_world), camera.translation};
        c->model[c->count++] = model->images[i].cam_from_world;
    }
    free(taken);
    photo_list_release(&photos);
    lens_list_release(&lenses);
    camera_set_release(&set);
    return err->status;
}

/* The largest distance of a centre from their mean. */
static double extent_of(const struct pose *poses, int count)
{
    struct vec3 mean = {0, 0, 0};
    double extent = 0;
    for (int i = 0; i < count; i++) mean = vec3_add(mean, vec3_scale(pose_center(&poses[i]), 1.0 / count));
    for (int i = 0; i < count; i++) extent = fmax(extent, vec3_length(vec3_sub(pose_center(&poses[i]), mean)));
    return extent;
}

static enum status check_agreement(const struct frame_agreement *a, const char *folder,
                                   const struct scene_photos *scene, const struct alignment_rules *rules,
                                   struct err *err)
{
    const struct camera_errors *e = &a->errors;
    if (100 * e->center_median <= rules->max_misfit && e->rotation_median <= max_turn) return ST_OK;
    return err_set(
        err, ST_DATA,
        "the %d photographs that %s and %s have in common disagree: after alignment their places differ by "
        "%.3g %% (median) of the photographs' extent, wanted at most %.3g %%, and their axes by %.3g degrees, "
        "wanted at most %.3g. %s",
        a->photos, folder, scene->views, 100 * e->center_median, rules->max_misfit, e->rotation_median, max_turn,
        rules->if_apart);
}

enum status photo_alignment_find(struct similarity *model_from_scene, struct frame_agreement *a,
                                 const struct sfm_model *model, const char *folder, const struct scene_photos *scene,
                                 const struct alignment_rules *rules, struct err *err)
{
    struct common_photos c = {0};
    struct err apart = ERR_INIT; /* in words about found and true cameras */
    find_common(&c, model, scene, err);
    if (!err->status && c.count < MIN_PHOTOS)
        err_set(err, ST_DATA, "%s has %d of the scene's photographs with a pose in %s, wanted at least %d. %s", folder,
                c.count, scene->views, (int)MIN_PHOTOS, rules->if_few);
    if (!err->status && camera_alignment_find(model_from_scene, c.scene, c.model, c.count, &apart))
        err_set(err, ST_DATA,
                "the %d photographs that %s and %s have in common are all in one place in one of them, or no scale "
                "fits; give a model of photographs from several places.",
                c.count, folder, scene->views);
    if (!err->status && !camera_errors_measure(&a->errors, model_from_scene, c.scene, c.model, c.count, err)) {
        a->photos = c.count;
        a->extent = extent_of(c.scene, c.count);
        const double unit = 1 / (model_from_scene->scale * a->extent);
        a->errors.center_median *= unit;
        a->errors.center_max *= unit;
        check_agreement(a, folder, scene, rules, err);
    }
    free(c.scene);
    free(c.model);
    return err->status;
}
