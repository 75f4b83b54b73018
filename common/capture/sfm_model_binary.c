/* sfm_model_binary.c - COLMAP's binary format (https://colmap.github.io/format.html): cameras.bin, images.bin and
 * points3D.bin, of version 3.8 to 4, which also writes rigs.bin and frames.bin; they repeat the images' poses.
 *
 * All numbers are little-endian. Each file begins with the number of its records (64 bits):
 *   camera   id (32), lens model (32), width, height (64), the model's parameters (double)
 *   image    id (32), QW QX QY QZ TX TY TZ (double), camera (32), name up to a NUL, number of observations (64),
 *            and of each X Y (double), point (64; all bits set: none)
 *   point    id (64), X Y Z (double), R G B (8), error (double), length of the track (64), and of each entry
 *            image, observation (32)
 * A camera of a model that this program does not know ends the reading, since the number of its parameters is unknown.
 * A count is believed only as far as the file has bytes for it. */
#include <endian.h>
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/capture/sfm_model_parts.h"
#include "common/capture/sfm_tracks.h"

/* By COLMAP's numbers. */
static const char *const lens_names[] = {
    "SIMPLE_PINHOLE",
    "PINHOLE",
    "SIMPLE_RADIAL",
    "RADIAL",
    "OPENCV",
    "OPENCV_FISHEYE",
    "FULL_OPENCV",
    "FOV",
    "SIMPLE_RADIAL_FISHEYE",
    "RADIAL_FISHEYE",
    "THIN_PRISM_FISHEYE",
    "RAD_TAN_THIN_PRISM_FISHEYE",
    "SIMPLE_DIVISION",
    "DIVISION",
    "SIMPLE_FISHEYE",
    "FISHEYE",
    "EUCM",
    "EQUIRECTANGULAR",
};

struct binary_file {
    char path[FILE_PATH];
    struct file_bytes file;
    size_t at;
    const char *what; /* the kind of record, for errors */
    uint64_t count, record;
};

static enum status cut_off(const struct binary_file *f, struct err *err)
{
    return err_set(err, ST_DATA,
                   "%s ends in %s %" PRIu64 " of %" PRIu64 ": it is cut off, or not COLMAP's. Copy it again.", f->path,
                   f->what, f->record + 1, f->count);
}

static enum status take(struct binary_file *f, void *to, size_t size, struct err *err)
{
    if (f->file.size - f->at < size) return cut_off(f, err);
    memcpy(to, f->file.bytes + f->at, size);
    f->at += size;
    return ST_OK;
}

static enum status take_64(struct binary_file *f, uint64_t *value, struct err *err)
{
    if (take(f, value, sizeof *value, err)) return err->status;
    *value = le64toh(*value);
    return ST_OK;
}

static enum status take_32(struct binary_file *f, uint32_t *value, struct err *err)
{
    if (take(f, value, sizeof *value, err)) return err->status;
    *value = le32toh(*value);
    return ST_OK;
}

static enum status take_doubles(struct binary_file *f, double *values, int count, struct err *err)
{
    for (int i = 0; i < count; i++) {
        uint64_t bits = 0;
        if (take_64(f, &bits, err)) return err->status;
        memcpy(&values[i], &bits, sizeof bits);
        if (!isfinite(values[i]))
            return err_set(err, ST_DATA, "%s: %s %" PRIu64 " of %" PRIu64 " has the number %g, wanted finite ones.",
                           f->path, f->what, f->record + 1, f->count, values[i]);
    }
    return ST_OK;
}

/* The number of items of at least `size` bytes each that follow. */
static enum status take_count(struct binary_file *f, uint64_t *count, size_t size, struct err *err)
{
    if (take_64(f, count, err)) return err->status;
    return *count > (f->file.size - f->at) / size || *count > INT_MAX ? cut_off(f, err) : ST_OK;
}

/* least: bytes of a record. The caller closes f, also after a failure. */
static enum status open_file(struct binary_file *f, const char *folder, const char *name, const char *what,
                             size_t least, struct err *err)
{
    f->what = what;
    return file_path(f->path, folder, name, "", err) || file_bytes_read(&f->file, f->path, err) ||
                   take_count(f, &f->count, least, err)
               ? err->status
               : ST_OK;
}

static enum status close_file(struct binary_file *f, struct err *err)
{
    if (!err->status && f->at < f->file.size)
        err_set(err, ST_DATA, "%s has %zu bytes after its %" PRIu64 " %ss; it is damaged, or no file of COLMAP.",
                f->path, f->file.size - f->at, f->count, f->what);
    file_bytes_release(&f->file);
    return err->status;
}

static enum status unknown_lens(const struct binary_file *f, uint32_t id, uint32_t model, struct err *err)
{
    const size_t known = sizeof lens_names / sizeof *lens_names;
    char names[256] = "", name[64] = "";
    for (int i = 0; i < CAMERA_MODEL_COUNT; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), " %s", camera_model_name((enum camera_model)i));
    if (model < known) snprintf(name, sizeof name, ", %s,", lens_names[model]);
    return err_set(err, ST_DATA,
                   "%s: camera %" PRIu32 " has COLMAP's lens model number %" PRIu32
                   "%s which is not supported; wanted one of%s. COLMAP's image_undistorter makes photos and a model "
                   "without distortion.",
                   f->path, id, model, name, names);
}

static enum status read_camera(struct binary_file *f, struct sfm_camera *c, struct err *err)
{
    uint32_t id = 0, model = 0;
    uint64_t size[2] = {0};
    struct err why = ERR_INIT;
    if (take_32(f, &id, err) || take_32(f, &model, err)) return err->status;
    if (model >= sizeof lens_names / sizeof *lens_names || !camera_model_from_name(lens_names[model], &c->camera.model))
        return unknown_lens(f, id, model, err);
    for (int i = 0; i < 2; i++)
        if (take_64(f, &size[i], err)) return err->status;
    if (take_doubles(f, c->camera.params, camera_model_params(c->camera.model), err)) return err->status;
    c->id = id;
    c->camera.width = size[0] > INT_MAX ? 0 : (int)size[0]; /* 0 is refused */
    c->camera.height = size[1] > INT_MAX ? 0 : (int)size[1];
    return camera_check(&c->camera, &why) ? err_set(err, ST_DATA, "%s: camera %" PRIu32 ": %s", f->path, id, why.text)
                                          : ST_OK;
}

static enum status read_cameras(struct sfm_model *m, struct id_list *ids, const char *folder, struct err *err)
{
    struct binary_file f = {0};
    open_file(&f, folder, "cameras.bin", "camera", 24, err);
    for (; !err->status && f.record < f.count; f.record++) {
        struct sfm_camera c = {0};
        if (!read_camera(&f, &c, err) &&
            !sfm_append(&m->cameras, m->camera_count, sizeof *m->cameras, "cameras", err) &&
            !id_list_add(ids, c.id, 0, err))
            m->cameras[m->camera_count++] = c;
    }
    if (!err->status) id_list_sort(ids, f.path, "camera", err);
    return close_file(&f, err);
}

static enum status read_observations(struct binary_file *f, struct sfm_image *im, struct err *err)
{
    uint64_t count = 0;
    if (take_count(f, &count, 24, err) || !count) return err->status;
    im->observations = malloc((size_t)count * sizeof *im->observations);
    if (!im->observations) return err_nomem(err, "observations", (size_t)count * sizeof *im->observations);
    for (; im->observation_count < (int)count; im->observation_count++) {
        double at[2] = {0};
        uint64_t point = 0;
        if (take_doubles(f, at, 2, err) || take_64(f, &point, err)) return err->status;
        im->observations[im->observation_count] =
            (struct sfm_observation){at[0], at[1], point > INT64_MAX ? -1 : (int64_t)point};
    }
    return ST_OK;
}

/* On failure the caller releases the name and the observations. */
static enum status read_image(struct binary_file *f, struct sfm_image *im, const struct id_list *cameras,
                              struct err *err)
{
    double pose[7] = {0};
    uint32_t id = 0, camera = 0;
    if (take_32(f, &id, err) || take_doubles(f, pose, 7, err) || take_32(f, &camera, err)) return err->status;
    const char *name = f->file.bytes + f->at, *end = memchr(name, '\0', f->file.size - f->at);
    if (!end) return cut_off(f, err);
    f->at += (size_t)(end - name) + 1;
    im->id = id;
    im->cam_from_world = (struct pose){{pose[0], pose[1], pose[2], pose[3]}, {pose[4], pose[5], pose[6]}};
    im->camera_idx = id_list_find(cameras, camera);
    im->name = strdup(name);
    if (!im->name) return err_nomem(err, "a name", strlen(name) + 1);
    if (!sfm_normalize_rotation(&im->cam_from_world.rotation))
        return err_set(err, ST_DATA, "%s: image \"%s\" has a quaternion of length 0, wanted one of length 1.", f->path,
                       name);
    if (im->camera_idx < 0)
        return err_set(err, ST_DATA, "%s: image \"%s\" is of camera %" PRIu32 ", which is not in cameras.bin.", f->path,
                       name, camera);
    return read_observations(f, im, err);
}

static enum status sort_images(struct sfm_model *m, struct id_list *ids, const char *path, struct err *err)
{
    int *old_idx = NULL;
    sfm_sort_images(m, &old_idx, err);
    free(old_idx);
    for (int i = 0; !err->status && i < m->image_count; i++) {
        id_list_row(ids, m->images[i].id)->idx = i;
        if (i && !strcmp(m->images[i - 1].name, m->images[i].name))
            err_set(err, ST_DATA, "%s has image \"%s\" twice, wanted each once.", path, m->images[i].name);
    }
    return err->status;
}

static enum status read_images(struct sfm_model *m, struct id_list *ids, const struct id_list *cameras,
                               const char *folder, struct err *err)
{
    struct binary_file f = {0};
    open_file(&f, folder, "images.bin", "image", 73, err);
    for (; !err->status && f.record < f.count; f.record++) {
        struct sfm_image im = {0};
        if (!read_image(&f, &im, cameras, err) && !sfm_append(&m->images, m->image_count, sizeof im, "images", err) &&
            !id_list_add(ids, im.id, 0, err)) {
            m->images[m->image_count++] = im;
        } else {
            free(im.name);
            free(im.observations);
        }
    }
    if (!err->status && !m->image_count) err_set(err, ST_DATA, "%s contains no image.", f.path);
    if (!err->status && !id_list_sort(ids, f.path, "image", err)) sort_images(m, ids, f.path, err);
    return close_file(&f, err);
}

struct track_buffer {
    struct sfm_track *entries; /* owned */
    size_t capacity;
};

/* On failure the caller releases p->track. */
static enum status read_point(struct binary_file *f, struct sfm_point *p, struct track_marks *marks,
                              struct track_buffer *track, long long *loose, struct err *err)
{
    double position[3] = {0};
    uint64_t id = 0, length = 0;
    int count = 0;
    if (take_64(f, &id, err) || take_doubles(f, position, 3, err) || take(f, p->rgb, 3, err) ||
        take_doubles(f, &p->error, 1, err) || take_count(f, &length, 8, err) ||
        array_reserve(&track->entries, &track->capacity, (size_t)length + 1, sizeof *track->entries, "track entries",
                      err))
        return err->status;
    if (id > INT64_MAX)
        return err_set(err, ST_DATA, "%s has a point with the number %" PRIu64 ", which is too large.", f->path, id);
    p->id = (int64_t)id;
    p->position = vec3_make(position[0], position[1], position[2]);
    for (uint64_t i = 0; i < length; i++) {
        uint32_t image = 0, observation = 0;
        if (take_32(f, &image, err) || take_32(f, &observation, err)) return err->status;
        const bool good = track_marks_take(marks, image, observation, p->id, &track->entries[count]) == TRACK_GOOD;
        count += good;
        *loose += !good;
    }
    return sfm_set_track(p, track->entries, count, err);
}

static enum status read_points(struct sfm_model *m, struct track_marks *marks, const char *folder, long long *loose,
                               struct err *err)
{
    struct binary_file f = {0};
    struct id_list ids = {0};
    struct track_buffer track = {0};
    open_file(&f, folder, "points3D.bin", "point", 51, err);
    for (; !err->status && f.record < f.count; f.record++) {
        struct sfm_point p = {0};
        if (sfm_append(&m->points, m->point_count, sizeof p, "points", err) ||
            read_point(&f, &p, marks, &track, loose, err) || id_list_add(&ids, p.id, 0, err))
            free(p.track);
        else
            m->points[m->point_count++] = p;
    }
    m->points = sfm_shrink(m->points, m->point_count, sizeof *m->points);
    if (!err->status) sfm_sort_points(m, &ids, f.path, err);
    free(track.entries);
    id_list_release(&ids);
    return close_file(&f, err);
}

enum status sfm_model_read_given_binary(struct sfm_model *m, const char *folder, long long *loose, struct err *err)
{
    struct id_list cameras = {0}, images = {0};
    struct track_marks marks = {0};
    char points[FILE_PATH];
    *m = (struct sfm_model){0};
    *loose = 0;
    if (!file_path(points, folder, "points3D.bin", "", err) && !read_cameras(m, &cameras, folder, err) &&
        !read_images(m, &images, &cameras, folder, err) && !track_marks_make(&marks, m, &images, err) &&
        path_is_file(points))
        read_points(m, &marks, folder, loose, err);
    if (!err->status) track_marks_clear_others(&marks);
    track_marks_release(&marks);
    id_list_release(&cameras);
    id_list_release(&images);
    if (err->status) sfm_model_release(m);
    return err->status;
}
