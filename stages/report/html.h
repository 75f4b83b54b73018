/* html.h - text and bytes on their way into an HTML page.
 *
 * Nothing that comes from a file name, a log or a parameter reaches the page but through these. */
#ifndef REMODEL_HTML_H
#define REMODEL_HTML_H

#include <stddef.h>
#include <stdio.h>

#include "common/base/err.h"

/* Escaped for text and for quoted attributes: & < > " and '. Bytes that are not UTF-8, and characters HTML does not allow
 * (controls but tab and line feed, noncharacters), become U+FFFD. */
void html_text(FILE *to, const char *text);
void html_bytes(FILE *to, const char *text, size_t size);

/* As printf, then escaped; at most 4095 bytes. */
void html_printf(FILE *to, const char *fmt, ...) PRINTF_LIKE(2, 3);

/* RFC 4648, no line breaks. */
void html_base64(FILE *to, const void *bytes, size_t size);
/* The bytes of a file; its size must not change while it is read. */
enum status html_base64_file(FILE *to, const char *path, struct err *err);

#endif
