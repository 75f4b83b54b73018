/* sfm_model.c - reading and writing structure-from-motion models.
 *
 * COLMAP's text format: https://colmap.github.io/format.html. Bundler's: the manual of version 0.4, "Output format
 * and scene representation". Images are read before points, so that every entry of a track can be checked, with its
 * line, against the observation that it names; an observation that no track lists is found afterwards. */
#include "common/capture/sfm_model.h"

#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/outfile.h"
#include "common/base/textfile.h"

/* Makes room for one more element in an array that grows by half; the array and its room are updated. */
static enum status grow(void *array, int count, int *room, size_t size, const char *what, struct err *err)
{
    void **a = array;
    if (count < *room) return ST_OK;
    if (count > INT_MAX / 2) return err_set(err, ST_DATA, "there are more than %d %s.", count, what);
    int more = *room < 16 ? 16 : *room + *room / 2;
    void *p = realloc(*a, (size_t)more * size);
    if (!p) return err_nomem(err, what, (size_t)more * size);
    *a = p;
    *room = more;
    return ST_OK;
}

/* Gives back the room that a finished array does not use. */
static void *shrink(void *array, int count, size_t size)
{
    if (count == 0) {
        free(array);
        return NULL;
    }
    void *p = realloc(array, (size_t)count * size);
    return p ? p : array;
}

static char *path_join(const char *folder, const char *file, struct err *err)
{
    size_t size = strlen(folder) + strlen(file) + 2;
    char *path = malloc(size);
    if (!path) {
        err_nomem(err, "a path", size);
        return NULL;
    }
    snprintf(path, size, "%s/%s", folder, file);
    return path;
}

/* An id of a file, the place of its record in the array being filled, and its line. */
struct id_row {
    int64_t id;
    int idx, line;
};

struct id_list {
    struct id_row *rows;
    int count, room;
    bool ascending; /* as read */
};

static enum status id_list_add(struct id_list *l, int64_t id, int line, struct err *err)
{
    if (grow(&l->rows, l->count, &l->room, sizeof *l->rows, "ids", err)) return err->status;
    l->ascending = l->count == 0 || (l->ascending && l->rows[l->count - 1].id < id);
    l->rows[l->count] = (struct id_row){id, l->count, line};
    l->count++;
    return ST_OK;
}

static int compare_rows(const void *a, const void *b)
{
    const struct id_row *x = a, *y = b;
    return x->id != y->id ? (x->id < y->id ? -1 : 1) : (x->line > y->line) - (x->line < y->line);
}

static enum status id_list_sort(struct id_list *l, const char *path, const char *what, struct err *err)
{
    if (l->count && !l->ascending) qsort(l->rows, (size_t)l->count, sizeof *l->rows, compare_rows);
    for (int i = 1; i < l->count; i++)
        if (l->rows[i - 1].id == l->rows[i].id)
            return err_set(err, ST_DATA,
                           "%s:%d: found %s %" PRId64 " a second time (first on line %d), wanted each id once.", path,
                           l->rows[i].line, what, l->rows[i].id, l->rows[i - 1].line);
    return ST_OK;
}

/* Index of the record with this id, or -1. The list is sorted. */
static int id_list_find(const struct id_list *l, int64_t id)
{
    int low = 0, high = l->count;
    while (low < high) {
        int mid = low + (high - low) / 2;
        if (l->rows[mid].id < id)
            low = mid + 1;
        else
            high = mid;
    }
    return low < l->count && l->rows[low].id == id ? l->rows[low].idx : -1;
}

static void id_list_release(struct id_list *l)
{
    free(l->rows);
    *l = (struct id_list){0};
}

static int find_point(const struct sfm_model *m, int64_t id)
{
    int low = 0, high = m->point_count;
    while (low < high) {
        int mid = low + (high - low) / 2;
        if (m->points[mid].id < id)
            low = mid + 1;
        else
            high = mid;
    }
    return low < m->point_count && m->points[low].id == id ? low : -1;
}

/* --------------------------------------------------------------------------------------------------- COLMAP's text */

static enum status read_cameras(struct sfm_model *m, struct id_list *ids, const char *folder, struct err *err)
{
    struct textfile t = {0};
    enum status st = ST_OK;
    int room = 0;
    char *path = path_join(folder, "cameras.txt", err);
    if (!path) return err->status;
    st = textfile_open(&t, path, err);
    while (!st && textfile_next(&t)) {
        struct sfm_camera c = {0};
        struct err why = ERR_INIT;
        int64_t width = 0, height = 0;
        char *model = NULL;
        st = textfile_int(&t, "camera id", 0, INT64_MAX, &c.id, err) || textfile_word(&t, "camera model", &model, err);
        if (!st && !camera_model_from_name(model, &c.camera.model)) {
            char names[256] = "";
            for (int i = 0; i < CAMERA_MODEL_COUNT; i++)
                snprintf(names + strlen(names), sizeof names - strlen(names), " %s",
                         camera_model_name((enum camera_model)i));
            st = textfile_error(&t, err, model, "one of the camera models that can be used:%s", names);
        }
        st = st || textfile_int(&t, "width", 1, INT_MAX, &width, err) ||
             textfile_int(&t, "height", 1, INT_MAX, &height, err);
        for (int i = 0; !st && i < camera_model_params(c.camera.model); i++)
            st = textfile_double(&t, "camera parameter", &c.camera.params[i], err);
        st = st || textfile_end(&t, err);
        c.camera.width = (int)width;
        c.camera.height = (int)height;
        if (!st && camera_check(&c.camera, &why))
            st = err_set(err, ST_DATA, "%s:%d: camera %" PRId64 ": %s", path, t.line, c.id, why.text);
        st = st || grow(&m->cameras, m->camera_count, &room, sizeof *m->cameras, "cameras", err) ||
             id_list_add(ids, c.id, t.line, err);
        if (!st) m->cameras[m->camera_count++] = c;
    }
    st = st || id_list_sort(ids, path, "camera", err);
    textfile_release(&t);
    free(path);
    return st ? err->status : ST_OK;
}

/* Makes the quaternion unit. One that is unit to rounding keeps its bits, so that writing and reading changes
 * nothing. */
static bool normalize_rotation(struct quat *q)
{
    double square = q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z;
    if (!isfinite(square) || !(square > 1e-200)) return false;
    if (fabs(square - 1) > 1e-15) {
        double n = sqrt(square);
        *q = (struct quat){q->w / n, q->x / n, q->y / n, q->z / n};
    }
    return true;
}

/* The second line of an image: u v point_id, as often as there are features; often the line is blank. */
static enum status read_observations(struct textfile *t, struct sfm_image *im, struct err *err)
{
    int room = 0;
    enum status st = ST_OK;
    while (!st && textfile_more(t)) {
        struct sfm_observation o = {0};
        st = textfile_double(t, "x of an observation", &o.u, err) ||
             textfile_double(t, "y of an observation", &o.v, err) ||
             textfile_int(t, "point id (-1: none)", -1, INT64_MAX, &o.point_id, err) ||
             grow(&im->observations, im->observation_count, &room, sizeof o, "observations", err);
        if (!st) im->observations[im->observation_count++] = o;
    }
    im->observations = shrink(im->observations, im->observation_count, sizeof *im->observations);
    return st ? err->status : ST_OK;
}

struct named_image {
    struct sfm_image image;
    int line;
};

static int compare_names(const void *a, const void *b)
{
    const struct named_image *x = a, *y = b;
    int order = strcmp(x->image.name, y->image.name);
    return order ? order : (x->line > y->line) - (x->line < y->line);
}

/* lines: of each image, in the order of the model's; the caller frees it. */
static enum status read_images(struct sfm_model *m, const struct id_list *cameras, struct id_list *ids, int **lines,
                               const char *folder, struct err *err)
{
    struct textfile t = {0};
    struct named_image *found = NULL;
    enum status st = ST_OK;
    int count = 0, room = 0;
    char *path = path_join(folder, "images.txt", err);
    if (!path) return err->status;
    st = textfile_open(&t, path, err);
    while (!st && textfile_next(&t)) {
        struct named_image n = {.line = t.line};
        struct sfm_image *im = &n.image;
        struct quat *q = &im->cam_from_world.rotation;
        struct vec3 *p = &im->cam_from_world.translation;
        int64_t camera_id = 0;
        char *name = NULL;
        st = textfile_int(&t, "image id", 0, INT64_MAX, &im->id, err) || textfile_double(&t, "QW", &q->w, err) ||
             textfile_double(&t, "QX", &q->x, err) || textfile_double(&t, "QY", &q->y, err) ||
             textfile_double(&t, "QZ", &q->z, err) || textfile_double(&t, "TX", &p->x, err) ||
             textfile_double(&t, "TY", &p->y, err) || textfile_double(&t, "TZ", &p->z, err) ||
             textfile_int(&t, "camera id", 0, INT64_MAX, &camera_id, err) ||
             textfile_rest(&t, "name of the image", &name, err);
        if (st) break;
        im->camera_idx = id_list_find(cameras, camera_id);
        if (!normalize_rotation(q)) {
            char text[128];
            snprintf(text, sizeof text, "%.9g %.9g %.9g %.9g", q->w, q->x, q->y, q->z);
            st = textfile_error(&t, err, text, "a quaternion QW QX QY QZ of length 1");
        } else if (im->camera_idx < 0) {
            char id[32];
            snprintf(id, sizeof id, "camera %" PRId64, camera_id);
            st = textfile_error(&t, err, id, "a camera id that stands in cameras.txt");
        } else if (!(im->name = strdup(name))) {
            st = err_nomem(err, "a name", strlen(name) + 1);
        } else if (textfile_next_raw(&t)) {
            st = read_observations(&t, im, err);
        }
        st = st || id_list_add(ids, im->id, n.line, err) || grow(&found, count, &room, sizeof n, "images", err);
        if (!st) {
            found[count++] = n;
        } else {
            free(im->name);
            free(im->observations);
        }
    }
    if (!st && !count) st = err_set(err, ST_DATA, "%s holds no image; run structure from motion again.", path);
    st = st || id_list_sort(ids, path, "image", err);
    if (count) qsort(found, (size_t)count, sizeof *found, compare_names);
    for (int i = 1; !st && i < count; i++)
        if (!strcmp(found[i - 1].image.name, found[i].image.name))
            st = err_set(err, ST_DATA, "%s:%d: found image \"%s\" a second time (first on line %d), wanted each once.",
                         path, found[i].line, found[i].image.name, found[i - 1].line);

    m->images = calloc((size_t)count + 1, sizeof *m->images);
    *lines = calloc((size_t)count + 1, sizeof **lines);
    if (m->images && *lines) {
        m->image_count = count;
        for (int i = 0; i < count; i++) {
            m->images[i] = found[i].image;
            (*lines)[i] = found[i].line;
        }
        /* the ids' places are now those in order of name */
        for (int i = 0; !st && i < count; i++) {
            int low = 0, high = ids->count - 1;
            while (low < high) {
                int mid = low + (high - low) / 2;
                if (ids->rows[mid].id < m->images[i].id)
                    low = mid + 1;
                else
                    high = mid;
            }
            ids->rows[low].idx = i;
        }
    } else {
        st = err_nomem(err, "images", (size_t)count * sizeof *m->images);
        for (int i = 0; i < count; i++) {
            free(found[i].image.name);
            free(found[i].image.observations);
        }
    }
    free(found);
    textfile_release(&t);
    free(path);
    return st ? err->status : ST_OK;
}

/* One entry of a track: it must name an observation of this point that no track has named. */
static enum status read_track_entry(struct textfile *t, const struct sfm_model *m, const struct id_list *images,
                                    unsigned char **listed, int64_t point_id, struct sfm_track *track, struct err *err)
{
    int64_t image_id = 0, observation = 0;
    char found[96];
    if (textfile_int(t, "image id of a track", 0, INT64_MAX, &image_id, err) ||
        textfile_int(t, "observation of a track", 0, INT64_MAX, &observation, err))
        return err->status;
    int idx = id_list_find(images, image_id);
    if (idx < 0) {
        snprintf(found, sizeof found, "image %" PRId64, image_id);
        return textfile_error(t, err, found, "an image id that stands in images.txt");
    }
    snprintf(found, sizeof found, "observation %" PRId64 " of image %" PRId64, observation, image_id);
    const struct sfm_image *im = &m->images[idx];
    if (observation >= im->observation_count)
        return textfile_error(t, err, found, "one of that image's %d observations", im->observation_count);
    if (im->observations[observation].point_id != point_id)
        return textfile_error(t, err, found, "an observation that images.txt gives to point %" PRId64, point_id);
    if (listed[idx][observation]) return textfile_error(t, err, found, "each observation once");
    listed[idx][observation] = 1;
    *track = (struct sfm_track){idx, (int)observation};
    return ST_OK;
}

static enum status read_points(struct sfm_model *m, const struct id_list *images, unsigned char **listed,
                               const char *folder, struct err *err)
{
    struct textfile t = {0};
    struct id_list ids = {0};
    struct sfm_track *track = NULL;
    enum status st = ST_OK;
    int room = 0, track_room = 0;
    char *path = path_join(folder, "points3D.txt", err);
    if (!path) return err->status;
    st = textfile_open(&t, path, err);
    while (!st && textfile_next(&t)) {
        struct sfm_point p = {0};
        int64_t rgb[3] = {0};
        int count = 0;
        st = textfile_int(&t, "point id", 0, INT64_MAX, &p.id, err) || textfile_double(&t, "X", &p.position.x, err) ||
             textfile_double(&t, "Y", &p.position.y, err) || textfile_double(&t, "Z", &p.position.z, err) ||
             textfile_int(&t, "R", 0, 255, &rgb[0], err) || textfile_int(&t, "G", 0, 255, &rgb[1], err) ||
             textfile_int(&t, "B", 0, 255, &rgb[2], err) || textfile_double(&t, "reprojection error", &p.error, err);
        for (int i = 0; i < 3; i++) p.rgb[i] = (uint8_t)rgb[i];
        for (; !st && textfile_more(&t); count++)
            st = grow(&track, count, &track_room, sizeof *track, "track entries", err) ||
                 read_track_entry(&t, m, images, listed, p.id, &track[count], err);
        st = st || grow(&m->points, m->point_count, &room, sizeof p, "points", err) ||
             id_list_add(&ids, p.id, t.line, err);
        if (!st && count) {
            p.track = malloc((size_t)count * sizeof *p.track);
            if (!p.track) st = err_nomem(err, "a track", (size_t)count * sizeof *p.track);
        }
        if (st) break;
        if (count) memcpy(p.track, track, (size_t)count * sizeof *p.track);
        p.track_count = count;
        m->points[m->point_count++] = p;
    }
    m->points = shrink(m->points, m->point_count, sizeof *m->points);
    if (!st && !ids.ascending && ids.count) {
        st = id_list_sort(&ids, path, "point", err);
        struct sfm_point *sorted = malloc((size_t)ids.count * sizeof *sorted);
        if (!sorted) st = err_nomem(err, "points", (size_t)ids.count * sizeof *sorted);
        for (int i = 0; sorted && i < ids.count; i++) sorted[i] = m->points[ids.rows[i].idx];
        if (sorted) {
            free(m->points);
            m->points = sorted;
        }
    }
    free(track);
    id_list_release(&ids);
    textfile_release(&t);
    free(path);
    return st ? err->status : ST_OK;
}

static enum status check_observations(const struct sfm_model *m, unsigned char **listed, const int *lines,
                                      const char *folder, struct err *err)
{
    for (int i = 0; i < m->image_count; i++)
        for (int k = 0; k < m->images[i].observation_count; k++) {
            int64_t id = m->images[i].observations[k].point_id;
            if (id == -1 || listed[i][k]) continue;
            return err_set(err, ST_DATA,
                           "%s/images.txt:%d: found that observation %d (from 0) of image \"%s\" is of point %" PRId64
                           ", wanted %s in points3D.txt.",
                           folder, lines[i] + 1, k, m->images[i].name, id,
                           find_point(m, id) < 0 ? "that point" : "it in that point's track");
        }
    return ST_OK;
}

enum status sfm_model_read_text(struct sfm_model *m, const char *folder, struct err *err)
{
    struct id_list cameras = {0}, images = {0};
    unsigned char **listed = NULL;
    int *lines = NULL;
    *m = (struct sfm_model){0};
    enum status st = read_cameras(m, &cameras, folder, err) || read_images(m, &cameras, &images, &lines, folder, err);
    if (!st) {
        listed = calloc((size_t)m->image_count, sizeof *listed);
        if (!listed) st = err_nomem(err, "marks", (size_t)m->image_count * sizeof *listed);
        for (int i = 0; !st && i < m->image_count; i++) {
            listed[i] = calloc((size_t)m->images[i].observation_count + 1, 1);
            if (!listed[i]) st = err_nomem(err, "marks", (size_t)m->images[i].observation_count);
        }
    }
    st = st || read_points(m, &images, listed, folder, err) || check_observations(m, listed, lines, folder, err);
    for (int i = 0; listed && i < m->image_count; i++) free(listed[i]);
    free(listed);
    free(lines);
    id_list_release(&cameras);
    id_list_release(&images);
    if (st) sfm_model_release(m);
    return st ? err->status : ST_OK;
}

enum status sfm_model_read_cameras(struct sfm_model *m, const char *folder, struct err *err)
{
    struct id_list cameras = {0}, images = {0};
    int *lines = NULL;
    *m = (struct sfm_model){0};
    enum status st = read_cameras(m, &cameras, folder, err) || read_images(m, &cameras, &images, &lines, folder, err);
    for (int i = 0; !st && i < m->image_count; i++) {
        free(m->images[i].observations);
        m->images[i].observations = NULL;
        m->images[i].observation_count = 0;
    }
    free(lines);
    id_list_release(&cameras);
    id_list_release(&images);
    if (st) sfm_model_release(m);
    return st ? err->status : ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- Bundler */

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

/* Bundler looks along -z with y up: its y and z axes are the opposite of ours. Its pixels are centred, y up. */
static enum status read_bundler_camera(struct textfile *t, const int size[2], int number, struct sfm_camera *c,
                                       struct pose *pose, bool *placed, struct err *err)
{
    double lens[3], rows[3][3], at[3];
    if (read_row(t, "focal length and two distortion coefficients", lens, 3, err)) return err->status;
    int line = t->line;
    for (int i = 0; i < 3; i++)
        if (read_row(t, "a row of a rotation", rows[i], 3, err)) return err->status;
    if (read_row(t, "a translation", at, 3, err)) return err->status;
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
    if (!normalize_rotation(&pose->rotation))
        return err_set(err, ST_INTERNAL, "%s:%d: camera %d: its rotation has no quaternion.", t->path, line, number);
    pose->translation = vec3_make(at[0], -at[1], -at[2]);
    return ST_OK;
}

/* image_of[number]: index of the image of Bundler's camera, -1 if it was not placed. */
static enum status read_bundler_point(struct textfile *t, struct sfm_model *m, const int *image_of, int cameras,
                                      int *rooms, struct sfm_track **track, int *track_room, struct sfm_point *p,
                                      struct err *err)
{
    double at[3], rgb[3];
    int64_t views = 0;
    int count = 0;
    if (read_row(t, "position of a point", at, 3, err) || read_row(t, "colour of a point", rgb, 3, err))
        return err->status;
    for (int i = 0; i < 3; i++) {
        char text[32];
        snprintf(text, sizeof text, "%.9g", rgb[i]);
        if (!(rgb[i] >= 0 && rgb[i] <= 255)) return textfile_error(t, err, text, "a colour from 0 to 255");
        p->rgb[i] = (uint8_t)rgb[i];
    }
    if (!textfile_next(t)) return textfile_error(t, err, NULL, "the views of a point");
    if (textfile_int(t, "number of views", 0, INT_MAX, &views, err)) return err->status;
    for (int64_t k = 0; k < views; k++) {
        int64_t number = 0, key = 0;
        double x = 0, y = 0;
        if (textfile_int(t, "camera of a view", 0, cameras - 1, &number, err) ||
            textfile_int(t, "feature of a view", 0, INT64_MAX, &key, err) ||
            textfile_double(t, "x of a view", &x, err) || textfile_double(t, "y of a view", &y, err))
            return err->status;
        int idx = image_of[number];
        if (idx < 0) continue;
        struct sfm_image *im = &m->images[idx];
        const struct camera *c = &m->cameras[im->camera_idx].camera;
        if (grow(&im->observations, im->observation_count, &rooms[idx], sizeof *im->observations, "observations",
                 err) ||
            grow(track, count, track_room, sizeof **track, "track entries", err))
            return err->status;
        im->observations[im->observation_count] =
            (struct sfm_observation){c->width / 2.0 + x, c->height / 2.0 - y, p->id};
        (*track)[count++] = (struct sfm_track){idx, im->observation_count++};
    }
    if (textfile_end(t, err)) return err->status;
    p->position = vec3_make(at[0], at[1], at[2]);
    p->error = -1; /* Bundler does not say */
    if (!count) return ST_OK;
    p->track = malloc((size_t)count * sizeof *p->track);
    if (!p->track) return err_nomem(err, "a track", (size_t)count * sizeof *p->track);
    memcpy(p->track, *track, (size_t)count * sizeof *p->track);
    p->track_count = count;
    return ST_OK;
}

/* Puts the images in order of name; tracks follow. */
static enum status sort_images(struct sfm_model *m, struct err *err)
{
    size_t n = (size_t)m->image_count;
    struct named_image *sorted = calloc(n + 1, sizeof *sorted);
    int *new_idx = calloc(n + 1, sizeof *new_idx);
    enum status st = sorted && new_idx ? ST_OK : err_nomem(err, "images", n * sizeof *sorted);
    if (!st) {
        for (size_t i = 0; i < n; i++) sorted[i] = (struct named_image){m->images[i], (int)i};
        qsort(sorted, n, sizeof *sorted, compare_names);
        for (size_t i = 0; i < n; i++) {
            m->images[i] = sorted[i].image;
            new_idx[sorted[i].line] = (int)i;
        }
        for (int i = 0; i < m->point_count; i++)
            for (int k = 0; k < m->points[i].track_count; k++)
                m->points[i].track[k].image_idx = new_idx[m->points[i].track[k].image_idx];
        for (size_t i = 1; !st && i < n; i++)
            if (!strcmp(m->images[i - 1].name, m->images[i].name))
                st = err_set(err, ST_DATA, "image \"%s\" stands twice in the list of images, wanted each once.",
                             m->images[i].name);
    }
    free(sorted);
    free(new_idx);
    return st;
}

enum status sfm_model_read_bundler(struct sfm_model *m, const char *path, const char *const *names,
                                   const int (*sizes)[2], int count, struct err *err)
{
    struct textfile t = {0};
    struct sfm_track *track = NULL;
    int64_t cameras = 0, points = 0;
    int *image_of = NULL, *rooms = NULL, room = 0, track_room = 0;
    *m = (struct sfm_model){0};
    enum status st = textfile_open(&t, path, err);
    if (!st && (!textfile_next_raw(&t) || !t.cursor || strncmp(t.cursor, "# Bundle file v0.3", 18)))
        st = err_set(err, ST_DATA, "%s:1: found another first line, wanted \"# Bundle file v0.3\".", path);
    if (!st && !textfile_next(&t)) st = textfile_error(&t, err, NULL, "the numbers of cameras and points");
    st = st || textfile_int(&t, "number of cameras", 0, INT_MAX, &cameras, err) ||
         textfile_int(&t, "number of points", 0, INT_MAX, &points, err) || textfile_end(&t, err);
    if (!st && cameras != count)
        st = err_set(err, ST_DATA,
                     "%s:%d: found %" PRId64 " cameras, wanted %d, the number of images in the model's list.", path,
                     t.line, cameras, count);
    if (!st) {
        size_t n = (size_t)count + 1;
        image_of = calloc(n, sizeof *image_of);
        rooms = calloc(n, sizeof *rooms);
        m->cameras = calloc(n, sizeof *m->cameras);
        m->images = calloc(n, sizeof *m->images);
        if (!image_of || !rooms || !m->cameras || !m->images) st = err_nomem(err, "cameras", n * sizeof *m->cameras);
    }
    for (int i = 0; !st && i < count; i++) {
        struct sfm_image *im = &m->images[m->image_count];
        bool placed = false;
        st = read_bundler_camera(&t, sizes[i], i, &m->cameras[m->camera_count], &im->cam_from_world, &placed, err);
        image_of[i] = -1;
        if (st || !placed) continue;
        im->id = i + 1;
        im->name = strdup(names[i]);
        if (!im->name) st = err_nomem(err, "a name", strlen(names[i]) + 1);
        im->camera_idx = m->camera_count++;
        image_of[i] = m->image_count++;
    }
    for (int64_t i = 0; !st && i < points; i++) {
        struct sfm_point p = {.id = i + 1};
        st = grow(&m->points, m->point_count, &room, sizeof p, "points", err) ||
             read_bundler_point(&t, m, image_of, count, rooms, &track, &track_room, &p, err);
        if (!st) m->points[m->point_count++] = p;
    }
    if (!st) st = textfile_end_of_file(&t, err);
    if (!st && !m->image_count) st = err_set(err, ST_DATA, "%s holds no camera that Bundler could place.", path);
    if (!st) {
        m->points = shrink(m->points, m->point_count, sizeof *m->points);
        for (int i = 0; i < m->image_count; i++)
            m->images[i].observations =
                shrink(m->images[i].observations, m->images[i].observation_count, sizeof(struct sfm_observation));
        if (sort_images(m, err)) st = err_context(err, "%s", path);
    }
    free(image_of);
    free(rooms);
    free(track);
    textfile_release(&t);
    if (st) sfm_model_release(m);
    return st ? err->status : ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- writing */

static void print_cameras(const struct sfm_model *m, FILE *to)
{
    fputs("# CAMERA_ID MODEL WIDTH HEIGHT PARAMS...\n", to);
    for (int i = 0; i < m->camera_count; i++) {
        const struct camera *c = &m->cameras[i].camera;
        fprintf(to, "%" PRId64 " %s %d %d", m->cameras[i].id, camera_model_name(c->model), c->width, c->height);
        for (int k = 0; k < camera_model_params(c->model); k++) fprintf(to, " %.17g", c->params[k]);
        fputc('\n', to);
    }
}

static void print_images(const struct sfm_model *m, FILE *to)
{
    fputs("# two lines an image: IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME; then X Y POINT3D_ID...\n", to);
    for (int i = 0; i < m->image_count; i++) {
        const struct sfm_image *im = &m->images[i];
        struct quat q = im->cam_from_world.rotation;
        struct vec3 t = im->cam_from_world.translation;
        fprintf(to, "%" PRId64 " %.17g %.17g %.17g %.17g %.17g %.17g %.17g %" PRId64 " %s\n", im->id, q.w, q.x, q.y,
                q.z, t.x, t.y, t.z, m->cameras[im->camera_idx].id, im->name);
        for (int k = 0; k < im->observation_count; k++) {
            const struct sfm_observation *o = &im->observations[k];
            fprintf(to, "%s%.17g %.17g %" PRId64, k ? " " : "", o->u, o->v, o->point_id);
        }
        fputc('\n', to);
    }
}

static void print_points(const struct sfm_model *m, FILE *to)
{
    fputs("# POINT3D_ID X Y Z R G B ERROR, then IMAGE_ID POINT2D_IDX...\n", to);
    for (int i = 0; i < m->point_count; i++) {
        const struct sfm_point *p = &m->points[i];
        fprintf(to, "%" PRId64 " %.17g %.17g %.17g %d %d %d %.17g", p->id, p->position.x, p->position.y, p->position.z,
                p->rgb[0], p->rgb[1], p->rgb[2], p->error);
        for (int k = 0; k < p->track_count; k++)
            fprintf(to, " %" PRId64 " %d", m->images[p->track[k].image_idx].id, p->track[k].observation_idx);
        fputc('\n', to);
    }
}

static enum status write_part(const struct sfm_model *m, const char *folder, const char *file,
                              void (*print)(const struct sfm_model *m, FILE *to), const struct provenance *prov,
                              struct err *err)
{
    struct outfile f = {0};
    char *path = path_join(folder, file, err);
    enum status st = path ? outfile_open(&f, path, err) : err->status;
    if (!st) {
        if (prov) provenance_print(prov, f.fp);
        print(m, f.fp);
        st = outfile_commit(&f, err);
    }
    outfile_discard(&f);
    free(path);
    return st;
}

enum status sfm_model_write_text(const struct sfm_model *m, const char *folder, const struct provenance *prov,
                                 struct err *err)
{
    for (int i = 0; i < m->image_count; i++) {
        const char *name = m->images[i].name;
        size_t n = strlen(name);
        if (n == 0 || strpbrk(name, "\r\n") || strchr(" \t", name[0]) || strchr(" \t", name[n - 1]))
            return err_set(err, ST_DATA, "an image named \"%s\" cannot be written to %s/images.txt; rename it.", name,
                           folder);
    }
    if (write_part(m, folder, "points3D.txt", print_points, prov, err) ||
        write_part(m, folder, "cameras.txt", print_cameras, prov, err) ||
        write_part(m, folder, "images.txt", print_images, prov, err))
        return err->status;
    return ST_OK;
}

void sfm_model_release(struct sfm_model *m)
{
    if (!m) return;
    for (int i = 0; i < m->image_count; i++) {
        free(m->images[i].name);
        free(m->images[i].observations);
    }
    for (int i = 0; i < m->point_count; i++) free(m->points[i].track);
    free(m->cameras);
    free(m->images);
    free(m->points);
    *m = (struct sfm_model){0};
}
