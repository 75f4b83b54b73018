/* point_lists.h - irradiance at the points of a file, and at points over a face. */
#ifndef REMODEL_GATHER_POINT_LISTS_H
#define REMODEL_GATHER_POINT_LISTS_H

#include "stages/gather_irradiance/gather_job.h"

/* Reads points in the scene's frame. Writes OUT/irradiance-parts.txt, then OUT/irradiance.txt. */
enum status gather_points_of_file(struct gather_job *j, const char *path, struct err *err);

/* Points `step` (model units) apart over the faces of an id. Writes OUT/irradiance/face-ID-parts.txt, then
 * OUT/irradiance/face-ID.txt, in the scene's frame. ST_USAGE: the model has no such face; ST_DATA: too many points, or
 * none. */
enum status gather_points_of_face(struct gather_job *j, int face, double step, struct err *err);

/* ST_USAGE: no number above 0. */
enum status gather_read_step(double *step, const char *text, struct err *err);

#endif
