/* metric_meaning.h - what a metric of docs/evaluation.md means, in a few words. */
#ifndef REMODEL_METRIC_MEANING_H
#define REMODEL_METRIC_MEANING_H

/* "" for an unknown metric. */
const char *metric_meaning(const char *name);

#endif
