/* morph_frames.h - the frames of a morph as EXR files: R G B A (half, linear), attributes remodel:holes and
 * remodel:unfilled (fractions of the pixels) and remodel:t (0 the first photo, 1 the second). */
#ifndef REMODEL_MORPH_FRAMES_H
#define REMODEL_MORPH_FRAMES_H

#include <stdbool.h>

#include "common/provenance.h"
#include "stages/morph_views/morph_params.h"

/* wanted[i] for frame i + 1 of "1:30,45": ranges and single numbers, from 1 to frame_count. ST_USAGE: anything else. */
enum status morph_frames_select(bool *wanted, int frame_count, const char *list, struct err *err);

/* folder: what morph_prepare wrote. A frame's bytes do not depend on the others that are made with it. */
enum status morph_frames(const char *folder, const char *list, const char *out, const struct morph_params *params,
                         struct provenance *prov, struct err *err);

#endif
