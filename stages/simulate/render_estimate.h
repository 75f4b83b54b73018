/* render_estimate.h - how long the pictures of a described scene take on this machine. */
#ifndef REMODEL_RENDER_ESTIMATE_H
#define REMODEL_RENDER_ESTIMATE_H

#include <stdio.h>

#include "stages/simulate/photos.h"

/* Prints a line for each kind of picture: how many there are, with how many samples, and about how many minutes they
 * take together with this number of threads. Renders a small picture from each camera, which takes about a second. */
enum status estimate_print(FILE *to, const struct picture_job *job, const struct world *w, struct err *err);

#endif
