/* log.h - words for people, on stderr, each line beginning with the stage's name. */
#ifndef REMODEL_LOG_H
#define REMODEL_LOG_H

#include <stdbool.h>

/* The compiler checks the arguments of a function that takes a printf format. */
#define PRINTF_LIKE(format_arg, first_arg) __attribute__((format(printf, format_arg, first_arg)))

void log_set_name(const char *stage); /* kept by pointer: a string literal */
const char *log_name(void);           /* "remodel" until it is set */
void log_note(const char *fmt, ...) PRINTF_LIKE(1, 2);
void log_warn(const char *fmt, ...) PRINTF_LIKE(1, 2); /* "STAGE: warning: ..." */
void log_line(const char *kind, const char *text);     /* "STAGE: KINDTEXT", in one piece even beside other processes */

/* A line that the next one replaces (progress on a terminal); keep: it stays, and the next one goes below. */
void log_redraw(const char *text, bool keep);

#endif
