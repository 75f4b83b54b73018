/* import_params.c - the stage's parameters and their check. */
#include "stages/import_photos/import_params.h"

#define PARAM_STRUCT struct photo_params
const struct param photo_param_table[] = {PHOTO_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum status photo_params_check(const void *params, struct err *err)
{
    const struct photo_params *p = params;
    if (!p->split_dark || (!p->split_border && !p->split_gap)) return ST_OK;
    return err_set(
        err, ST_USAGE,
        "[import_photos] split_dark = %d finds the borders of pictures, but split_border = %d and split_gap = "
        "%d state them; leave these two at 0, or split_dark.",
        p->split_dark, p->split_border, p->split_gap);
}
