/* err.c - sets and reports errors. */
#include "common/base/err.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"

#ifdef __clang_analyzer__
#undef err_set
#undef err_errno
#undef err_nomem
#endif

/* Truncated text ends in "...", so that it does not look complete. */
static void mark_cut(char *text, size_t size, int length)
{
    if (length >= (int)size) strcpy(text + size - 4, "...");
}

enum status err_set(struct err *err, enum status status, const char *fmt, ...)
{
    va_list args;

    if (!err) return status;
    if (err->status) return err->status;
    err->status = status;
    va_start(args, fmt);
    mark_cut(err->text, sizeof err->text, vsnprintf(err->text, sizeof err->text, fmt, args));
    va_end(args);
    return status;
}

enum status err_errno(struct err *err, const char *verb, const char *path)
{
    return err_set(err, ST_IO, "cannot %s %s: %s.", verb, path, strerror(errno));
}

enum status err_nomem(struct err *err, const char *what, size_t bytes)
{
    return err_set(err, ST_NOMEM, "not enough memory for %s (%zu bytes).", what, bytes);
}

enum status err_context(struct err *err, const char *fmt, ...)
{
    struct err old;
    va_list args;

    if (!err || !err->status) return err ? err->status : ST_OK;
    old = *err;
    va_start(args, fmt);
    vsnprintf(err->text, sizeof err->text, fmt, args);
    va_end(args);
    const size_t n = strlen(err->text), room = sizeof err->text - n;
    mark_cut(err->text + n, room, snprintf(err->text + n, room, ": %s", old.text));
    return err->status;
}

void err_report(const struct err *err)
{
    if (err && err->status) log_line("error: ", err->text);
}

int err_exit_code(const struct err *err)
{
    if (!err || !err->status) return 0;
    return err->status == ST_USAGE ? 2 : 1;
}
