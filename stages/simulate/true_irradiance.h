/* true_irradiance.h - true irradiance: pictures from cameras, and points of a file. */
#ifndef REMODEL_TRUE_IRRADIANCE_H
#define REMODEL_TRUE_IRRADIANCE_H

#include "stages/simulate/photos.h"

/* Writes the irradiance at the surface point that `w` shows at each pixel's centre, on the side that faces the camera,
 * to OUT/FOLDER/irradiance/NAME.exr (R G B float). With `edited` it is that of the edited scene, at the points of `w`;
 * 0 where the edited scene shows another surface. 0 on lamps and where nothing is hit, too. Random numbers are keyed by
 * camera and pixel, so that the noise before and after an edit is the same. */
enum status irradiance_picture(const struct picture_job *job, const struct world *w, const struct world *edited,
                               const struct shoot_photo *photo, const char *folder, struct err *err);

/* Reads lines X Y Z NX NY NZ from `points` and writes OUT/FOLDER/irradiance-points.txt, with R G B behind each.
 * ST_DATA: a bad line, or none. */
enum status irradiance_points(const struct picture_job *job, const struct world *w, const char *points,
                              const char *folder, struct err *err);

#endif
