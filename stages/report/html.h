/* html.h - text and bytes in an HTML page.
 *
 * Every text from a file name, a log or a parameter must be written with these. */
#ifndef REMODEL_HTML_H
#define REMODEL_HTML_H

#include <stddef.h>
#include <stdio.h>

#include "common/base/err.h"

/* Escapes & < > " and ', for text and for quoted attributes. Bytes that are not UTF-8, and characters that HTML does
 * not allow (controls except tab and line feed, noncharacters), become U+FFFD. */
void html_text(FILE *to, const char *text);
void html_bytes(FILE *to, const char *text, size_t size);

/* Formats as printf, cuts at 4095 bytes, then escapes. */
void html_printf(FILE *to, const char *fmt, ...) PRINTF_LIKE(2, 3);

/* A path as a relative address, in a quoted attribute: bytes other than letters, digits and -._~@/ become %XX. */
void html_address(FILE *to, const char *path);

#endif
