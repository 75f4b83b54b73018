/* evaluation.h - metrics of a scene's products against a truth and against held-out photographs. docs/evaluation.md
 * defines them. */
#ifndef REMODEL_EVALUATION_H
#define REMODEL_EVALUATION_H

#include "common/base/param.h"
#include "common/base/provenance.h"

#define EVALUATE_PARAMS(X)                                                                                      \
    X(baseline, double, 0, 0, 1e9, "m",                                                                         \
      "baseline of disparities; 0: the median over the photos of the true distance to the nearest other one")   \
    X(disparity_side, int, 1200, 0, 100000, "px",                                                               \
      "long side of the picture in whose pixels disparity is measured; 0: the view's own")                      \
    X(far, double, 1000, 0, 1e30, "m", "maximum true depth; greater ones are sky and count as unknown")         \
    X(white, double, 0, 0, 1e9, "",                                                                             \
      "true radiance that is white where pictures are compared in 8 bits; 0: that of the value 1 in the views") \
    X(max_offset, double, 0.1, 0, 1e9, "m",                                                                     \
      "maximum distance of a rendered picture's camera from the true one; pictures farther away are skipped")   \
    X(surface_distance, double, 0.05, 0, 1e9, "m",                                                              \
      "maximum distance of a true point from a face of the model that it counts as lying on")

struct evaluate_params {
    EVALUATE_PARAMS(PARAM_FIELD)
};
#define EVALUATE_PARAMS_DEFAULT        \
    {                                  \
        EVALUATE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param evaluate_param_table[];

struct evaluate_inputs {
    const char *folder;   /* out/SCENE of one quality or hold-out */
    const char *shared;   /* the folder of its photo records */
    const char *truth;    /* NULL: there is none */
    const char *rendered; /* rendered pictures; NULL: folder/rendered */
};

/* Writes folder/evaluate/truth/VIEW.exr, folder/evaluate/cameras, folder/evaluate/views.tsv and, last, `out`. */
enum status evaluate(const struct evaluate_inputs *from, const char *out, const struct evaluate_params *params,
                     struct provenance *prov, struct err *err);

#endif
