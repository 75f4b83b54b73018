/* morph_frames.h - the frames of a morph as EXR files.
 *
 * R G B A (half, scene-linear); attributes remodel:holes and remodel:unfilled (fractions of the pixels) and remodel:t
 * (0 is the first photo, 1 the second). */
#ifndef REMODEL_MORPH_FRAMES_H
#define REMODEL_MORPH_FRAMES_H

#include "common/base/provenance.h"
#include "stages/morph_views/morph_params.h"

/* folder: output of morph_prepare. list: frame numbers, such as "1:30,45". Writes out/NNNN.exr; a frame's bytes do not
 * depend on which other frames are rendered. */
enum status morph_frames(const char *folder, const char *list, const char *out, const struct morph_params *params,
                         struct provenance *prov, struct err *err);

#endif
