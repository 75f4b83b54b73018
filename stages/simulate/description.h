/* description.h - readers for the words that scene.txt and cameras.txt have in common. Errors are ST_DATA with file,
 * line, the word found and the word expected; `what` names the expected value in them. */
#ifndef REMODEL_SIMULATE_DESCRIPTION_H
#define REMODEL_SIMULATE_DESCRIPTION_H

#include "common/base/textfile.h"
#include "common/math/vec.h"

#define MAX_METRES 1e5 /* largest coordinate, either sign */

/* The first line: KIND VERSION, from 1 to max_version. Rejects an empty file. */
enum status description_header(struct textfile *t, const char *kind, int max_version, int *version, struct err *err);

enum status description_point(struct textfile *t, const char *what, struct vec3 *p, struct err *err);

/* A name of letters, digits, _ and -. The caller frees it. */
enum status description_name(struct textfile *t, char **name, struct err *err);

/* array_append() for lines of one kind, of which there may be `max`. */
enum status description_append(const struct textfile *t, void *array, int count, int max, size_t item_size,
                               struct err *err);

#endif
