/* panorama_poses.c - given poses of panoramas become those of the views that are cut out of them. */
#include "stages/sfm/panorama_poses.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/panorama_name.h"
#include "common/capture/photo_id.h"
#include "common/capture/photo_match.h"
#include "common/capture/sfm_model_parts.h"
#include "stages/sfm/given_cameras.h"
#include "stages/sfm/panorama_rigs.h"

/* The id that the panorama of an image's name has. */
static void id_of(char id[MAX_PHOTO_ID + 1], const char *name)
{
    const char *base = name;
    for (const char *p = name; *p; p++)
        if (*p == '/' || *p == '\\') base = p + 1;
    const char *dot = strrchr(base, '.');
    photo_id_from_stem(id, base, dot && dot > base ? (size_t)(dot - base) : strlen(base));
}

static enum status add_view(struct sfm_model *to, const struct photo_record *view, int yaw, const struct pose *pose,
                            struct err *err)
{
    const double side = view->info.width;
    const struct camera lens = {
        CAMERA_PINHOLE, view->info.width, view->info.height, {side / 2, side / 2, side / 2, side / 2}};
    const struct quat turn = panorama_name_turn(yaw);
    int at = given_cameras_find(to, &lens);
    if (at < 0) {
        if (array_append(&to->cameras, (size_t)to->camera_count, sizeof *to->cameras, "cameras", err))
            return err->status;
        at = to->camera_count++;
        int64_t id = 1;
        for (int i = 0; i < at; i++) id = to->cameras[i].id >= id ? to->cameras[i].id + 1 : id;
        to->cameras[at] = (struct sfm_camera){id, lens};
    }
    if (array_append(&to->images, (size_t)to->image_count, sizeof *to->images, "images", err)) return err->status;
    struct sfm_image *im = &to->images[to->image_count];
    *im = (struct sfm_image){.camera_idx = at, .name = strdup(view->file)};
    if (!im->name) return err_nomem(err, "a name", strlen(view->file) + 1);
    to->image_count++;
    im->cam_from_world =
        (struct pose){quat_multiply(turn, pose->rotation), mat3_apply(mat3_from_quat(turn), pose->translation)};
    return ST_OK;
}

/* Adds the views of one image; *added: how many there are. */
static enum status add_views(int *added, struct sfm_model *to, const struct sfm_image *image,
                             const struct photo_list *photos, struct err *err)
{
    char id[MAX_PHOTO_ID + 1];
    *added = 0;
    if (photo_list_match(photos, image->name) >= 0) return ST_OK;
    id_of(id, image->name);
    for (int i = 0; !err->status && i < photos->count; i++) {
        const struct photo_record *p = &photos->photos[i];
        int yaw = 0;
        const size_t length = panorama_name_read(&yaw, p->file);
        if (!length || length != strlen(id) || strncmp(p->file, id, length) != 0) continue;
        add_view(to, p, yaw, &image->cam_from_world, err);
        ++*added;
    }
    return err->status;
}

static void drop_points(struct sfm_model *m)
{
    for (int i = 0; i < m->point_count; i++) free(m->points[i].track);
    free(m->points);
    m->points = NULL;
    m->point_count = 0;
    for (int i = 0; i < m->image_count; i++)
        for (int k = 0; k < m->images[i].observation_count; k++) m->images[i].observations[k].point_id = -1;
}

static void drop_image(struct sfm_model *m, int at)
{
    free(m->images[at].name);
    free(m->images[at].observations);
    memmove(&m->images[at], &m->images[at + 1], (size_t)(m->image_count - at - 1) * sizeof *m->images);
    m->image_count--;
}

enum status panorama_poses_expand(int *replaced, struct sfm_model *m, const struct photo_list *photos, struct err *err)
{
    int *old_idx = NULL;
    *replaced = 0;
    for (int i = 0, left = m->image_count; !err->status && left > 0; left--) {
        const struct sfm_image image = m->images[i];
        int added = 0;
        if (add_views(&added, m, &image, photos, err) || !added) {
            i++;
            continue;
        }
        if (!*replaced) drop_points(m);
        drop_image(m, i);
        ++*replaced;
    }
    if (err->status || !*replaced) return err->status;
    for (int i = 0; i < m->image_count; i++) m->images[i].id = i + 1;
    sfm_sort_images(m, &old_idx, err);
    free(old_idx);
    return err->status;
}
