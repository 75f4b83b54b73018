/* evaluation.h - the products of a scene against the truth and against photographs that were held out: docs/evaluation.md
 * is the protocol. */
#ifndef REMODEL_EVALUATION_H
#define REMODEL_EVALUATION_H

#include "common/base/param.h"
#include "common/base/provenance.h"

#define EVALUATE_PARAMS(X)                                                                                          \
    X(baseline, double, 0, 0, 1e9, "m",                                                                             \
      "distance of the two cameras of a disparity; 0: the median distance of a "                                    \
      "photo's true place to the nearest other one's")                                                              \
    X(disparity_side, int, 1200, 0, 100000, "px", "long side of the picture whose pixels count; 0: the view's own") \
    X(far, double, 1000, 0, 1e30, "m", "true depths beyond it are the sky: taken for unknown")

struct evaluate_params {
    EVALUATE_PARAMS(PARAM_FIELD)
};
#define EVALUATE_PARAMS_DEFAULT        \
    {                                  \
        EVALUATE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param evaluate_param_table[];

/* folder: out/SCENE of one quality or hold-out; shared: the folder of its photo records; truth: NULL if there is none.
 * Writes folder/evaluate/truth/VIEW.exr, folder/evaluate/views.tsv and, last, `out`. */
enum status evaluate(const char *folder, const char *shared, const char *truth, const char *out,
                     const struct evaluate_params *params, struct provenance *prov, struct err *err);

#endif
