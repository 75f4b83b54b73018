/* page_rooms.h - photographs with a line: before on its left, a chosen change in a chosen light on its right. */
#ifndef REMODEL_PAGE_ROOMS_H
#define REMODEL_PAGE_ROOMS_H

#include "stages/report/contents_rooms.h"
#include "stages/report/page_parts.h"

/* The pictures, each with a list of its changes, which page.js makes a choice of. ST_NOMEM, ST_IO. */
enum status page_rooms(struct page *page, const struct rooms *rooms, struct err *err);
/* A section that says what is photographed and what is guessed, with the meaning of colours, and what could not be
 * read. */
void page_rooms_how(FILE *to, const struct rooms *rooms);

#endif
