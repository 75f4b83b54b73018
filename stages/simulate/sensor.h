/* sensor.h - from radiance to the 8-bit photograph that a camera stores.
 *
 * A pixel collects s = gain * radiance * seconds * (ISO / 100) * (8 / f-number)^2 / filter, where 1 is white and, at ISO
 * 100, fills the well: full_well * 100 / ISO electrons. Photons arrive with Poisson's noise and are read with Gaussian
 * noise; then the signal is clipped to 0..1, takes the sRGB curve and is rounded to 8 bits. */
#ifndef REMODEL_SIMULATE_SENSOR_H
#define REMODEL_SIMULATE_SENSOR_H

#include "common/base/rng.h"
#include "common/image/image.h"
#include "stages/simulate/shoot_file.h"

/* rgb: 3 bytes a pixel. `rng` is the noise of this photograph and exposure. */
void sensor_expose(unsigned char *rgb, const struct image *radiance, const struct sensor *sensor,
                   const struct exposure *exposure, const struct rng *rng);

#endif
