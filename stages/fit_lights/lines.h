/* lines.h - annotated lines across the edge of a lamp's cone, and what the photos show along them. */
#ifndef REMODEL_FIT_LIGHTS_LINES_H
#define REMODEL_FIT_LIGHTS_LINES_H

#include "stages/fit_lights/solve_inputs.h"

int lines_of_lamp(const struct lit_scene *scene, int lamp); /* their number */

/* Sets beta of the lamp, and its standard error. known: the lamps' radiances are known, and beta is already near.
 * ST_DATA as cone_fit_solve(). */
enum status lines_fit_beta(double *error, const struct solve_inputs *in, int lamp, bool known, struct err *err);

#endif
