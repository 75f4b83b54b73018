/* revealed_error.h - errors of pictures of an edited scene where the edit reveals something: after one gain for each
 * face, because the light that an edit changes is another matter.
 *
 * A pixel is revealed if the true id there differs between the edited and the unedited scene, or its true depth by more
 * than REVEALED_DEPTH. Pixels of the outdoors (id 0) and pixels whose id is unknown do not count. */
#ifndef REMODEL_REVEALED_ERROR_H
#define REMODEL_REVEALED_ERROR_H

#include "stages/evaluate/measure/radiance_error.h"

#define REVEALED_DEPTH 0.02 /* of the depth */

struct true_surface { /* true ids and depths of a picture, before and after the edit */
    const uint32_t *ids[2];
    const float *depths[2];
};

/* Sets mask[i] to 1 where a pixel is revealed; returns their number. */
size_t revealed_find(uint8_t *mask, const struct true_surface *s, size_t count);

/* Sets mask[i] to 1 where a pixel of neither the outdoors nor an unknown id shows the same surface before and after. */
void revealed_kept_find(uint8_t *mask, const struct true_surface *s, size_t count);

/* PSNR over the masked pixels of the picture, whose faces are ids: both clipped at `white` and encoded as sRGB, after
 * the gain of each face that brings its found radiance, clipped, nearest to the true one. clip of p: white. False: no
 * pixel. */
bool revealed_psnr(double *psnr, const struct radiance_pixels *p, const uint32_t *ids);

#endif
