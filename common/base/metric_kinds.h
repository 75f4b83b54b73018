/* metric_kinds.h - what metrics there are (metric_kinds.def), by the names of metrics.tsv: PREFIX.NAME, such as
 * depth.error50_visible or edited.EDIT.walls. */
#ifndef REMODEL_METRIC_KINDS_H
#define REMODEL_METRIC_KINDS_H

#include <stdbool.h>

struct metric_kind {
    const char *unit, *direction; /* direction: lower or higher, whichever is better, or none */
    const char *meaning;          /* a few words for the page */
};

/* Fills kind with the unit, direction and meaning of a metric. False: no metric has this name. */
bool metric_kind_find(struct metric_kind *kind, const char *name);

#endif
