/* given_read.c - reads a depth map that the user provides, and resamples it to a view.
 *
 * A map of the view has the view's field of view, at any scale; each pixel takes the nearest sample. A map of the photo
 * is looked up through the photo's lens, and its depth, along the photo's axis, is converted to the view's. */
#include "stages/segment_depth/given_read.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/textfile.h"
#include "stages/segment_depth/given_map.h"

#define MIN_Z 1e-30 /* depths outside this range are unknown */
#define MAX_Z 1e30

struct depth_map { /* a file's samples as depths */
    const char *path;
    int width, height;
    float *z; /* w * h, 0 unknown; owned */
};

enum status given_units_read(struct given_units *u, const char *path, struct err *err)
{
    struct textfile t = {0};
    char *word = NULL;
    *u = (struct given_units){0};
    textfile_open(&t, path, err);
    while (!err->status && textfile_next(&t)) {
        if (textfile_word(&t, "scale, samples or pixels", &word, err)) break;
        if (!strcmp(word, "scale") && !(u->scale > 0)) {
            textfile_number(&t, "a scale, the depth of a sample of 1", 1e-12, 1e12, &u->scale, err);
        } else if (!strcmp(word, "pixels") && u->pixels == PIXELS_BY_SIZE) {
            textfile_word(&t, "view or photo", &word, err);
            if (!err->status && !strcmp(word, "view"))
                u->pixels = PIXELS_OF_VIEW;
            else if (!err->status && !strcmp(word, "photo"))
                u->pixels = PIXELS_OF_PHOTO;
            else if (!err->status)
                textfile_error(&t, err, word, "view or photo");
        } else if (!strcmp(word, "samples") && u->samples == SAMPLES_UNSAID) {
            textfile_word(&t, "depth or disparity", &word, err);
            if (!err->status && !strcmp(word, "depth"))
                u->samples = SAMPLES_DEPTH;
            else if (!err->status && !strcmp(word, "disparity"))
                u->samples = SAMPLES_DISPARITY;
            else if (!err->status)
                textfile_error(&t, err, word, "depth or disparity");
        } else {
            textfile_error(
                &t, err, word,
                "a line \"scale NUMBER\", \"samples depth|disparity\" or \"pixels view|photo\", each at most "
                "once");
        }
        if (!err->status) textfile_end(&t, err);
    }
    textfile_release(&t);
    if (err->status) *u = (struct given_units){0};
    return err->status;
}

/* Makes depths of the samples: relative disparities stay what they are. */
static enum status take_samples(struct depth_map *m, const struct given_map *from, const struct given_units *units,
                                struct err *err)
{
    const size_t pixels = (size_t)from->width * (size_t)from->height;
    const double scale = units->scale > 0 ? units->scale : 1;
    const bool inverse = units->samples == SAMPLES_DISPARITY && units->scale > 0;
    m->width = from->width;
    m->height = from->height;
    m->z = malloc(pixels * sizeof *m->z);
    if (!m->z) return err_nomem(err, "given depth", pixels * sizeof *m->z);
    for (size_t i = 0; i < pixels; i++) {
        const double sample = from->samples[i], z = inverse ? scale / sample : sample * scale;
        if (sample < 0)
            return err_set(err, ST_DATA,
                           "%s: pixel (%d, %d) has the depth %.9g; wanted z along the camera's axis: positive, or 0 "
                           "where it is unknown.",
                           m->path, (int)(i % (size_t)m->width), (int)(i / (size_t)m->width), sample);
        m->z[i] = z >= MIN_Z && z <= MAX_Z ? (float)z : 0; /* NaN and 0 are unknown */
    }
    return ST_OK;
}

static enum status read_map(struct depth_map *m, const struct given_units *units, const char *folder, bool lone,
                            struct err *err)
{
    struct given_map map = {0};
    if (given_map_read(&map, m->path, err)) return err->status;
    if (lone && map.whole_numbers && !(units->scale > 0) && units->samples == SAMPLES_UNSAID)
        err_set(err, ST_DATA,
                "%s holds whole numbers, which may be depth or disparity; write the line \"samples depth\", if the "
                "greatest are the farthest, or \"samples disparity\" into %s/depth.txt.",
                m->path, folder);
    else if (!lone && map.whole_numbers && !(units->scale > 0) && units->samples != SAMPLES_DISPARITY)
        err_set(err, ST_DATA,
                "%s holds whole numbers of unknown scale; write the line \"scale NUMBER\" into %s/depth.txt, where "
                "NUMBER times a sample is its depth in scene units.",
                m->path, folder);
    if (!err->status && map.sentinels)
        log_note("%s: %d pixels have the value %g, far from all others, which is taken as unknown", m->path,
                 map.sentinels, map.sentinel);
    if (!err->status) take_samples(m, &map, units, err);
    given_map_release(&map);
    return err->status;
}

/* Whether one size is the other, scaled and rounded. */
static bool same_aspect(int w, int h, int width, int height)
{
    const double a = w, b = h, c = width, d = height;
    return fabs(a * d / c - b) < 1 || fabs(b * c / d - a) < 1 || fabs(c * b / a - d) < 1 || fabs(d * a / b - c) < 1;
}

struct map_projection {
    const struct depth_map *map;
    const struct view *view;
    const struct lens *lens; /* NULL: the map is of the view */
    struct mat3 photo_from_view;
};

/* Projects a pixel of the view into the map: coordinates in the map's pixels, and the factor from the map's z to the
 * view's. False if it lies outside. */
static bool map_from_pixel(const struct map_projection *g, int x, int y, double *u, double *v, double *factor)
{
    const struct view *view = g->view;
    *u = (x + 0.5) * g->map->width / view->width;
    *v = (y + 0.5) * g->map->height / view->height;
    *factor = 1;
    if (g->lens) {
        const struct vec3 ray = {(x + 0.5 - view->cx) / view->fx, (y + 0.5 - view->cy) / view->fy, 1};
        const struct vec3 rotated = mat3_apply(g->photo_from_view, ray);
        if (!(rotated.z > 1e-6) || !camera_project(&g->lens->camera, rotated, u, v)) return false;
        *u *= (double)g->map->width / g->lens->camera.width;
        *v *= (double)g->map->height / g->lens->camera.height;
        *factor = 1 / rotated.z;
    }
    return *u >= 0 && *v >= 0 && *u < g->map->width && *v < g->map->height;
}

/* Whether the two interpretations of the map, of the photo and of the view, differ by more than a pixel anywhere. */
static bool lens_matters(const struct map_projection *of_photo)
{
    enum { GRID = 8 };
    struct map_projection of_view = *of_photo;
    of_view.lens = NULL;
    for (int k = 0; k <= GRID; k++)
        for (int i = 0; i <= GRID; i++) {
            const int x = (of_photo->view->width - 1) * i / GRID, y = (of_photo->view->height - 1) * k / GRID;
            double u, v, pu, pv, factor;
            map_from_pixel(&of_view, x, y, &u, &v, &factor);
            if (!map_from_pixel(of_photo, x, y, &pu, &pv, &factor) || hypot(pu - u, pv - v) > 1) return true;
        }
    return false;
}

static enum status choose_projection(struct map_projection *g, const struct depth_map *m, const char *folder,
                                     const struct given_units *units, const struct view *view, const struct lens *lens,
                                     struct err *err)
{
    /* a photo that was divided into several views has no view of its name */
    const struct camera *photo = lens && !strcmp(lens->photo, view->name) ? &lens->camera : NULL;
    const bool as_view = same_aspect(m->width, m->height, view->width, view->height);
    const bool as_photo = photo && same_aspect(m->width, m->height, photo->width, photo->height);
    const bool is_view = m->width == view->width && m->height == view->height;
    const bool is_photo = photo && m->width == photo->width && m->height == photo->height;
    bool of_photo = !is_view && (is_photo || !as_view);
    if (units->pixels != PIXELS_BY_SIZE) of_photo = units->pixels == PIXELS_OF_PHOTO;
    *g = (struct map_projection){m, view, NULL, {{{0}}}};
    if (!(of_photo ? as_photo : as_view)) {
        char sizes[128] = "";
        if (photo) snprintf(sizes, sizeof sizes, ", its photo %d x %d", photo->width, photo->height);
        return err_set(err, ST_DATA,
                       "%s has %d x %d pixels, but view %s has %d x %d%s; wanted %s, or another of the same shape.",
                       m->path, m->width, m->height, view->name, view->width, view->height, sizes,
                       units->pixels == PIXELS_BY_SIZE   ? (photo ? "one of these sizes" : "this size")
                       : units->pixels == PIXELS_OF_VIEW ? "the view's size, as depth.txt says"
                       : photo                           ? "the photo's size, as depth.txt says"
                                                         : "a photo that is one view, as depth.txt says");
    }
    if (!photo) return ST_OK;
    g->lens = lens;
    g->photo_from_view = mat3_transpose(mat3_from_quat(lens->view_from_photo));
    if (units->pixels == PIXELS_BY_SIZE && as_view && as_photo && lens_matters(g))
        log_warn("%s may show the rectified view or the photo with its lens distortion; it is taken as the %s. Write "
                 "the line "
                 "\"pixels view\" or \"pixels photo\" into %s/depth.txt to choose.",
                 m->path, of_photo ? "photo" : "view", folder);
    if (!of_photo) g->lens = NULL;
    return ST_OK;
}

static enum status map_to_view(float **z, const struct map_projection *g, struct err *err)
{
    const struct view *view = g->view;
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    float *to = *z = calloc(pixels, sizeof *to);
    if (!to) return err_nomem(err, "given depth", pixels * sizeof *to);
    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++, to++) {
            double u, v, factor;
            if (!map_from_pixel(g, x, y, &u, &v, &factor)) continue;
            *to = (float)(factor * (double)g->map->z[(size_t)v * (size_t)g->map->width + (size_t)u]);
        }
    return ST_OK;
}

/* Records a file as an input: given/NAMEENDING, the ending in small letters. */
static enum status record(struct provenance *prov, const char *path, const char *name, struct err *err)
{
    char *input = NULL;
    const char *ending = strrchr(path, '.');
    if (asprintf(&input, "given/%s%s", name, ending) < 0) return err_nomem(err, "a file name", strlen(path));
    for (char *p = input + strlen(input) - strlen(ending); *p; p++)
        if (*p >= 'A' && *p <= 'Z') *p = (char)(*p + 'a' - 'A');
    provenance_add_file(prov, input, path, err);
    free(input);
    return err->status;
}

static enum status read_units(struct given_units *u, const char *folder, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    if (file_path(path, folder, "depth", ".txt", err) || !path_is_file(path)) return err->status;
    return record(prov, path, "depth", err) || given_units_read(u, path, err) ? err->status : ST_OK;
}

enum status given_read(struct given *g, const char *folder, const struct view *view, const struct lens *lens, bool lone,
                       struct provenance *prov, struct err *err)
{
    struct given_units units = {0};
    struct depth_map map = {0};
    struct map_projection projection;
    char *path = NULL;
    *g = (struct given){0};
    char above[FILE_PATH];
    if (lone && path_is_file(folder)) { /* one file, beside depth.txt */
        if (!(path = strdup(folder))) return err_nomem(err, "a path", strlen(folder));
        snprintf(above, sizeof above, "%.*s", (int)(path_file_name(path) - path), path);
        folder = *above ? above : ".";
    } else if (given_map_find(&path, folder, view->name, err) || !path) {
        return err->status;
    }
    map.path = path;
    if (!strrchr(path_file_name(path), '.')) {
        err_set(err, ST_DATA, "%s: the name of a depth map must end in .exr, .png, .pfm, .tif or .tiff.", path);
        free(path);
        return err->status;
    }
    if (!record(prov, path, view->name, err) && !read_units(&units, folder, prov, err) &&
        !read_map(&map, &units, folder, lone, err) &&
        !choose_projection(&projection, &map, folder, &units, view, lens, err))
        map_to_view(&g->z, &projection, err);
    g->disparity = units.samples == SAMPLES_DISPARITY;
    g->relative = g->disparity && !(units.scale > 0);
    free(map.z);
    free(path);
    return err->status;
}
