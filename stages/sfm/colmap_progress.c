/* colmap_progress.c - follows a log that COLMAP is writing.
 *
 * The log is opened anew at each tick, because COLMAP may not have made it yet. */
#include "stages/sfm/colmap_progress.h"

#include <stdlib.h>
#include <string.h>

void colmap_progress_start(struct colmap_progress *p, struct progress *progress, const char *path, const char *mark,
                           bool numbered)
{
    *p = (struct colmap_progress){.progress = progress, .path = path, .mark = mark, .numbered = numbered};
    FILE *log = fopen(path, "rb");
    if (log && !fseek(log, 0, SEEK_END)) p->read = ftell(log);
    if (log) fclose(log);
}

static void count_line(struct colmap_progress *p, const char *line)
{
    const char *at = strstr(line, p->mark), *number = at ? strchr(at, '(') : NULL;
    const long long before = p->count;
    if (!at) return;
    if (!p->numbered)
        p->count++;
    else if (number && strtoll(number + 1, NULL, 10) > p->count)
        p->count = strtoll(number + 1, NULL, 10);
    progress_add(p->progress, p->count - before);
}

void colmap_progress_tick(void *ctx)
{
    struct colmap_progress *p = ctx;
    FILE *log = fopen(p->path, "rb");
    char *line = NULL;
    size_t size = 0;
    ssize_t n;
    if (log && !fseek(log, p->read, SEEK_SET))
        while ((n = getline(&line, &size, log)) > 0 && line[n - 1] == '\n') {
            p->read += (long)n;
            count_line(p, line);
        }
    free(line);
    if (log) fclose(log);
}
