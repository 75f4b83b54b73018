/* metric_table.h - the metrics of metrics.tsv and evaluate/views.tsv, and notes about those that are missing.
 *
 * A line is "NAME VALUE UNIT DIRECTION", separated by tabs, in order of name; in views.tsv the name of the view comes
 * first. DIRECTION is lower or higher, whichever is better, or none. A metric that cannot be computed becomes a comment
 * "# skipped WHAT: WHY", never a NaN. */
#ifndef REMODEL_METRIC_TABLE_H
#define REMODEL_METRIC_TABLE_H

#include <stdbool.h>

#include "common/base/metric_kinds.h"
#include "common/base/provenance.h"

enum { METRIC_NAME = 96 }; /* bytes of a name, with that of an edit */

struct metric {
    char *view; /* owned; "" for the scene */
    char name[METRIC_NAME];
    double value;
    struct metric_kind kind;
};

struct metric_table {
    struct metric *metrics;
    int count;
    char **notes; /* comment lines without "# "; owned */
    int note_count;
};

/* view: NULL for the whole scene. ST_INTERNAL: a value that is not finite (the caller must write a note instead), or a
 * metric that metric_kinds.def does not have. */
enum status metric_add(struct metric_table *t, const char *view, const char *name, double value, struct err *err);
/* Adds a comment line; its line breaks become spaces. */
enum status metric_note(struct metric_table *t, struct err *err, const char *fmt, ...) PRINTF_LIKE(3, 4);

/* Sorts, then writes the metrics of the scene with the notes, or (of_views) those of the views. prov may be NULL. */
enum status metric_table_write(struct metric_table *t, bool of_views, const char *path, const struct provenance *prov,
                               struct err *err);
void metric_table_release(struct metric_table *t);

#endif
