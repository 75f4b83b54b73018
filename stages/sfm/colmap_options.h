/* colmap_options.h - names of options that differ between versions of COLMAP.
 *
 * COLMAP 3.13 moved the options of all kinds of features from SiftMatching to FeatureMatching, and rejects the old
 * names. So its help is read for those that it knows. */
#ifndef REMODEL_COLMAP_OPTIONS_H
#define REMODEL_COLMAP_OPTIONS_H

#include <stdbool.h>

#include "common/base/err.h"

struct colmap_options {
    const char *use_gpu, *num_threads; /* of the commands that match; with two dashes; constants */
};

/* Finds the names in a text, the help of a command that matches. False if it has neither the old nor the new ones. */
bool colmap_options_find(struct colmap_options *o, const char *help);

/* Asks the installed COLMAP; its help is written to `log`, which is replaced. ST_IO: it cannot be run, or knows none of
 * the names. */
enum status colmap_options_ask(struct colmap_options *o, const char *log, struct err *err);

#endif
