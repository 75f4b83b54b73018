/* page_remodel.h - the page of remodelled rooms, for the people who live in them: each edit before and after. */
#ifndef REMODEL_PAGE_REMODEL_H
#define REMODEL_PAGE_REMODEL_H

#include "stages/report/contents_remodel.h"
#include "stages/report/page_parts.h"

/* Films and exported models are links to files beside it (out/SCENE/remodel). What was not made is a sentence. back:
 * address of the scene's page; NULL: there is none. ST_IO: a plan cannot be read, a picture cannot be written. */
enum status remodel_page_write(struct page *page, const char *scene, const char *back, const struct remodel_contents *c,
                               struct err *err);

#endif
