/* sfm_model_colmap.c - COLMAP's text format (https://colmap.github.io/format.html).
 *
 * Images are read before points, so that every entry of a track can be checked, with its line, against the observation
 * that it refers to. Observations that no track lists are found afterwards. */
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/base/sort.h"
#include "common/base/textfile.h"
#include "common/capture/sfm_ids.h"
#include "common/capture/sfm_model_parts.h"
#include "common/capture/sfm_tracks.h"
#include "common/product/product.h"

static bool point_is_below(const void *point, const void *id)
{
    return ((const struct sfm_point *)point)->id < *(const int64_t *)id;
}

static int find_point(const struct sfm_model *m, int64_t id)
{
    const int at = (int)sort_place(m->points, (size_t)m->point_count, sizeof *m->points, point_is_below, &id);
    return at < m->point_count && m->points[at].id == id ? at : -1;
}

/* --------------------------------------------------------------------------------------------------------- reading */

/* A file of a model, which may be of any product, or of none: a user's. */
static enum status open_part(struct textfile *t, const char *path, struct provenance *prov, struct err *err)
{
    return provenance_open(prov, product_name(product_at(path), path), t, path, err);
}

static enum status read_cameras(struct sfm_model *m, struct id_list *ids, const char *path, struct provenance *prov,
                                struct err *err)
{
    struct textfile t = {0};
    open_part(&t, path, prov, err);
    while (!err->status && textfile_next(&t)) {
        struct sfm_camera c = {0};
        struct err why = ERR_INIT;
        int64_t width = 0, height = 0;
        char *model = NULL;
        if (!textfile_int(&t, "camera id", 0, INT64_MAX, &c.id, err)) textfile_word(&t, "camera model", &model, err);
        if (!err->status && !camera_model_from_name(model, &c.camera.model)) {
            char names[256] = "";
            for (int i = 0; i < CAMERA_MODEL_COUNT; i++)
                snprintf(names + strlen(names), sizeof names - strlen(names), " %s",
                         camera_model_name((enum camera_model)i));
            textfile_error(&t, err, model, "one of the supported camera models:%s", names);
        }
        if (!err->status && !textfile_int(&t, "width", 1, INT_MAX, &width, err))
            textfile_int(&t, "height", 1, INT_MAX, &height, err);
        for (int i = 0; !err->status && i < camera_model_params(c.camera.model); i++)
            textfile_double(&t, "camera parameter", &c.camera.params[i], err);
        if (!err->status) textfile_end(&t, err);
        c.camera.width = (int)width;
        c.camera.height = (int)height;
        if (!err->status && camera_check(&c.camera, &why))
            err_set(err, ST_DATA, "%s:%d: camera %" PRId64 ": %s", path, t.line, c.id, why.text);
        if (!err->status && !sfm_append(&m->cameras, m->camera_count, sizeof *m->cameras, "cameras", err) &&
            !id_list_add(ids, c.id, t.line, err))
            m->cameras[m->camera_count++] = c;
    }
    if (!err->status) id_list_sort(ids, path, "camera", err);
    textfile_release(&t);
    return err->status;
}

/* The second line of an image: U V POINT_ID for each feature. It may be blank. */
static enum status read_observations(struct textfile *t, struct sfm_image *im, struct err *err)
{
    while (!err->status && textfile_more(t)) {
        struct sfm_observation o = {0};
        if (!textfile_double(t, "x of an observation", &o.u, err) &&
            !textfile_double(t, "y of an observation", &o.v, err) &&
            !textfile_int(t, "point id (-1: none)", -1, INT64_MAX, &o.point_id, err) &&
            !sfm_append(&im->observations, im->observation_count, sizeof o, "observations", err))
            im->observations[im->observation_count++] = o;
    }
    im->observations = sfm_shrink(im->observations, im->observation_count, sizeof *im->observations);
    return err->status;
}

/* Whether the next line begins another image: some programs leave out the second lines, which would be blank. It has
 * nine numbers and then a name; observations are numbers only. */
static bool next_is_an_image(const struct textfile *t)
{
    size_t length = 0;
    const char *p = textfile_peek(t, &length), *const end = p ? p + length : NULL;
    for (int words = 0; p; words++) {
        char word[64];
        size_t n = 0;
        double value;
        while (p < end && (*p == ' ' || *p == '\t' || *p == '\r')) p++;
        while (p + n < end && p[n] != ' ' && p[n] != '\t' && p[n] != '\r') n++;
        if (n == 0) return false;
        const bool is_long = n >= sizeof word;
        if (!is_long) snprintf(word, sizeof word, "%.*s", (int)n, p);
        const bool is_number = !is_long && scan_double(word, &value);
        if (words == 9 || !is_number) return words == 9 && !is_number;
        p += n;
    }
    return false;
}

/* The two lines of an image; the second may be missing. On failure the caller releases its name and observations. */
static enum status read_image(struct sfm_image *im, struct textfile *t, const struct id_list *cameras, struct err *err)
{
    struct quat *q = &im->cam_from_world.rotation;
    struct vec3 *p = &im->cam_from_world.translation;
    int64_t camera_id = 0;
    char *name = NULL, found[128];
    if (textfile_int(t, "image id", 0, INT64_MAX, &im->id, err) || textfile_double(t, "QW", &q->w, err) ||
        textfile_double(t, "QX", &q->x, err) || textfile_double(t, "QY", &q->y, err) ||
        textfile_double(t, "QZ", &q->z, err) || textfile_double(t, "TX", &p->x, err) ||
        textfile_double(t, "TY", &p->y, err) || textfile_double(t, "TZ", &p->z, err) ||
        textfile_int(t, "camera id", 0, INT64_MAX, &camera_id, err) ||
        textfile_rest(t, "name of the image", &name, err))
        return err->status;
    im->camera_idx = id_list_find(cameras, camera_id);
    if (!sfm_normalize_rotation(q)) {
        snprintf(found, sizeof found, "%.9g %.9g %.9g %.9g", q->w, q->x, q->y, q->z);
        return textfile_error(t, err, found, "a quaternion QW QX QY QZ of length 1");
    }
    if (im->camera_idx < 0) {
        snprintf(found, sizeof found, "camera %" PRId64, camera_id);
        return textfile_error(t, err, found, "the id of a camera in cameras.txt");
    }
    im->name = strdup(name);
    if (!im->name) return err_nomem(err, "a name", strlen(name) + 1);
    return !next_is_an_image(t) && textfile_next_raw(t) ? read_observations(t, im, err) : ST_OK;
}

/* Sorts the images by name; lines and ids follow. lines: of each image in the file. */
static enum status sort_images(struct sfm_model *m, struct id_list *ids, int *lines, const char *path, struct err *err)
{
    int *old_idx = NULL, *old_lines = malloc(((size_t)m->image_count + 1) * sizeof *old_lines);
    if (!old_lines) return err_nomem(err, "images", (size_t)m->image_count * sizeof *old_lines);
    memcpy(old_lines, lines, (size_t)m->image_count * sizeof *lines);
    sfm_sort_images(m, &old_idx, err);
    for (int i = 0; !err->status && i < m->image_count; i++) {
        lines[i] = old_lines[old_idx[i]];
        id_list_row(ids, m->images[i].id)->idx = i;
    }
    for (int i = 1; !err->status && i < m->image_count; i++)
        if (!strcmp(m->images[i - 1].name, m->images[i].name))
            err_set(err, ST_DATA, "%s:%d: found image \"%s\" a second time (first on line %d), wanted each once.", path,
                    lines[i], m->images[i].name, lines[i - 1]);
    free(old_idx);
    free(old_lines);
    return err->status;
}

/* *lines: the line of each image in the file; the caller frees it. */
static enum status read_images(struct sfm_model *m, const struct id_list *cameras, struct id_list *ids, int **lines,
                               const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    open_part(&t, path, prov, err);
    while (!err->status && textfile_next(&t)) {
        struct sfm_image im = {0};
        const int line = t.line;
        if (!read_image(&im, &t, cameras, err) && !id_list_add(ids, im.id, line, err) &&
            !sfm_append(&m->images, m->image_count, sizeof im, "images", err) &&
            !sfm_append(lines, m->image_count, sizeof **lines, "images", err)) {
            (*lines)[m->image_count] = line;
            m->images[m->image_count++] = im;
        } else {
            free(im.name);
            free(im.observations);
        }
    }
    if (!err->status && !m->image_count)
        err_set(err, ST_DATA, "%s contains no image; run structure from motion again.", path);
    if (!err->status && !id_list_sort(ids, path, "image", err)) sort_images(m, ids, *lines, path, err);
    textfile_release(&t);
    return err->status;
}

/* How points3D.txt is read. */
struct point_reader {
    struct textfile file;
    struct track_marks *marks;
    bool given;       /* by a user: what refers to nothing is left out */
    long long *loose; /* entries of tracks that were left out; NULL: not wanted */
    struct sfm_track *track;
    size_t track_capacity;
};

/* One entry of a track. *good: false if it is left out. */
static enum status read_track_entry(struct point_reader *r, int64_t point_id, struct sfm_track *track, bool *good,
                                    struct err *err)
{
    struct textfile *t = &r->file;
    int64_t image_id = 0, observation = 0;
    char found[96];
    if (textfile_int(t, "image id of a track", 0, INT64_MAX, &image_id, err) ||
        textfile_int(t, "observation of a track", 0, INT64_MAX, &observation, err))
        return err->status;
    const enum track_fault fault = track_marks_take(r->marks, image_id, observation, point_id, track);
    *good = fault == TRACK_GOOD;
    if (*good || r->given) {
        if (!*good && r->loose) ++*r->loose;
        return ST_OK;
    }
    if (fault == TRACK_WITHOUT_IMAGE) {
        snprintf(found, sizeof found, "image %" PRId64, image_id);
        return textfile_error(t, err, found, "the id of an image in images.txt");
    }
    snprintf(found, sizeof found, "observation %" PRId64 " of image %" PRId64, observation, image_id);
    if (fault == TRACK_WITHOUT_OBSERVATION)
        return textfile_error(t, err, found, "one of that image's %d observations",
                              r->marks->m->images[track->image_idx].observation_count);
    if (fault == TRACK_OF_OTHER_POINT)
        return textfile_error(t, err, found, "an observation that images.txt assigns to point %" PRId64, point_id);
    return textfile_error(t, err, found, "each observation once");
}

/* A line of points3D.txt. On failure the caller releases p->track. */
static enum status read_point(struct sfm_point *p, struct point_reader *r, struct err *err)
{
    struct textfile *t = &r->file;
    int64_t rgb[3] = {0};
    int count = 0;
    if (textfile_int(t, "point id", 0, INT64_MAX, &p->id, err) || textfile_double(t, "X", &p->position.x, err) ||
        textfile_double(t, "Y", &p->position.y, err) || textfile_double(t, "Z", &p->position.z, err) ||
        textfile_int(t, "R", 0, 255, &rgb[0], err) || textfile_int(t, "G", 0, 255, &rgb[1], err) ||
        textfile_int(t, "B", 0, 255, &rgb[2], err) || textfile_double(t, "reprojection error", &p->error, err))
        return err->status;
    for (int i = 0; i < 3; i++) p->rgb[i] = (uint8_t)rgb[i];
    while (textfile_more(t)) {
        bool good = false;
        if (array_reserve(&r->track, &r->track_capacity, (size_t)count + 1, sizeof *r->track, "track entries", err) ||
            read_track_entry(r, p->id, &r->track[count], &good, err))
            return err->status;
        count += good;
    }
    return sfm_set_track(p, r->track, count, err);
}

/* r->file is closed; the rest of r is set. */
static enum status read_points(struct sfm_model *m, struct point_reader *r, const char *path, struct provenance *prov,
                               struct err *err)
{
    struct textfile *t = &r->file;
    struct id_list ids = {0};
    open_part(t, path, prov, err);
    while (!err->status && textfile_next(t)) {
        struct sfm_point p = {0};
        if (sfm_append(&m->points, m->point_count, sizeof p, "points", err) || read_point(&p, r, err) ||
            id_list_add(&ids, p.id, t->line, err))
            free(p.track);
        else
            m->points[m->point_count++] = p;
    }
    m->points = sfm_shrink(m->points, m->point_count, sizeof *m->points);
    if (!err->status) sfm_sort_points(m, &ids, path, err);
    free(r->track);
    id_list_release(&ids);
    textfile_release(t);
    return err->status;
}

static enum status check_observations(const struct track_marks *t, const int *lines, const char *folder,
                                      struct err *err)
{
    const struct sfm_model *m = t->m;
    for (int i = 0; i < m->image_count; i++)
        for (int k = 0; k < m->images[i].observation_count; k++) {
            int64_t id = m->images[i].observations[k].point_id;
            if (id == -1 || t->listed[i][k]) continue;
            return err_set(err, ST_DATA,
                           "%s/images.txt:%d: found that observation %d (from 0) of image \"%s\" is of point %" PRId64
                           ", wanted %s in points3D.txt.",
                           folder, lines[i] + 1, k, m->images[i].name, id,
                           find_point(m, id) < 0 ? "that point" : "it in that point's track");
        }
    return ST_OK;
}

/* The files have the names of the views', whatever model they are of. */
static enum status model_paths(char of_cameras[FILE_PATH], char of_images[FILE_PATH], const char *folder,
                               struct err *err)
{
    return product_path_in(of_cameras, folder, PRODUCT_CAMERAS, NULL, err) ||
                   product_path_in(of_images, folder, PRODUCT_IMAGES, NULL, err)
               ? err->status
               : ST_OK;
}

/* loose: as in point_reader; points: NULL: the file of points is missing, and observations are of none. */
static enum status read_text(struct sfm_model *m, const char *folder, bool given, const char *points, long long *loose,
                             struct provenance *prov, struct err *err)
{
    struct id_list cameras = {0}, images = {0};
    struct track_marks marks = {0};
    struct point_reader reader = {.marks = &marks, .given = given, .loose = loose};
    int *lines = NULL;
    char of_cameras[FILE_PATH], of_images[FILE_PATH];
    *m = (struct sfm_model){0};
    if (!model_paths(of_cameras, of_images, folder, err) && !read_cameras(m, &cameras, of_cameras, prov, err) &&
        !read_images(m, &cameras, &images, &lines, of_images, prov, err) &&
        !track_marks_make(&marks, m, &images, err) && points)
        read_points(m, &reader, points, prov, err);
    if (!err->status && given)
        track_marks_clear_others(&marks);
    else if (!err->status)
        check_observations(&marks, lines, folder, err);
    track_marks_release(&marks);
    free(lines);
    id_list_release(&cameras);
    id_list_release(&images);
    if (err->status) sfm_model_release(m);
    return err->status;
}

enum status sfm_model_read_text(struct sfm_model *m, const char *folder, struct provenance *prov, struct err *err)
{
    char points[FILE_PATH];
    *m = (struct sfm_model){0};
    if (product_path_in(points, folder, PRODUCT_POINTS3D, NULL, err)) return err->status;
    return read_text(m, folder, false, points, NULL, prov, err);
}

enum status sfm_model_read_given_text(struct sfm_model *m, const char *folder, long long *loose, struct err *err)
{
    char points[FILE_PATH];
    *m = (struct sfm_model){0};
    *loose = 0;
    if (product_path_in(points, folder, PRODUCT_POINTS3D, NULL, err)) return err->status;
    return read_text(m, folder, true, path_is_file(points) ? points : NULL, loose, NULL, err);
}

enum status sfm_model_read_cameras(struct sfm_model *m, const char *folder, struct provenance *prov, struct err *err)
{
    char of_cameras[FILE_PATH], of_images[FILE_PATH];
    *m = (struct sfm_model){0};
    if (model_paths(of_cameras, of_images, folder, err)) return err->status;
    return sfm_model_read_camera_files(m, of_cameras, of_images, prov, err);
}

enum status sfm_model_read_camera_files(struct sfm_model *m, const char *of_cameras, const char *of_images,
                                        struct provenance *prov, struct err *err)
{
    struct id_list cameras = {0}, images = {0};
    int *lines = NULL;
    *m = (struct sfm_model){0};
    read_cameras(m, &cameras, of_cameras, prov, err);
    if (!err->status && of_images) read_images(m, &cameras, &images, &lines, of_images, prov, err);
    for (int i = 0; !err->status && i < m->image_count; i++) {
        free(m->images[i].observations);
        m->images[i].observations = NULL;
        m->images[i].observation_count = 0;
    }
    free(lines);
    id_list_release(&cameras);
    id_list_release(&images);
    if (err->status) sfm_model_release(m);
    return err->status;
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

static enum status write_part(const struct sfm_model *m, const char *folder, enum product_id id,
                              void (*print)(const struct sfm_model *m, FILE *to), const struct provenance *prov,
                              struct err *err)
{
    struct outfile f = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, folder, id, NULL, err)) product_begin(&f, id, path, prov, err);
    if (!err->status) {
        print(m, f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
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
    if (write_part(m, folder, PRODUCT_POINTS3D, print_points, prov, err) ||
        write_part(m, folder, PRODUCT_CAMERAS, print_cameras, prov, err) ||
        write_part(m, folder, PRODUCT_IMAGES, print_images, prov, err))
        return err->status;
    return ST_OK;
}
