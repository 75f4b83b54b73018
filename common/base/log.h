/* log.h - log lines on stderr; each begins with the stage's name. */
#ifndef REMODEL_LOG_H
#define REMODEL_LOG_H

#include <stdbool.h>

/* Lets the compiler check arguments against a printf format. */
#define PRINTF_LIKE(format_arg, first_arg) __attribute__((format(printf, format_arg, first_arg)))

void log_set_name(const char *stage); /* the pointer is kept: give a string literal */
const char *log_name(void);           /* "remodel" until set */
/* What notes and warnings are about from now on: "STAGE: SUBJECT: ..."; NULL: nothing. The pointer is kept. */
void log_set_subject(const char *subject);
void log_note(const char *fmt, ...) PRINTF_LIKE(1, 2);
void log_warn(const char *fmt, ...) PRINTF_LIKE(1, 2); /* "STAGE: warning: ..." */
void log_line(const char *kind, const char *text);     /* "STAGE: KINDTEXT"; atomic between processes */

/* A progress line on a terminal. The next line replaces it, unless keep is set. */
void log_redraw(const char *text, bool keep);

#endif
