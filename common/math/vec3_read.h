/* vec3_read.h - the three coordinates of a point or a direction, from a line of text. */
#ifndef REMODEL_VEC3_READ_H
#define REMODEL_VEC3_READ_H

#include "common/base/textfile.h"
#include "common/math/vec.h"

/* Reads x, y and z. `what` says in errors what they are: "the centre". Errors as textfile_double(). */
enum status vec3_read(struct textfile *t, const char *what, struct vec3 *v, struct err *err);
/* The same; a vector that is longer than 1e9 is an error, too. */
enum status vec3_read_bounded(struct textfile *t, const char *what, struct vec3 *v, struct err *err);

#endif
