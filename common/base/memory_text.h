/* memory_text.h - a text that is written to memory as if to a file, whole or not at all.
 *
 * open_memstream() of the C library does not say when it has no memory: what does not fit is missing, and fclose() may
 * leave no text and still succeed. */
#ifndef REMODEL_MEMORY_TEXT_H
#define REMODEL_MEMORY_TEXT_H

#include <stdio.h>

#include "common/base/err.h"

/* {0} is the empty state. It must stay where it is while `to` is open. */
struct memory_text {
    FILE *to;   /* to write to */
    char *text; /* owned; complete, with a NUL at its end, once it is closed */
    size_t size, room;
};

/* what: for the error, as in err_nomem(). */
enum status memory_text_open(struct memory_text *m, const char *what, struct err *err);
/* ST_NOMEM: something did not fit; the text is empty then. */
enum status memory_text_close(struct memory_text *m, const char *what, struct err *err);
void memory_text_release(struct memory_text *m); /* idempotent */

#endif
