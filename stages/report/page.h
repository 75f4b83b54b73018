/* page.h - the page: one HTML file without scripts or network access, with its videos, pictures and style inside.
 *
 * It follows the light or dark mode of the reader's system. */
#ifndef REMODEL_PAGE_H
#define REMODEL_PAGE_H

#include "stages/report/contents.h"

/* Write errors of `to` are for its owner to check (outfile_commit). ST_NOMEM; ST_IO: a file to embed cannot be read. */
enum status page_write(FILE *to, const char *scene, const struct contents *c, struct err *err);

#endif
