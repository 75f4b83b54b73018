/* sensor.h - from radiance to the 8-bit photograph that a camera stores.
 *
 * A pixel's signal is s = gain * radiance * seconds * (ISO / 100) * (8 / f-number)^2 / filter. s = 1 is white, and is
 * full_well * 100 / ISO electrons. Photons have Poisson noise, reading adds Gaussian noise; then the signal is clipped
 * to 0..1, passed through the sRGB curve and rounded to 8 bits. */
#ifndef REMODEL_SIMULATE_SENSOR_H
#define REMODEL_SIMULATE_SENSOR_H

#include "common/base/rng.h"
#include "common/image/image.h"
#include "stages/simulate/shoot_file.h"

/* Writes 3 bytes per pixel to rgb. `rng` must be keyed by photograph and exposure. */
void sensor_expose(unsigned char *rgb, const struct image *radiance, const struct shoot_sensor *sensor,
                   const struct shoot_exposure *exposure, const struct rng *rng);

#endif
