/* merge_params.h - parameters of hdr_merge. */
#ifndef REMODEL_MERGE_PARAMS_H
#define REMODEL_MERGE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define MERGE_PARAMS(X)                                                                                              \
    X(saturated, double, 0.95, 0.1, 1, "",                                                                           \
      "linear sample value, as a fraction of white, at and above which a sample has weight 0; the weight falls "     \
      "to 0 from 0.8 of it")                                                                                         \
    X(dark, double, 0.001, 0, 0.1, "",                                                                               \
      "linear sample value, as a fraction of white, at and below which a sample has weight 0; the full weight "      \
      "begins at 3 times that")                                                                                      \
    X(noise, choice, "measured", 0, 0, "measured|given",                                                             \
      "noise model that weights the exposures: measured from the differences between the exposures of a view, "      \
      "or given by electrons and read_noise; a view of a single exposure always uses the given noise")               \
    X(electrons, double, 30000, 10, 1e9, "",                                                                         \
      "electrons that a pixel collects at white, for the photon noise; see noise")                                   \
    X(read_noise, double, 6, 0, 1e6, "", "standard deviation of the read noise, in electrons; see noise")            \
    X(align, choice, "correct", 0, 0, "correct|report|no",                                                           \
      "shifts of exposures against the middle one, in whole pixels; correct: found and corrected, report: "          \
      "found and logged, no: ignored")                                                                               \
    X(max_shift, int, 16, 1, 256, "px", "largest shift between neighbouring exposures to search")                    \
    X(max_disagreement, double, 1.5, 1, 1000, "",                                                                    \
      "largest allowed factor between the measured and the stated ratio of two exposures; if it is exceeded, "       \
      "the view fails")                                                                                              \
    X(max_misfit, double, 2, 0.001, 100, "%",                                                                        \
      "largest allowed median distance, after alignment, between the photographs that LRI_SFM and the scene have "   \
      "in common, in percent of their extent; if it is exceeded, the reference image fails")                         \
    X(mark_error, double, 1, 0.01, 100, "px",                                                                        \
      "standard error of a mark in a lighting reference image (scenes/NAME/lri.txt), for the interval of its place") \
    X(max_mark_misfit, double, 2, 0.01, 90, "degrees",                                                               \
      "largest allowed angle between the marks of a lighting reference image and the model's points, seen from the " \
      "pose that fits best (root mean square); if it is exceeded, the image fails")                                  \
    X(outdoors, choice, "match", 0, 0, "match|no",                                                                   \
      "how lighting reference images that are placed in an opening (scenes/NAME/lri.txt, in ... looking out) are "   \
      "turned; match: by what they and photos show outdoors; no: as lri.txt says")                                   \
    X(outdoors_matches, int, 8, 4, 100000, "",                                                                       \
      "number of matches outdoors that must agree with a rotation, or it is not used; more, if so many of them "     \
      "could agree by chance")                                                                                       \
    X(outdoors_error, double, 2, 0.001, 90, "degrees",                                                               \
      "largest standard error of a rotation from matches outdoors with which it is used")                            \
    X(picture, choice, "tone", 0, 0, "tone|middle",                                                                  \
      "picture for structure from motion: the tone-mapped radiance (tone) or the middle exposure (middle)")

struct merge_params {
    MERGE_PARAMS(PARAM_FIELD)
};
#define MERGE_PARAMS_DEFAULT        \
    {                               \
        MERGE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param merge_param_table[];

#endif
