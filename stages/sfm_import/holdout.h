/* holdout.h - views kept out of depth and rendering, so that rendered pictures can be compared with photographs that
 * nothing was made from. They take part in structure from motion all the same. */
#ifndef REMODEL_HOLDOUT_H
#define REMODEL_HOLDOUT_H

#include "stages/sfm_import/import_model.h"

/* Marks held[i] for view i of the list. every > 0: the views of every Nth placed photo in order of name, the first
 * included; a photo that became several views is held out whole. names (NULL: none; parted by blanks): views, or photos
 * by id, which means all their views. ST_USAGE: a name that is none of these, fewer than two photos kept. */
enum status holdout_choose(bool *held, const struct lens_list *lenses, int every, const char *names, struct err *err);

/* Copies views, lenses and points of `in` to two models (both empty on entry, the caller releases them): `kept` holds
 * the points that two kept photos still see, `out` all that the held-out views see. Ids of views count from 1 in
 * either. */
enum status holdout_split(struct imported *kept, struct imported *out, const struct imported *in, const bool *held,
                          struct err *err);

#endif
