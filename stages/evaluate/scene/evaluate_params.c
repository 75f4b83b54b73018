/* evaluate_params.c - the table of parameters. */
#include "stages/evaluate/scene/evaluate_params.h"

#define PARAM_STRUCT struct evaluate_params
const struct param evaluate_param_table[] = {EVALUATE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT
