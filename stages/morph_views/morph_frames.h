/* morph_frames.h - the frames of a morph as EXR files: R G B A (half, linear), attributes remodel:holes and
 * remodel:unfilled (fractions of the pixels) and remodel:t (0 the first photo, 1 the second). */
#ifndef REMODEL_MORPH_FRAMES_H
#define REMODEL_MORPH_FRAMES_H

#include "common/base/provenance.h"
#include "stages/morph_views/morph_params.h"

/* folder: what morph_prepare wrote. A frame's bytes do not depend on the others that are made with it. */
enum status morph_frames(const char *folder, const char *list, const char *out, const struct morph_params *params,
                         struct provenance *prov, struct err *err);

#endif
