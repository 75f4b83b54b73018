/* metric_rows.h - what `evaluate` measured: metrics.tsv of a scene, evaluate/views.tsv of its views.
 *
 * Lines "NAME VALUE UNIT DIRECTION", in a table of views with the view's name before them. Of the comments those that
 * begin with "skipped" or "note:" are for people. */
#ifndef REMODEL_METRIC_ROWS_H
#define REMODEL_METRIC_ROWS_H

#include <stdbool.h>

#include "common/base/err.h"

struct metric_row {
    char *view; /* owned; "" for the scene's */
    char name[64], unit[16], direction[16];
    double value;
};

struct metric_rows {
    struct metric_row *rows;
    char **notes; /* owned */
    int count, note_count;
};

/* ST_DATA with file and line: a line that is none of these. */
enum status metric_rows_read(struct metric_rows *r, const char *path, bool of_views, struct err *err);
const struct metric_row *metric_rows_find(const struct metric_rows *r, const char *view,
                                          const char *name); /* or NULL */
void metric_rows_release(struct metric_rows *r);

#endif
