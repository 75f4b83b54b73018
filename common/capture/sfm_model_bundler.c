/* sfm_model_bundler.c - the format of Bundler [Snavely 2006], version 0.3.
 *
 * Source: the manual of Bundler 0.4, "Output format and scene representation". A Bundler camera looks along -z with y
 * up, so its y and z axes are the opposite of ours; its pixel coordinates are relative to the picture's centre, y up.
 * The lens f (1 + k1 r^2 + k2 r^4) is COLMAP's RADIAL with the principal point in the centre. */
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/textfile.h"
#include "common/capture/sfm_model_parts.h"

/* A line of exactly n numbers. */
static enum status read_row(struct textfile *t, const char *what, double *values, int n, struct err *err)
{
    if (!textfile_next(t)) return textfile_error(t, err, NULL, "%s", what);
    for (int i = 0; i < n; i++)
        if (textfile_double(t, what, &values[i], err)) return err->status;
    return textfile_end(t, err);
}

static bool is_rotation(struct mat3 r)
{
    struct mat3 one = mat3_multiply(r, mat3_transpose(r));
    struct vec3 x = vec3_make(r.m[0][0], r.m[0][1], r.m[0][2]), y = vec3_make(r.m[1][0], r.m[1][1], r.m[1][2]),
                z = vec3_make(r.m[2][0], r.m[2][1], r.m[2][2]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (!(fabs(one.m[i][j] - (i == j)) < 1e-3)) return false;
    return vec3_dot(vec3_cross(x, y), z) > 0;
}

struct bundler_reader {
    struct textfile file;
    struct sfm_model *model;
    int camera_count;        /* in the file */
    int *image_of;           /* index of the image of each camera in the file; -1: Bundler could not place it */
    struct sfm_track *track; /* of the current point */
    size_t track_capacity;
};

/* *placed: false if Bundler could not place the camera (focal length 0) or its size is unknown. */
static enum status read_camera(struct textfile *t, const int size[2], int number, struct sfm_camera *c,
                               struct pose *pose, bool *placed, struct err *err)
{
    double lens[3], rows[3][3], translation[3];
    if (read_row(t, "focal length and two distortion coefficients", lens, 3, err)) return err->status;
    int line = t->line;
    for (int i = 0; i < 3; i++)
        if (read_row(t, "a row of a rotation", rows[i], 3, err)) return err->status;
    if (read_row(t, "a translation", translation, 3, err)) return err->status;
    *placed = lens[0] != 0 && size[0] > 0;
    if (!*placed) return ST_OK;

    struct mat3 r;
    struct err why = ERR_INIT;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) r.m[i][j] = i ? -rows[i][j] : rows[i][j];
    if (!is_rotation(r))
        return err_set(err, ST_DATA, "%s:%d: found no rotation for camera %d, wanted three orthonormal rows.", t->path,
                       line + 1, number);
    c->id = number + 1;
    c->camera = (struct camera){.model = CAMERA_RADIAL, .width = size[0], .height = size[1]};
    double params[] = {lens[0], size[0] / 2.0, size[1] / 2.0, lens[1], lens[2]};
    memcpy(c->camera.params, params, sizeof params);
    if (camera_check(&c->camera, &why))
        return err_set(err, ST_DATA, "%s:%d: camera %d: %s", t->path, line, number, why.text);
    pose->rotation = quat_from_mat3(r);
    if (!sfm_normalize_rotation(&pose->rotation))
        return err_set(err, ST_INTERNAL, "%s:%d: camera %d: its rotation has no quaternion.", t->path, line, number);
    pose->translation = vec3_make(translation[0], -translation[1], -translation[2]);
    return ST_OK;
}

static enum status read_cameras(struct bundler_reader *r, const char *const *names, const int (*sizes)[2],
                                struct err *err)
{
    struct sfm_model *m = r->model;
    size_t n = (size_t)r->camera_count + 1;
    r->image_of = calloc(n, sizeof *r->image_of);
    m->cameras = calloc(n, sizeof *m->cameras);
    m->images = calloc(n, sizeof *m->images);
    if (!r->image_of || !m->cameras || !m->images) return err_nomem(err, "cameras", n * sizeof *m->cameras);
    for (int i = 0; i < r->camera_count; i++) {
        struct sfm_image *im = &m->images[m->image_count];
        bool placed = false;
        r->image_of[i] = -1;
        if (read_camera(&r->file, sizes[i], i, &m->cameras[m->camera_count], &im->cam_from_world, &placed, err))
            return err->status;
        if (!placed) continue;
        im->id = i + 1;
        im->name = strdup(names[i]);
        im->camera_idx = m->camera_count++;
        r->image_of[i] = m->image_count++;
        if (!im->name) return err_nomem(err, "a name", strlen(names[i]) + 1);
    }
    return ST_OK;
}

/* Reads the line of a point's views into r->track and into the observations of their images. *count: length of the
 * track, without cameras that were not placed. */
static enum status read_views(struct bundler_reader *r, int64_t point_id, int *count, struct err *err)
{
    struct textfile *t = &r->file;
    struct sfm_model *m = r->model;
    int64_t views = 0;
    *count = 0;
    if (!textfile_next(t)) return textfile_error(t, err, NULL, "the views of a point");
    if (textfile_int(t, "number of views", 0, INT_MAX, &views, err)) return err->status;
    for (int64_t k = 0; k < views; k++) {
        int64_t number = 0, key = 0;
        double x = 0, y = 0;
        if (textfile_int(t, "camera of a view", 0, r->camera_count - 1, &number, err) ||
            textfile_int(t, "feature of a view", 0, INT64_MAX, &key, err) ||
            textfile_double(t, "x of a view", &x, err) || textfile_double(t, "y of a view", &y, err))
            return err->status;
        int idx = r->image_of[number];
        if (idx < 0) continue;
        struct sfm_image *im = &m->images[idx];
        const struct camera *c = &m->cameras[im->camera_idx].camera;
        if (sfm_append(&im->observations, im->observation_count, sizeof *im->observations, "observations", err) ||
            array_reserve(&r->track, &r->track_capacity, (size_t)*count + 1, sizeof *r->track, "track entries", err))
            return err->status;
        im->observations[im->observation_count] =
            (struct sfm_observation){c->width / 2.0 + x, c->height / 2.0 - y, point_id};
        r->track[(*count)++] = (struct sfm_track){idx, im->observation_count++};
    }
    return textfile_end(t, err);
}

static enum status read_point(struct bundler_reader *r, struct sfm_point *p, struct err *err)
{
    struct textfile *t = &r->file;
    double position[3], rgb[3];
    int count = 0;
    if (read_row(t, "position of a point", position, 3, err) || read_row(t, "colour of a point", rgb, 3, err))
        return err->status;
    for (int i = 0; i < 3; i++) {
        char text[32];
        snprintf(text, sizeof text, "%.9g", rgb[i]);
        if (!(rgb[i] >= 0 && rgb[i] <= 255)) return textfile_error(t, err, text, "a colour from 0 to 255");
        p->rgb[i] = (uint8_t)rgb[i];
    }
    if (read_views(r, p->id, &count, err)) return err->status;
    p->position = vec3_make(position[0], position[1], position[2]);
    p->error = -1; /* not in the file */
    return sfm_set_track(p, r->track, count, err);
}

static enum status read_points(struct bundler_reader *r, int64_t points, struct err *err)
{
    struct sfm_model *m = r->model;
    for (int64_t i = 0; i < points; i++) {
        struct sfm_point p = {.id = i + 1};
        if (sfm_append(&m->points, m->point_count, sizeof p, "points", err) || read_point(r, &p, err))
            return err->status;
        m->points[m->point_count++] = p;
    }
    m->points = sfm_shrink(m->points, m->point_count, sizeof *m->points);
    for (int i = 0; i < m->image_count; i++) {
        struct sfm_image *im = &m->images[i];
        im->observations = sfm_shrink(im->observations, im->observation_count, sizeof *im->observations);
    }
    return ST_OK;
}

static enum status sort_images(struct sfm_model *m, const char *path, struct err *err)
{
    int *old_idx = NULL;
    sfm_sort_images(m, &old_idx, err);
    for (int i = 1; !err->status && i < m->image_count; i++)
        if (!strcmp(m->images[i - 1].name, m->images[i].name))
            err_set(err, ST_DATA, "%s: image \"%s\" is twice in the list of images, wanted each once.", path,
                    m->images[i].name);
    free(old_idx);
    return err->status;
}

enum status sfm_model_read_bundler(struct sfm_model *m, const char *path, const char *const *names,
                                   const int (*sizes)[2], int count, struct err *err)
{
    struct bundler_reader r = {.model = m, .camera_count = count};
    struct textfile *t = &r.file;
    int64_t cameras = 0, points = 0;
    *m = (struct sfm_model){0};
    textfile_open(t, path, err);
    if (!err->status && (!textfile_next_raw(t) || !t->cursor || strncmp(t->cursor, "# Bundle file v0.3", 18)))
        err_set(err, ST_DATA, "%s:1: found another first line, wanted \"# Bundle file v0.3\".", path);
    if (!err->status && !textfile_next(t)) textfile_error(t, err, NULL, "the numbers of cameras and points");
    if (!err->status && !textfile_int(t, "number of cameras", 0, INT_MAX, &cameras, err) &&
        !textfile_int(t, "number of points", 0, INT_MAX, &points, err))
        textfile_end(t, err);
    if (!err->status && cameras != count)
        err_set(err, ST_DATA, "%s:%d: found %" PRId64 " cameras, wanted %d, the number of images in the model's list.",
                path, t->line, cameras, count);
    if (!err->status && !read_cameras(&r, names, sizes, err) && !read_points(&r, points, err))
        textfile_end_of_file(t, err);
    if (!err->status && !m->image_count) err_set(err, ST_DATA, "%s contains no camera that Bundler could place.", path);
    if (!err->status) sort_images(m, path, err);
    free(r.image_of);
    free(r.track);
    textfile_release(t);
    if (err->status) sfm_model_release(m);
    return err->status;
}
