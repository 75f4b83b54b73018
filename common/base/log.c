/* log.c - writes log lines, each with one write(), so that lines of jobs that share a log never mix. */
#include "common/base/log.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char *name = "remodel";
static const char *subject; /* NULL: none */
static bool redrawing;      /* the terminal shows a line that has no line break yet */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

void log_set_name(const char *stage) { name = stage; }
const char *log_name(void) { return name; }
void log_set_subject(const char *of) { subject = of; }

/* Logging never fails the program: a closed or full stderr is ignored. */
static void put(const char *text, size_t size)
{
    while (size) {
        const ssize_t n = write(STDERR_FILENO, text, size);
        if (n <= 0) return;
        text += n;
        size -= (size_t)n;
    }
}

static void put_line(const char *before, const char *kind, const char *text, const char *after)
{
    char line[4096];
    int n = snprintf(line, sizeof line, "%s%s: %s%s%s", before, name, kind, text, after);

    if (n >= (int)sizeof line) n = (int)sizeof line - 1;
    put(line, (size_t)n);
}

void log_line(const char *kind, const char *text)
{
    pthread_mutex_lock(&lock);
    put_line(redrawing ? "\r\033[K" : "", kind, text, "\n");
    redrawing = false;
    pthread_mutex_unlock(&lock);
}

void log_redraw(const char *text, bool keep)
{
    pthread_mutex_lock(&lock);
    put_line("\r\033[K", "", text, keep ? "\n" : "");
    redrawing = !keep;
    pthread_mutex_unlock(&lock);
}

static void put_text(const char *kind, const char *fmt, va_list args)
{
    char text[2048];
    int n = subject ? snprintf(text, sizeof text, "%s: ", subject) : 0;
    if (n >= (int)sizeof text) n = (int)sizeof text - 1;
    vsnprintf(text + n, sizeof text - (size_t)n, fmt, args);
    log_line(kind, text);
}

void log_note(const char *fmt, ...)
{
    va_list args;

    va_start(args, fmt);
    put_text("", fmt, args);
    va_end(args);
}

void log_warn(const char *fmt, ...)
{
    va_list args;

    va_start(args, fmt);
    put_text("warning: ", fmt, args);
    va_end(args);
}
