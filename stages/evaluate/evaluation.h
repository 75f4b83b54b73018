/* evaluation.h - metrics of a scene's products against a truth and against held-out photographs. docs/evaluation.md
 * defines them. */
#ifndef REMODEL_EVALUATION_H
#define REMODEL_EVALUATION_H

#include "common/base/provenance.h"
#include "stages/evaluate/scene/evaluate_params.h"

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
