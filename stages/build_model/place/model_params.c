/* model_params.c - the table of parameters. */
#include "stages/build_model/place/model_params.h"

#define PARAM_STRUCT struct model_params
const struct param model_param_table[] = {MODEL_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT
