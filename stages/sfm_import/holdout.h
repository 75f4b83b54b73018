/* holdout.h - held-out views: excluded from depth and rendering, so that rendered pictures can be compared with
 * photographs that they were not made from. They do take part in structure from motion. */
#ifndef REMODEL_HOLDOUT_H
#define REMODEL_HOLDOUT_H

#include "stages/sfm_import/import_model.h"

/* Sets held[i] for view i of the list. every > 0: all views of every Nth placed photo in order of name, the first
 * included. names (NULL: none; separated by blanks): views, or ids of photos, which mean all their views. ST_USAGE: an
 * unknown name, or fewer than two photos kept. */
enum status holdout_choose(bool *held, const struct lens_list *lenses, int every, const char *names, struct err *err);

/* Copies views, lenses and points of `in` to two models (both empty on entry; the caller releases them). `kept` has the
 * points that at least two kept photos see, `out` all points that the held-out views see. Ids of views start at 1 in
 * both. */
enum status holdout_split(struct imported *kept, struct imported *out, const struct imported *in, const bool *held,
                          struct err *err);

#endif
