/* page.h - the two pages of a scene: what was made, for people; and the page of numbers, how it was made and how good
 * it is.
 *
 * They open from a disk, without network access, and follow the light or dark mode of the reader's system. Pictures
 * are files beside them, which a browser loads as they come near; films stay where they are. */
#ifndef REMODEL_PAGE_H
#define REMODEL_PAGE_H

#include "stages/report/page_parts.h"

/* Write errors of page->to are for its owner to check (outfile_commit). numbers, back: the address of the other page.
 * ST_NOMEM; ST_IO: a picture cannot be written. */
enum status page_write(struct page *page, const char *scene, const char *numbers, const struct contents *c,
                       struct err *err);
enum status page_write_numbers(struct page *page, const char *scene, const char *back, const struct contents *c,
                               struct err *err);

#endif
