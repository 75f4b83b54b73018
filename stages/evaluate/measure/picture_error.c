/* picture_error.c - see picture_error.h. */
#include "stages/evaluate/measure/picture_error.h"

#include <stdlib.h>

#include "stages/evaluate/measure/flip.h"
#include "stages/evaluate/measure/metrics.h"

/* False, without an error, if no window is wholly in the mask. */
static bool ssim_exists(const uint8_t *a, const uint8_t *b, int width, int height, const uint8_t *mask,
                        uint8_t *windows, double *ssim, struct err *err)
{
    struct err why = ERR_INIT;
    metrics_ssim_windows(windows, mask, width, height);
    metrics_ssim(a, b, width, height, windows, ssim, &why);
    if (why.status && why.status != ST_DATA) err_set(err, why.status, "%s", why.text);
    return !why.status;
}

enum status picture_errors(struct picture_errors *e, const uint8_t *photo, const uint8_t *frame, const uint8_t *inside,
                           const uint8_t *hole, int width, int height, struct err *err)
{
    size_t pixels = (size_t)width * (size_t)height, all = 0, covered = 0;
    uint8_t *mask = malloc(2 * pixels), *windows = mask + pixels;
    *e = (struct picture_errors){0};
    if (!mask) return err_nomem(err, "masks", 2 * pixels);
    for (size_t i = 0; i < pixels; i++) {
        mask[i] = inside[i] && !hole[i];
        all += inside[i] != 0;
        covered += mask[i];
    }
    if (!metrics_psnr(photo, frame, width, height, inside, &e->psnr, err) &&
        !flip_mean(photo, frame, width, height, inside, &e->flip, err)) {
        e->holes = (double)(all - covered) / (double)all;
        e->has_covered = covered > 0;
        e->has_ssim = ssim_exists(photo, frame, width, height, inside, windows, &e->ssim, err);
        e->has_ssim_covered = ssim_exists(photo, frame, width, height, mask, windows, &e->ssim_covered, err);
        if (covered) metrics_psnr(photo, frame, width, height, mask, &e->psnr_covered, err);
    }
    free(mask);
    return err->status;
}
