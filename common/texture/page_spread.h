/* page_spread.h - colours of an atlas's page spread over texels that are missing. */
#ifndef REMODEL_PAGE_SPREAD_H
#define REMODEL_PAGE_SPREAD_H

#include "common/texture/atlas.h"

/* In the tile's rectangle of its page, missing texels get the colour of the nearest one of the tile; what the texels
 * come from stays. A tile without texels stays as it is. */
enum status page_spread(struct atlas_page *page, const struct atlas_tile *t, struct err *err);

#endif
