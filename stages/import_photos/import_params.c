/* import_params.c - see import_params.h. */
#include "stages/import_photos/import_params.h"

#define PARAM_STRUCT struct import_params
const struct param import_param_table[] = {IMPORT_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum status import_params_check(const void *params, struct err *err)
{
    const struct import_params *p = params;
    if (!p->split_dark || (!p->split_border && !p->split_gap)) return ST_OK;
    return err_set(err, ST_USAGE,
                   "[import_photos] split_dark = %d finds where pictures end, but split_border = %d and split_gap = %d "
                   "say so, too; leave these two at 0, or split_dark.",
                   p->split_dark, p->split_border, p->split_gap);
}
