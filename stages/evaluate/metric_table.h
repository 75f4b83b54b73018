/* metric_table.h - named values on their way into metrics.tsv and evaluate/views.tsv, and the reasons for what is not there.
 *
 * A line is "NAME VALUE UNIT DIRECTION" between tabs, in order of name; in a table of views the view's name stands
 * before it. DIRECTION is lower or higher, whichever is better, or none. What cannot be computed is a comment line
 * "# skipped WHAT: WHY", never a NaN. */
#ifndef REMODEL_METRIC_TABLE_H
#define REMODEL_METRIC_TABLE_H

#include <stdbool.h>

#include "common/base/provenance.h"

struct metric {
    char *view; /* owned; "" for the scene's */
    char name[64];
    double value;
    const char *unit, *direction; /* string literals */
};

struct metric_table {
    struct metric *metrics;
    int count;
    char **notes; /* comment lines without "# "; owned */
    int note_count;
};

/* view NULL: of the whole scene. A value that is not finite is ST_INTERNAL: the caller leaves it out with a reason. */
enum status metric_add(struct metric_table *t, const char *view, const char *name, double value, const char *unit,
                       const char *direction, struct err *err);
enum status metric_note(struct metric_table *t, struct err *err, const char *fmt, ...) PRINTF_LIKE(3, 4);

/* Sorts, then writes the scene's metrics, or (of_views) those of views. */
enum status metric_table_write(struct metric_table *t, bool of_views, const char *path, const struct provenance *prov,
                               struct err *err);
void metric_table_release(struct metric_table *t);

#endif
