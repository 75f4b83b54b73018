/* place_siblings.c - photos without a pose get one from other pictures of the same photo.
 *
 * A bare wall gives no matches, so a picture of it alone cannot be placed; but it was cut out of a photo of which other
 * pictures could. Of a panorama the turns between its views are known, and the centre is one. Of a multi-lens camera
 * the pose of a lens beside another is that of a capture in which both are placed:
 *
 *   cam_from_world(capture, lens) = [lens_from_lens(other, lens, known)] o cam_from_world(capture, known)
 *
 * The adjustment has made these poses alike in all captures, so the first is taken. */
#include "stages/sfm_import/place_siblings.h"

#include <stdlib.h>
#include <string.h>

#include "common/capture/panorama_name.h"
#include "common/capture/photo_match.h"
#include "stages/sfm_import/name_lines.h"

struct placer {
    struct sfm_model *m;
    struct split_size split;
    int given; /* images that the model had before */
};

static struct quat rotation_of(const struct placer *p, int image)
{
    return p->m->images[image].cam_from_world.rotation;
}

static struct vec3 centre_of(const struct placer *p, int image)
{
    return pose_center(&p->m->images[image].cam_from_world);
}

static struct pose pose_at(struct quat rotation, struct vec3 centre)
{
    return (struct pose){rotation, vec3_scale(mat3_apply(mat3_from_quat(rotation), centre), -1)};
}

/* False: no view of the panorama is placed. */
static bool place_view(struct pose *pose, int *camera, const struct placer *p, const char *name)
{
    int yaw, other;
    if (!panorama_name_read(&yaw, name)) return false;
    for (int i = 0; i < p->given; i++) {
        if (!panorama_name_same(name, p->m->images[i].name)) continue;
        panorama_name_read(&other, p->m->images[i].name);
        *pose =
            pose_at(quat_normalize(quat_multiply(panorama_name_turn(yaw - other), rotation_of(p, i))), centre_of(p, i));
        *camera = p->m->images[i].camera_idx;
        return true;
    }
    return false;
}

/* The first image of this cell of the photo whose picture is called `photo`; -1: it is not placed. */
static int image_of(const struct placer *p, const char *photo, size_t length, int column, int row)
{
    struct split_name name;
    for (int i = 0; i < p->given; i++)
        if (split_name_read(&name, p->m->images[i].name, p->split) && name.photo_length == length &&
            name.column == column && name.row == row && !strncmp(p->m->images[i].name, photo, length))
            return i;
    return -1;
}

/* The pose of a lens beside the image `known` of its capture, as the images `lens` and `beside` of another have it. */
static struct pose pose_beside(const struct placer *p, int known, int lens, int beside)
{
    const struct quat turn = quat_multiply(rotation_of(p, lens), quat_conjugate(rotation_of(p, beside)));
    const struct vec3 offset =
        mat3_apply(mat3_from_quat(rotation_of(p, beside)), vec3_sub(centre_of(p, lens), centre_of(p, beside)));
    const struct mat3 world_from_known = mat3_transpose(mat3_from_quat(rotation_of(p, known)));
    return pose_at(quat_normalize(quat_multiply(turn, rotation_of(p, known))),
                   vec3_add(centre_of(p, known), mat3_apply(world_from_known, offset)));
}

/* False: no lens of the capture is placed that is beside this one in another. */
static bool place_picture(struct pose *pose, int *camera, const struct placer *p, const char *name)
{
    struct split_name of, lens, known;
    if (!p->split.columns || !split_name_read(&of, name, p->split)) return false;
    for (int i = 0; i < p->given; i++) { /* the same lens in another capture */
        const char *other = p->m->images[i].name;
        if (!split_name_read(&lens, other, p->split) || lens.column != of.column || lens.row != of.row) continue;
        for (int k = 0; k < p->given; k++) { /* another lens of this capture */
            const char *sibling = p->m->images[k].name;
            if (!split_name_read(&known, sibling, p->split) || known.photo_length != of.photo_length ||
                strncmp(sibling, name, of.photo_length))
                continue;
            const int beside = image_of(p, other, lens.photo_length, known.column, known.row);
            if (beside < 0) continue;
            *pose = pose_beside(p, k, i, beside);
            *camera = p->m->images[i].camera_idx;
            return true;
        }
    }
    return false;
}

static enum status add_image(struct sfm_model *m, const char *name, const struct pose *pose, int camera,
                             struct err *err)
{
    int64_t id = 0;
    for (int i = 0; i < m->image_count; i++) id = m->images[i].id > id ? m->images[i].id : id;
    struct sfm_image *images = realloc(m->images, ((size_t)m->image_count + 1) * sizeof *images);
    if (!images) return err_nomem(err, "images", ((size_t)m->image_count + 1) * sizeof *images);
    m->images = images;
    struct sfm_image image = {.id = id + 1, .cam_from_world = *pose, .camera_idx = camera, .name = strdup(name)};
    if (!image.name) return err_nomem(err, "an image's name", strlen(name));
    images[m->image_count++] = image;
    return ST_OK;
}

enum status place_siblings(struct sfm_model *m, const struct photo_list *photos, struct split_size split,
                           struct err *err)
{
    const struct placer placer = {m, split, m->image_count};
    struct name_lines placed = {.heading = "placed by other pictures of the same photo"};
    bool *known = calloc((size_t)photos->count + 1, sizeof *known);
    if (!known) return err_nomem(err, "photos", (size_t)photos->count);
    for (int i = 0; i < m->image_count; i++) {
        const int photo = photo_list_match(photos, m->images[i].name);
        if (photo >= 0) known[photo] = true;
    }
    for (int i = 0; !err->status && i < photos->count; i++) {
        const char *name = photos->photos[i].file;
        struct pose pose;
        int camera;
        if (known[i] || !(place_view(&pose, &camera, &placer, name) || place_picture(&pose, &camera, &placer, name)))
            continue;
        if (!add_image(m, name, &pose, camera, err)) name_lines_add(&placed, name);
    }
    if (!err->status) name_lines_end(&placed);
    free(known);
    return err->status;
}
