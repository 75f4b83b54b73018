/* bracket_noise.h - measures the noise of linear samples (common/image/noise_model.h) from exposures of one view.
 *
 * Measured noise includes the quantization to 8 bits. */
#ifndef REMODEL_BRACKET_NOISE_H
#define REMODEL_BRACKET_NOISE_H

#include <stdbool.h>

#include "common/image/noise_model.h"

struct brackets;

/* Measures noise from the differences between neighbouring exposures where both are well exposed. Robust against edges
 * and small shifts. *measured is false if there are too few samples; *noise is then unchanged. Independent of
 * threads. */
enum status noise_measure(struct noise *noise, bool *measured, const struct brackets *b, struct err *err);

#endif
