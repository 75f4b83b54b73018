/* merge_params.h - the stage's parameters. */
#ifndef REMODEL_MERGE_PARAMS_H
#define REMODEL_MERGE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define MERGE_PARAMS(X)                                                                                               \
    X(saturated, double, 0.95, 0.1, 1, "",                                                                            \
      "part of white, linear, from which a sample counts for nothing; less counts "                                   \
      "fully below 0.8 of it")                                                                                        \
    X(dark, double, 0.001, 0, 0.1, "",                                                                                \
      "part of white, linear, up to which a sample counts for nothing; more counts "                                  \
      "fully above 3 of it")                                                                                          \
    X(noise, choice, "measured", 0, 0, "measured|given",                                                              \
      "what weighs the exposures: noise as the exposures of a view differ, or electrons and read_noise; of a single " \
      "exposure these in any case")                                                                                   \
    X(electrons, double, 30000, 10, 1e9, "", "that a pixel collects at white: photon noise; see noise")               \
    X(read_noise, double, 6, 0, 1e6, "", "electrons, standard deviation, where there is no light; see noise")         \
    X(align, choice, "correct", 0, 0, "correct|report|no",                                                            \
      "exposures that are shifted against the middle one are moved by whole pixels, or only told")                    \
    X(most_shift, int, 16, 1, 256, "px", "shifts that are looked for")                                                \
    X(most_disagreement, double, 1.5, 1, 1000, "",                                                                    \
      "exposures that seem to have had so many times more or less light than is stated are refused")                  \
    X(picture, choice, "tone", 0, 0, "tone|middle",                                                                   \
      "what structure from motion sees: the radiance with its dark and bright parts brought together, or the middle " \
      "exposure")

struct merge_params {
    MERGE_PARAMS(PARAM_FIELD)
};
#define MERGE_PARAMS_DEFAULT        \
    {                               \
        MERGE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param merge_param_table[];

#endif
