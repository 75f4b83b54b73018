/* plan_context.c - errors of a script's statement. */
#include <stdarg.h>
#include <stdio.h>

#include "stages/build_model/plan/plan_internal.h"

enum status plan_statement_error(struct plan_context *c, const char *fmt, ...)
{
    char text[1500];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    return err_set(c->err, ST_DATA, "%s:%d: %s", c->path, c->s->line, text);
}

enum status plan_statement_for_edits(struct plan_context *c, const char *what)
{
    return plan_statement_error(
        c,
        "\"%s\" is for edits: the unedited model shows the photographs. Write it in a script in the "
        "folder edits.",
        what);
}
