/* linear_picture.c - see linear_picture.h.
 *
 * A true picture is resampled into the picture's camera: the centre of a pixel becomes a ray, turned into the axes of
 * the true camera and projected by its lens. Radiance is interpolated linearly between the four nearest pixels, whose
 * centres are half a pixel from the corners; ids and other labels are those of the pixel that contains the point. */
#include "stages/evaluate/truth/linear_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/image/exr.h"
#include "common/image/photo.h"

enum { ROWS = 8 };

static const char *const endings[] = {".exr", ".png", ".jpg", ".tif"};

bool linear_picture_find(char path[FILE_PATH], const char *folder, const char *name)
{
    for (size_t k = 0; k < sizeof endings / sizeof *endings; k++) {
        const int n = snprintf(path, FILE_PATH, "%s/%s%s", folder, name, endings[k]);
        if (n > 0 && n < FILE_PATH && path_is_file(path)) return true;
    }
    return false;
}

static enum status read_exr(struct linear_picture *p, const char *path, struct err *err)
{
    static const char *const names[3] = {"R", "G", "B"};
    struct exr_image im = {0};
    if (!exr_read(&im, path, NULL, 0, err)) image_init(&p->rgb, im.width, im.height, 3, err);
    const size_t pixels = err->status ? 0 : (size_t)im.width * (size_t)im.height;
    for (size_t c = 0; !err->status && c < 3; c++) {
        const struct exr_plane *plane = exr_find(&im, names[c]);
        if (!plane || !plane->f)
            err_set(err, ST_DATA, "%s: found no channel %s of half or float, wanted scene-linear R G B.", path,
                    names[c]);
        for (size_t i = 0; !err->status && i < pixels; i++) p->rgb.data[3 * i + c] = plane->f[i];
    }
    if (!err->status && (!(p->hole = calloc(pixels, 1)) || !(p->known = malloc(pixels))))
        err_nomem(err, "masks", 2 * pixels);
    if (!err->status) memset(p->known, 1, pixels);
    const struct exr_plane *hole = err->status ? NULL : exr_find(&im, "hole"),
                           *a = err->status ? NULL : exr_find(&im, "A");
    const struct exr_plane *clipped = err->status ? NULL : exr_find(&im, "clipped");
    const char *radiometry = err->status ? NULL : exr_attribute(&im, "remodel:radiometry");
    const bool saturates = radiometry && strcmp(radiometry, "exact");
    for (size_t i = 0; i < pixels; i++) {
        const float *c = p->rgb.data + 3 * i;
        if (hole && hole->f) p->hole[i] = hole->f[i] > 0.5f;
        if (a && a->f && !(a->f[i] > 0)) p->known[i] = 0;
        if (clipped && (clipped->u ? clipped->u[i] & 1 : (int)clipped->f[i] & 1)) p->known[i] = 0;
        if (saturates && fmaxf(c[0], fmaxf(c[1], c[2])) >= 0.98f) p->known[i] = 0;
    }
    exr_image_release(&im);
    return err->status;
}

static enum status read_encoded(struct linear_picture *p, const char *path, struct err *err)
{
    struct photo photo = {0};
    if (!photo_read(&photo, path, err)) photo_to_linear(&p->rgb, &photo, err);
    const size_t pixels = err->status ? 0 : (size_t)p->rgb.width * (size_t)p->rgb.height;
    if (!err->status && (!(p->hole = calloc(pixels, 1)) || !(p->known = malloc(pixels))))
        err_nomem(err, "masks", 2 * pixels);
    if (!err->status) memset(p->known, 1, pixels);
    p->encoded = true;
    photo_release(&photo);
    return err->status;
}

enum status linear_picture_read(struct linear_picture *p, const char *path, struct err *err)
{
    const char *dot = strrchr(path, '.');
    *p = (struct linear_picture){0};
    return dot && !strcmp(dot, ".exr") ? read_exr(p, path, err) : read_encoded(p, path, err);
}

void linear_picture_release(struct linear_picture *p)
{
    image_release(&p->rgb);
    free(p->hole);
    free(p->known);
    *p = (struct linear_picture){0};
}

/* ------------------------------------------------------------------------------------------------------- resampling */

/* Where pixel (x, y) of the picture lies in a true picture of width x height; false: outside. */
static bool true_point(const struct picture_map *map, int x, int y, int width, int height, double *u, double *v)
{
    struct vec3 ray;
    if (!camera_unproject(&map->lens, x + 0.5, y + 0.5, &ray)) return false;
    if (!camera_project(&map->true_lens, mat3_apply(map->true_from_picture, ray), u, v)) return false;
    *u *= (double)width / map->true_lens.width;
    *v *= (double)height / map->true_lens.height;
    return *u >= 0 && *v >= 0 && *u <= width && *v <= height;
}

struct seen_job {
    const struct picture_map *map;
    const struct image *truth;
    struct image *out;
    int32_t *index;
    int width, height; /* of the truth */
};

static void interpolate(float to[4], const struct image *from, double u, double v)
{
    const double x = fmin(fmax(u - 0.5, 0), from->width - 1), y = fmin(fmax(v - 0.5, 0), from->height - 1);
    const int x0 = (int)x, y0 = (int)y;
    const int x1 = x0 + 1 < from->width ? x0 + 1 : x0, y1 = y0 + 1 < from->height ? y0 + 1 : y0;
    const double a = x - x0, b = y - y0;
    for (int c = 0; c < 3; c++) {
        const double top = (1 - a) * image_at(from, x0, y0)[c] + a * image_at(from, x1, y0)[c];
        const double bottom = (1 - a) * image_at(from, x0, y1)[c] + a * image_at(from, x1, y1)[c];
        to[c] = (float)((1 - b) * top + b * bottom);
    }
    to[3] = 1;
}

static void seen_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct seen_job *job = ctx;
    const int width = job->map->lens.width;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < width; x++) {
            double u, v;
            const bool inside = true_point(job->map, x, y, job->width, job->height, &u, &v);
            if (job->out && inside) interpolate(image_at(job->out, x, y), job->truth, u, v);
            if (!job->index) continue;
            const int i = inside ? (int)fmin(u, job->width - 1) : 0, j = inside ? (int)fmin(v, job->height - 1) : 0;
            job->index[(size_t)y * (size_t)width + (size_t)x] = inside ? j * job->width + i : -1;
        }
}

enum status picture_of_truth(struct image *out, const struct image *truth, const struct picture_map *map,
                             struct err *err)
{
    struct seen_job job = {map, truth, out, NULL, truth->width, truth->height};
    if (image_init(out, map->lens.width, map->lens.height, 4, err)) return err->status;
    parallel_for((size_t)map->lens.height, ROWS, seen_rows, &job);
    return ST_OK;
}

void picture_true_pixels(int32_t *index, int width, int height, const struct picture_map *map)
{
    struct seen_job job = {map, NULL, NULL, index, width, height};
    parallel_for((size_t)map->lens.height, ROWS, seen_rows, &job);
}
