/* texture_params.c - see texture_params.h. */
#include "common/texture/texture_params.h"

enum status texture_params_check(const struct texture_params *p, struct err *err)
{
    if (p->min_clutter <= p->max_clutter) return ST_OK;
    return err_set(err, ST_USAGE, "min_clutter = %g is above max_clutter = %g.", p->min_clutter, p->max_clutter);
}
