/* exposure.c - exposures of pictures, and pictures of 8 bits; see exposure.h.
 *
 * A camera exposes so that few pixels are saturated. Saturated is a pixel of which a channel is: so the largest channel
 * of each pixel counts, and the exposure is one over the (1 - saturated) quantile of these. */
#include "stages/render_model/exposure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/image/photo.h"

enum { QUALITY = 92 };

double exposure_choose(const struct model_picture *p, double saturated)
{
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    float *largest = malloc((pixels + 1) * sizeof *largest);
    size_t count = 0;
    if (!largest) return 1;
    for (size_t i = 0; i < pixels; i++) {
        const float *rgb = p->rgb + 3 * i;
        const float most = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
        if (p->made[i] != MADE_NOTHING && most > 0) largest[count++] = most;
    }
    double exposure = 1;
    if (count) {
        const size_t rank = (size_t)fmin((double)count - 1, floor((1 - saturated) * (double)count));
        sort_floats(largest, count);
        exposure = 1 / (double)largest[rank];
    }
    free(largest);
    return exposure;
}

enum status exposure_write(const struct model_picture *p, double exposure, const char *path, struct err *err)
{
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    const size_t length = strlen(path);
    const bool png = length > 4 && !strcmp(path + length - 4, ".png");
    struct image shown = {0};
    unsigned char *bytes = malloc(3 * pixels + 1);
    enum status st =
        bytes ? image_init(&shown, p->width, p->height, 3, err) : err_nomem(err, "a picture of 8 bits", 3 * pixels);
    for (size_t i = 0; !st && i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            shown.data[3 * i + c] = p->made[i] == MADE_NOTHING ? 0 : (float)(exposure * p->rgb[3 * i + c]);
    if (!st) image_to_srgb8(&shown, bytes);
    if (!st)
        st = png ? png_write(path, bytes, p->width, p->height, 3, err)
                 : jpeg_write(path, bytes, p->width, p->height, QUALITY, err);
    image_release(&shown);
    free(bytes);
    return st;
}
