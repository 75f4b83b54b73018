/* metric_rows.h - the metrics that `evaluate` wrote: metrics.tsv of a scene, evaluate/views.tsv of its views.
 *
 * A line is "NAME VALUE UNIT DIRECTION"; in views.tsv the name of the view comes first. Comments that begin with
 * "skipped" or "note:" are kept for the page. */
#ifndef REMODEL_METRIC_ROWS_H
#define REMODEL_METRIC_ROWS_H

#include <stdbool.h>

#include "common/base/err.h"

struct metric_row {
    char *view; /* owned; "" for the scene */
    char name[96], unit[16], direction[16];
    double value;
};

struct metric_rows {
    struct metric_row *rows;
    char **notes; /* owned */
    int count, note_count;
};

/* r is overwritten, and empty after an error. ST_DATA with file and line: a line of another form. */
enum status metric_rows_read(struct metric_rows *r, const char *path, bool of_views, struct err *err);
const struct metric_row *metric_rows_find(const struct metric_rows *r, const char *view,
                                          const char *name); /* or NULL */
void metric_rows_release(struct metric_rows *r);

#endif
