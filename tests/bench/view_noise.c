/* view_noise.c - how often the noise that views state covers their errors, for developers.
 *
 *   view_noise PICTURE TRUTH.exr [VIEWS PHOTO]
 *
 * PICTURE is a file of S/hdr, or a JPEG or PNG photo, whose noise is that of rectify's defaults. TRUTH is the radiance
 * of the same photo without noise, in any unit; VIEWS is a folder O/views. Prints, for the photo and for its views,
 * resampled from both files: "withinK S", the share in percent of the pixels
 * whose luminance is at most K stated standard deviations from the truth (68.3, 95.4 and 99.7 for normal errors);
 * "spread F", the factor by which the stated deviations would have to be multiplied so that 68.3 % lie within one; and
 * "pixels N", the number of pixels, without marked ones. The unit of the truth is the median of the ratios. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/sort.h"
#include "common/capture/lens_list.h"
#include "common/capture/photo_quality.h"
#include "common/image/luminance.h"
#include "stages/rectify/rectify_params.h"
#include "stages/rectify/resample.h"

struct pictures { /* a photo, or a view of it */
    struct image measured, truth;
    struct photo_quality quality;
    int channels;
};

static void pictures_release(struct pictures *p)
{
    image_release(&p->measured);
    image_release(&p->truth);
    photo_quality_release(&p->quality);
}

static enum status read_photo(struct pictures *p, const char *path, struct err *err)
{
    const struct rectify_params params = RECTIFY_PARAMS_DEFAULT;
    const struct single_exposure assumed = {params.electrons, params.read_noise, params.saturated, params.dark};
    struct photo photo = {0};
    if (!photo_read(&photo, path, err) && !photo_to_linear(&p->measured, &photo, err))
        photo_quality_of_exposure(&p->quality, &photo, &p->measured, &assumed, err);
    photo_release(&photo);
    return err->status;
}

static enum status read_colour(struct image *to, struct photo_quality *quality, const char *path, struct err *err)
{
    static const char *const names[] = {"R", "G", "B", "clipped", "variance"};
    struct exr_image exr = {0};
    if (!exr_read(&exr, path, names, quality ? 5 : 3, err)) image_init(to, exr.width, exr.height, 3, err);
    for (size_t c = 0; !err->status && c < 3; c++) {
        const float *from = exr_find(&exr, names[c])->f;
        for (size_t i = 0; i < (size_t)exr.width * (size_t)exr.height; i++) to->data[3 * i + c] = fmaxf(from[i], 0);
    }
    if (!err->status && quality) photo_quality_of_merged(quality, &exr, path, to, err);
    exr_image_release(&exr);
    return err->status;
}

/* Lists truth / measured, or abs(measured - unit truth) / sigma if unit > 0, of the unmarked pixels; returns their
 * number. */
static size_t list(float *to, const struct pictures *p, double unit)
{
    size_t count = 0;
    for (size_t i = 0; i < (size_t)p->measured.width * (size_t)p->measured.height; i++) {
        const float *v = p->measured.data + i * (size_t)p->channels, *t = p->truth.data + i * (size_t)p->channels;
        const double light = (double)luminance_of(v), truth = (double)luminance_of(t);
        if (p->quality.marks[i] || !(light > 0) || !(truth > 0) || !(p->quality.variance[i] > 0)) continue;
        to[count++] =
            (float)(unit > 0 ? fabs(light - unit * truth) / sqrt((double)p->quality.variance[i]) : light / truth);
    }
    sort_floats(to, count);
    return count;
}

static enum status report(const struct pictures *p, const char *name, double *unit, struct err *err)
{
    const size_t pixels = (size_t)p->measured.width * (size_t)p->measured.height;
    float *values = malloc((pixels + 1) * sizeof *values);
    if (!values) return err_nomem(err, "errors", pixels * sizeof *values);
    size_t count = list(values, p, 0), within[3] = {0};
    if (!*unit && count) *unit = (double)values[count / 2];
    count = list(values, p, *unit);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) within[k] += values[i] <= (float)(k + 1);
    printf("%s", name);
    for (int k = 0; k < 3 && count; k++) printf(" within%d %.2f", k + 1, 100 * (double)within[k] / (double)count);
    if (count) printf(" spread %.3f", (double)values[(size_t)(0.6827 * (double)count)]);
    printf(" pixels %zu\n", count);
    free(values);
    return ST_OK;
}

static enum status report_views(const struct pictures *photo, const char *folder, const char *id, double unit,
                                struct err *err)
{
    struct camera_set set = {0};
    struct lens_list lenses = {0};
    char path[FILE_PATH];
    if (!file_path(path, folder, "lenses.txt", "", err) && !camera_set_read(&set, folder, NULL, err))
        lens_list_read(&lenses, path, NULL, err);
    for (int l = 0; !err->status && l < lenses.count; l++) {
        const struct lens *lens = &lenses.lenses[l];
        const int v = camera_set_find(&set, lens->view);
        if (v < 0 || strcmp(lens->photo, id)) continue;
        const struct mat3 turn = mat3_transpose(mat3_from_quat(lens->view_from_photo));
        const struct resample_source measured = {.linear = &photo->measured, .quality = &photo->quality};
        const struct resample_source truth = {.linear = &photo->truth};
        struct pictures p = {.channels = 4};
        if (!resample_photo(&p.measured, &p.quality, &measured, &lens->camera, &turn, &set.views[v], err) &&
            !resample_photo(&p.truth, NULL, &truth, &lens->camera, &turn, &set.views[v], err))
            report(&p, lens->view, &unit, err);
        pictures_release(&p);
    }
    lens_list_release(&lenses);
    camera_set_release(&set);
    return err->status;
}

static bool is_exr(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcmp(dot, ".exr");
}

int main(int argc, char **argv)
{
    struct err err = ERR_INIT;
    struct pictures photo = {.channels = 3};
    double unit = 0;
    log_set_name("view_noise");
    if (argc != 3 && argc != 5) {
        err_set(&err, ST_USAGE, "found %d arguments, wanted PICTURE TRUTH or PICTURE TRUTH VIEWS PHOTO.", argc - 1);
    } else if (!(is_exr(argv[1]) ? read_colour(&photo.measured, &photo.quality, argv[1], &err)
                                 : read_photo(&photo, argv[1], &err)) &&
               !read_colour(&photo.truth, NULL, argv[2], &err)) {
        if (photo.measured.width != photo.truth.width || photo.measured.height != photo.truth.height)
            err_set(&err, ST_DATA, "%s and %s have different sizes; give pictures of one photo.", argv[1], argv[2]);
        else if (!report(&photo, "photo", &unit, &err) && argc == 5)
            report_views(&photo, argv[3], argv[4], unit, &err);
    }
    pictures_release(&photo);
    err_report(&err);
    return err_exit_code(&err);
}
