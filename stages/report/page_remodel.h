/* page_remodel.h - the page of remodelled rooms, for the people who live in them: each edit before and after. */
#ifndef REMODEL_PAGE_REMODEL_H
#define REMODEL_PAGE_REMODEL_H

#include "stages/report/contents_remodel.h"

/* One HTML file, pictures inside; films and exported models are links to files beside it (out/SCENE/remodel). What was
 * not made is a sentence. back: address of the scene's page; NULL: there is none. ST_IO: a plan cannot be read. */
enum status remodel_page_write(FILE *to, const char *scene, const char *back, const struct remodel_contents *c,
                               struct err *err);

#endif
