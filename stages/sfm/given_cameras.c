/* given_cameras.c - see given_cameras.h. */
#include "stages/sfm/given_cameras.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/photo_match.h"
#include "common/capture/sfm_model_parts.h"

enum status given_lens_camera(struct camera *c, const struct given_lens *lens, const char *where, struct err *err)
{
    const double *k = lens->k, *p = lens->p;
    const bool tangential = p[0] != 0 || p[1] != 0;
    struct err why = ERR_INIT;
    *c = (struct camera){CAMERA_PINHOLE, lens->width, lens->height, {lens->fx, lens->fy, lens->cx, lens->cy}};
    double *to = c->params + 4;
    if (lens->fisheye) {
        c->model = tangential ? CAMERA_THIN_PRISM_FISHEYE : CAMERA_OPENCV_FISHEYE;
        const double values[] = {k[0], k[1], tangential ? p[0] : k[2], tangential ? p[1] : k[3], k[2], k[3]};
        memcpy(to, values, (size_t)(tangential ? 6 : 4) * sizeof *to);
    } else if (k[3] != 0) {
        return err_set(
            err, ST_DATA,
            "%s has a fourth radial coefficient, k4 = %.9g, which is not supported; calibrate with three, or "
            "export photos without distortion.",
            where, k[3]);
    } else if (k[0] != 0 || k[1] != 0 || k[2] != 0 || tangential) {
        c->model = k[2] != 0 ? CAMERA_FULL_OPENCV : CAMERA_OPENCV;
        const double values[] = {k[0], k[1], p[0], p[1], k[2]};
        memcpy(to, values, (k[2] != 0 ? 5 : 4) * sizeof *to);
    }
    return camera_check(c, &why) ? err_set(err, ST_DATA, "%s: %s", where, why.text) : ST_OK;
}

int given_cameras_find(const struct sfm_model *m, const struct camera *c)
{
    for (int i = 0; i < m->camera_count; i++) {
        const struct camera *d = &m->cameras[i].camera;
        if (d->model == c->model && d->width == c->width && d->height == c->height &&
            !memcmp(d->params, c->params, (size_t)camera_model_params(c->model) * sizeof *c->params))
            return i;
    }
    return -1;
}

enum status given_panorama_lens(struct camera *c, const char *name, const struct photo_list *photos, const char *where,
                                struct err *err)
{
    const int photo = photo_list_match(photos, name);
    *c = (struct camera){CAMERA_PINHOLE, 2, 1, {1, 1, 1, 0.5}};
    if (photo < 0) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s is a panorama, but its photo %s is not taken for one; set [import_photos] panoramas = yes.",
                   where, photos->photos[photo].file);
}

enum status given_cameras_add(struct sfm_model *m, const char *name, const struct camera *c, const struct vec3 axes[3],
                              struct vec3 center, const char *where, struct err *err)
{
    struct mat3 turn; /* camera from world */
    int at = given_cameras_find(m, c);
    if (pose_turn_from_axes(&turn, axes, where, err)) return err->status;
    if (at < 0) {
        if (array_append(&m->cameras, (size_t)m->camera_count, sizeof *m->cameras, "cameras", err)) return err->status;
        at = m->camera_count++;
        m->cameras[at] = (struct sfm_camera){at + 1, *c};
    }
    if (array_append(&m->images, (size_t)m->image_count, sizeof *m->images, "images", err)) return err->status;
    struct sfm_image *im = &m->images[m->image_count];
    *im = (struct sfm_image){.id = m->image_count + 1, .camera_idx = at, .name = strdup(name)};
    if (!im->name) return err_nomem(err, "a name", strlen(name) + 1);
    m->image_count++;
    im->cam_from_world.rotation = quat_from_mat3(turn);
    if (!sfm_normalize_rotation(&im->cam_from_world.rotation))
        return err_set(err, ST_DATA, "%s: its rotation has no quaternion.", where);
    im->cam_from_world.translation = vec3_scale(mat3_apply(mat3_from_quat(im->cam_from_world.rotation), center), -1);
    return ST_OK;
}

enum status given_cameras_end(struct sfm_model *m, const char *path, struct err *err)
{
    int *old_idx = NULL;
    if (!m->image_count) return err_set(err, ST_DATA, "%s places no photo of the scene.", path);
    sfm_sort_images(m, &old_idx, err);
    for (int i = 1; !err->status && i < m->image_count; i++)
        if (!strcmp(m->images[i - 1].name, m->images[i].name))
            err_set(err, ST_DATA, "%s: image \"%s\" is there twice, wanted each once.", path, m->images[i].name);
    free(old_idx);
    return err->status;
}
