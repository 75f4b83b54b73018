/* suggest_script.h - a suggestion as a model script, and as a picture of the plan. */
#ifndef REMODEL_SUGGEST_SCRIPT_H
#define REMODEL_SUGGEST_SCRIPT_H

#include <stdio.h>

#include "common/model/model_axes.h"
#include "stages/suggest_model/suggest.h"

/* "south", "wall2": names are south, west, north and east of the four longest walls that bound rooms on these sides,
 * and wallN. */
struct wall_names {
    char (*names)[16]; /* owned; of walls */
};
enum status suggest_names_make(struct wall_names *n, const struct suggestion *s, struct err *err);
void suggest_names_release(struct wall_names *n);

/* note: why nothing could be found, or NULL. */
void suggest_script_print(FILE *to, const struct suggestion *s, const struct wall_names *names,
                          const struct model_axes *axes, const char *note);

/* SVG of the points of walls, the walls with their names and confidences, openings, doubts and cameras. */
void suggest_picture_print(FILE *to, const struct suggestion *s, const struct wall_names *names,
                           const struct sights *sights, bool metric);

#endif
