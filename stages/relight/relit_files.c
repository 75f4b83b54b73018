/* relit_files.c - see relit_files.h.
 *
 * In the picture of quotients for people, grey means no change, brighter more light, and darker less; a quarter of the
 * scale is a factor of two. White stripes mark pixels whose quotient was bounded. */
#include "stages/relight/relit_files.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/image/image.h"
#include "common/image/photo.h"
#include "common/math/numbers.h"
#include "common/product/product.h"
#include "common/relight/light_quotient.h"
#include "common/texture/exposure.h"
#include "common/texture/picture_record.h"

enum { HATCH = 6 };            /* px: distance of the lines of a hatching */
static const double STOPS = 4; /* from black to white */

static enum status write_ratio(const struct relit *r, const struct view *camera, const char *path,
                               const struct provenance *prov, struct err *err)
{
    static const char *const names[4] = {"R", "G", "B", "A"};
    const size_t n = (size_t)r->width * (size_t)r->height;
    struct exr_image im = {0};
    exr_image_init(&im, r->width, r->height, err);
    for (int k = 0; !err->status && k < 4; k++) exr_add_plane(&im, names[k], k < 3 ? EXR_FLOAT : EXR_HALF, NULL, err);
    for (size_t i = 0; !err->status && i < n; i++)
        for (int k = 0; k < 4; k++) im.planes[k].f[i] = r->quotient[i][k];
    if (!err->status) {
        view_image_set_camera(&im, camera);
        exr_write(&im, path, prov, err);
    }
    exr_image_release(&im);
    return err->status;
}

static enum status draw_ratio(const struct relit *r, const char *path, struct err *err)
{
    const size_t n = (size_t)r->width * (size_t)r->height;
    unsigned char *rgb = malloc(3 * n + 1);
    if (!rgb) return err_nomem(err, "a picture of quotients", 3 * n);
    for (size_t i = 0; i < n; i++) {
        const size_t x = i % (size_t)r->width, y = i / (size_t)r->width;
        const bool hatched = r->quotient[i][3] == RELIT_BOUNDED && (x + y) % HATCH == 0;
        for (int k = 0; k < 3; k++) {
            const double q = (double)r->quotient[i][k];
            const double grey = q > 0 ? 0.5 + log2(q) / STOPS : 0;
            rgb[3 * i + (size_t)k] = hatched ? 255 : (unsigned char)lround(255 * clamp(grey, 0, 1));
        }
        if (r->quotient[i][3] == RELIT_NONE) rgb[3 * i] = rgb[3 * i + 1] = rgb[3 * i + 2] = 40;
    }
    png_write(path, rgb, r->width, r->height, 3, err);
    free(rgb);
    return err->status;
}

struct shares {
    double changed, bounded, none; /* percent of the pixels */
};

static struct shares count(const struct relit *r)
{
    const size_t n = (size_t)r->width * (size_t)r->height;
    struct shares s = {0, 0, 0};
    for (size_t i = 0; i < n; i++) {
        const float *q = r->quotient[i];
        s.changed += q[0] != 1 || q[1] != 1 || q[2] != 1;
        s.bounded += q[3] == RELIT_BOUNDED;
        s.none += q[3] == RELIT_NONE;
    }
    const double scale = 100 / (double)n;
    return (struct shares){scale * s.changed, scale * s.bounded, scale * s.none};
}

static enum status write_record(const struct relit *r, double exposure, const char *path, const struct provenance *prov,
                                struct err *err)
{
    const struct shares s = count(r);
    struct outfile f = {0};
    if (outfile_open(&f, path, err)) return err->status;
    fprintf(f.fp, "%s\n", products[PRODUCT_RELIT_RECORD].head);
    provenance_print(prov, f.fp);
    fprintf(f.fp, "size %d %d\nexposure %.9g\nchanged %.6g\nbounded %.6g\nkept %.6g\nrecords %zu\n", r->width,
            r->height, exposure, s.changed, s.bounded, s.none, r->records);
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

enum status relit_write(const struct relit *r, const struct model_picture *picture, const struct relight_params *params,
                        double unlit, const struct view *camera, const char *out, const char *name,
                        const struct provenance *prov, struct err *err)
{
    const struct product_key key = {.name = name};
    char path[FILE_PATH];
    const double exposure =
        params->exposure > 0 ? params->exposure : exposure_follow(unlit, r->median[0], r->median[1]);
    if (exposure != unlit && !(params->exposure > 0))
        log_note("%s: shown at %+.1f stops, before and after, or the room would be too %s to see", name,
                 log2(exposure / unlit), exposure > unlit ? "dark" : "bright");
    if (!product_path_in(path, out, PRODUCT_RELIT_RATIO, &key, err) && !write_ratio(r, camera, path, prov, err) &&
        !product_path_in(path, out, PRODUCT_RELIT_RATIO_PICTURE, &key, err))
        draw_ratio(r, path, err);
    if (!err->status && !product_path_in(path, out, PRODUCT_RELIT, &key, err) &&
        !model_picture_write(picture, camera, path, prov, err) &&
        !product_path_in(path, out, PRODUCT_RELIT_JPEG, &key, err))
        exposure_write(picture, exposure, path, err);
    if (!err->status && !product_path_in(path, out, PRODUCT_RELIT_RECORD, &key, err))
        write_record(r, exposure, path, prov, err);
    return err->status;
}

enum status relit_read_exposure(double *exposure, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    char *word;
    bool found = false;
    product_open(&t, NULL, PRODUCT_RELIT_RECORD, path, prov, err);
    while (!err->status && !found && textfile_next(&t)) {
        if (textfile_word(&t, "a word", &word, err) || strcmp(word, "exposure") != 0) continue;
        found = true;
        textfile_double(&t, "an exposure", exposure, err);
        if (!err->status && !(*exposure > 0)) textfile_wrong_number(&t, *exposure, "an exposure above 0", err);
    }
    if (!err->status && !found) textfile_error(&t, err, NULL, "a line exposure");
    textfile_release(&t);
    return err->status;
}

enum status relit_changed_write(const struct model_picture *picture, double exposure, const char *out, const char *name,
                                const struct provenance *prov, struct err *err)
{
    const struct product_key key = {.name = name};
    char path[FILE_PATH];
    struct view camera = {.name = name, .width = picture->width, .height = picture->height};
    camera.cam_from_world = mat3_from_quat(picture->pose.rotation);
    camera.translation = picture->pose.translation;
    if (!product_path_in(path, out, PRODUCT_RELIT, &key, err) &&
        !model_picture_write(picture, &camera, path, prov, err) &&
        !product_path_in(path, out, PRODUCT_RELIT_JPEG, &key, err))
        exposure_write(picture, exposure, path, err);
    return err->status;
}
