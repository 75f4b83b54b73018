/* page_remodel.h - the page of remodelled rooms, for the people who live in them: each edit before and after. */
#ifndef REMODEL_PAGE_REMODEL_H
#define REMODEL_PAGE_REMODEL_H

#include "stages/report/contents_remodel.h"

/* One HTML file, pictures inside; films and exported models are links to files beside it (out/SCENE/remodel). ST_IO: a
 * plan cannot be read. */
enum status remodel_page_write(FILE *to, const char *scene, const struct remodel_contents *c, struct err *err);

#endif
