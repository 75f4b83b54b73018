/* exposure.h - the exposure of a picture [Colburn 2014, 4.6]: radiance times exposure is 1 at white. */
#ifndef REMODEL_EXPOSURE_H
#define REMODEL_EXPOSURE_H

#include "common/texture/model_picture.h"

/* The exposure that a camera would have chosen: `saturated` (a fraction) of the pixels that show something are at white
 * or above. 1 if nothing is seen. */
double exposure_choose(const struct model_picture *p, double saturated);

/* The exposure at which a picture whose light has changed still shows its room, given that of the picture before: `was`
 * and `is` are the medians of radiance of its surfaces, before and after. The same one, as long as the median is
 * between EXPOSURE_DIM and EXPOSURE_BRIGHT of white, or no further out than it was before; else the nearest that is, at
 * most EXPOSURE_MOST times as much or as little. */
#define EXPOSURE_DIM    0.05
#define EXPOSURE_BRIGHT 0.6
#define EXPOSURE_MOST   64.0
double exposure_follow(double exposure, double was, double is);

/* Writes the picture as an 8-bit sRGB JPEG or PNG, by the ending of `path`. Pixels of MADE_NOTHING are black. */
enum status exposure_write(const struct model_picture *p, double exposure, const char *path, struct err *err);

/* Writes a film's frame: R G B A half, radiance times exposure, A 0 where MADE_NOTHING; attribute remodel:exposure.
 * camera: scene frame. */
enum status exposure_write_frame(const struct model_picture *p, double exposure, const struct view *camera,
                                 const char *path, const struct provenance *prov, struct err *err);

#endif
