/* irradiance_error.h - found against true irradiance at points. */
#ifndef REMODEL_IRRADIANCE_ERROR_H
#define REMODEL_IRRADIANCE_ERROR_H

#include <stdbool.h>

#include "stages/evaluate/light/irradiance_list.h"

#define POINT_DISTANCE 0.01 /* m: a found point this near with the same normal is the true one */

/* partner[i]: the index of the nearest found point of true point i, within POINT_DISTANCE, with a normal within 10
 * degrees; -1: none. Both lists are in one frame, in metres. */
void irradiance_partners(int *partner, const struct irradiance_list *truth, const struct irradiance_list *found);

struct irradiance_errors {
    double rms;     /* sqrt(sum (E - E_true)^2 / sum E_true^2) over points and channels */
    double error50; /* median of |Y - Y_true| / Y_true of luminance */
    double error90; /* the value that nine tenths of them do not exceed */
    int points;
};

/* Over the points with a partner whose `wanted` is set and whose true irradiance is not 0. scale: of the found values.
 * ST_NOMEM. */
enum status irradiance_errors(struct irradiance_errors *e, const struct irradiance_list *truth,
                              const struct irradiance_list *found, const int *partner, const bool *wanted, double scale,
                              struct err *err);

/* The median of true / found luminance over the points with a partner and light in both; 0: there is none. ST_NOMEM. */
enum status irradiance_scale(double *scale, const struct irradiance_list *truth, const struct irradiance_list *found,
                             const int *partner, struct err *err);

#endif
