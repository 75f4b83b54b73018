/* given_path.c - a film's cameras from a file of another program.
 *
 * Only pinhole lenses make a film: a renderer without distortion makes the frames. Other programs may have moved or
 * scaled the world (nerfstudio does so to its training cameras); such a path looks past the scene, so a path that shows
 * none of the scene's points is an error. */
#include "stages/plan_path/given_path.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/capture/transforms_file.h"

static void set_pose(struct view *v, struct quat rotation, struct vec3 center)
{
    v->cam_from_world = mat3_from_quat(rotation);
    v->center = center;
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, center), -1);
}

/* Checks the size against the first frame's, and makes it even. */
static enum status check_size(struct view *v, const struct view *first, const char *where, struct err *err)
{
    v->width -= v->width % 2;
    v->height -= v->height % 2;
    if (v->width < 2 || v->height < 2)
        return err_set(err, ST_DATA, "%s: found a picture of less than 2 x 2 pixels, wanted a larger one.", where);
    if (v->width == first->width && v->height == first->height) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s: found a size of %d x %d, wanted %d x %d, the size of the first frame: a film has one size.",
                   where, v->width, v->height, first->width, first->height);
}

/* ------------------------------------------------------------------------------------------------- transforms.json */

static enum status check_pinhole(const struct given_lens *lens, const struct transforms_frame *f, struct err *err)
{
    const double bent =
        fabs(lens->k[0]) + fabs(lens->k[1]) + fabs(lens->k[2]) + fabs(lens->k[3]) + fabs(lens->p[0]) + fabs(lens->p[1]);
    if (!lens->fisheye && !(bent > 0)) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s: found a lens with distortion, wanted a pinhole: a film has straight lines. Set k1 to k4, p1 "
                   "and p2 to 0.",
                   f->where);
}

static enum status read_frame(struct path_frame *to, const struct view *first, const struct transforms_frame *f,
                              struct err *err)
{
    struct view *v = &to->camera;
    struct given_lens lens;
    struct vec3 axes[3], center;
    struct mat3 turn;
    bool known = false;
    if (transforms_file_is_panorama(f))
        return err_set(err, ST_DATA, "%s: found a panorama, wanted a pinhole camera.", f->where);
    if (transforms_file_lens(&lens, &known, f, 0, 0, err)) return err->status;
    if (!known)
        return err_set(err, ST_DATA, "%s has no size; wanted w and h, in pixels, of the frame or of all frames.",
                       f->where);
    if (check_pinhole(&lens, f, err) || transforms_file_pose(axes, &center, f, err) ||
        pose_turn_from_axes(&turn, axes, f->where, err))
        return err->status;
    v->width = lens.width;
    v->height = lens.height;
    v->fx = lens.fx;
    v->fy = lens.fy;
    v->cx = lens.cx;
    v->cy = lens.cy;
    set_pose(v, quat_from_mat3(turn), center);
    if (transforms_file_number(f, "aperture", &to->aperture, err) ||
        transforms_file_number(f, "focus", &to->focus, err))
        return err->status;
    if (to->aperture < 0 || to->focus < 0 || (to->aperture > 0 && !(to->focus > 0)))
        return err_set(err, ST_DATA,
                       "%s: found aperture %g and focus %g, wanted 0 or more, and a focus with an aperture.", f->where,
                       to->aperture, to->focus);
    return check_size(v, first, f->where, err);
}

static enum status read_transforms(struct camera_path *path, const char *file, const char *name, double fps,
                                   struct provenance *prov, struct err *err)
{
    struct transforms_file t = {0};
    const size_t mark = strlen(file) - strlen(path_file_name(file));
    if (!transforms_file_open(&t, file, err) && prov) provenance_add_file(prov, file + mark, file, err);
    const size_t frames = err->status ? 0 : json_array_size(t.frames);
    if (frames > INT32_MAX) err_set(err, ST_DATA, "%s has %zu frames, wanted fewer.", file, frames);
    if (!err->status) camera_path_init(path, name, fps, (int)frames, err);
    for (size_t i = 0; !err->status && i < frames; i++) {
        struct transforms_frame f;
        const char *picture;
        transforms_file_frame(&f, &picture, &t, i);
        /* the first frame's size is that of the film */
        read_frame(&path->frames[i], &path->frames[0].camera, &f, err);
    }
    transforms_file_close(&t);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------- COLMAP's text */

static int by_number(const void *a, const void *b)
{
    return strverscmp((*(const struct sfm_image *const *)a)->name, (*(const struct sfm_image *const *)b)->name);
}

static enum status read_image(struct path_frame *to, const struct view *first, const struct sfm_model *m,
                              const struct sfm_image *im, const char *file, struct err *err)
{
    const struct camera *c = &m->cameras[im->camera_idx].camera;
    struct view *v = &to->camera;
    char where[FILE_PATH + 300];
    snprintf(where, sizeof where, "%s/images.txt: image %.200s", file, im->name);
    if (c->model != CAMERA_PINHOLE && c->model != CAMERA_SIMPLE_PINHOLE)
        return err_set(err, ST_DATA, "%s: found a camera of the model %s, wanted PINHOLE or SIMPLE_PINHOLE.", where,
                       camera_model_name(c->model));
    const bool simple = c->model == CAMERA_SIMPLE_PINHOLE;
    v->width = c->width;
    v->height = c->height;
    v->fx = c->params[0];
    v->fy = c->params[simple ? 0 : 1];
    v->cx = c->params[simple ? 1 : 2];
    v->cy = c->params[simple ? 2 : 3];
    set_pose(v, im->cam_from_world.rotation, pose_center(&im->cam_from_world));
    return check_size(v, first, where, err);
}

static enum status read_colmap(struct camera_path *path, const char *folder, const char *name, double fps,
                               struct provenance *prov, struct err *err)
{
    struct sfm_model m = {0};
    const struct sfm_image **order = NULL;
    if (sfm_model_read_cameras(&m, folder, prov, err)) return err->status;
    if (!m.image_count) err_set(err, ST_DATA, "%s/images.txt has no images, wanted one for each frame.", folder);
    if (!err->status && !(order = calloc((size_t)m.image_count, sizeof *order)))
        err_nomem(err, "images", (size_t)m.image_count * sizeof *order);
    if (!err->status && !camera_path_init(path, name, fps, m.image_count, err)) {
        for (int i = 0; i < m.image_count; i++) order[i] = &m.images[i];
        qsort(order, (size_t)m.image_count, sizeof *order, by_number);
        for (int i = 0; !err->status && i < m.image_count; i++)
            read_image(&path->frames[i], &path->frames[0].camera, &m, order[i], folder, err);
    }
    free(order);
    sfm_model_release(&m);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- checks */

static bool shows_a_point(const struct view *v, const struct camera_set *set)
{
    for (int i = 0; i < set->model.point_count; i++) {
        double x, y;
        if (view_project(v, set->model.points[i].position, &x, &y) > 0 && x >= 0 && y >= 0 && x < v->width &&
            y < v->height)
            return true;
    }
    return false;
}

static enum status check_world(const struct camera_path *path, const char *file, const struct camera_set *set,
                               struct err *err)
{
    int blind = 0, first = 0;
    for (int i = path->frame_count - 1; i >= 0; i--)
        if (!shows_a_point(&path->frames[i].camera, set)) blind++, first = i;
    if (!blind || !set->model.point_count) return ST_OK;
    if (blind == path->frame_count)
        return err_set(err, ST_DATA,
                       "%s: found no camera that looks at the scene, wanted cameras in its world, that of "
                       "points/points.ply: has the other program moved or scaled it?",
                       file);
    log_warn("%s: %d of %d cameras show none of the scene's points; the first is that of frame %d", file, blind,
             path->frame_count, first + 1);
    return ST_OK;
}

enum status given_path_read(struct camera_path *path, const char *file, const char *name, double fps,
                            const struct camera_set *set, struct provenance *prov, struct err *err)
{
    *path = (struct camera_path){0};
    (path_is_folder(file) ? read_colmap : read_transforms)(path, file, name, fps, prov, err);
    if (!err->status && path->frame_count < 2)
        err_set(err, ST_DATA, "%s: found a single camera, wanted two or more: each is a frame.", file);
    if (!err->status) check_world(path, file, set, err);
    if (err->status) camera_path_release(path);
    return err->status;
}
