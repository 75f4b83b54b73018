/* openings.h - openings of a wall, from the points and lines of sight that show it. */
#ifndef REMODEL_OPENINGS_H
#define REMODEL_OPENINGS_H

#include "stages/suggest_model/suggest.h"

struct opening_finder {
    const struct sights *sights; /* with points finer than the window */
    const struct suggest_params *params;
    double height; /* of the ceiling */
};

/* Adds the openings of a wall to the suggestion. */
enum status openings_find(struct suggestion *s, const struct opening_finder *f, int wall, struct err *err);

#endif
