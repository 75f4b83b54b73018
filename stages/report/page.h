/* page.h - the page itself: one HTML file that needs nothing else, no network, no script.
 *
 * The video, the pictures and the style are inside it; light or dark as the reader's system asks. */
#ifndef REMODEL_PAGE_H
#define REMODEL_PAGE_H

#include "stages/report/contents.h"

/* Write errors of `to` are left to its owner (outfile_commit). ST_NOMEM, or ST_IO if a video cannot be read. */
enum status page_write(FILE *to, const char *scene, const struct contents *c, struct err *err);

#endif
