/* data_file.h - a script file that hands data to the page: walk_take("NAME", {...});
 *
 * A page that was opened from disk may neither fetch files nor use picture files as textures, but it may load
 * scripts. */
#ifndef REMODEL_WALK_DATA_FILE_H
#define REMODEL_WALK_DATA_FILE_H

#include <stdint.h>

#include "common/base/outfile.h"
#include "common/math/vec.h"

struct data_file {
    struct outfile out;
    FILE *fp; /* of out */
};

/* Opens FOLDER/NAME.js; what is written to fp until the commit is a JavaScript value. */
enum status data_file_open(struct data_file *f, const char *folder, const char *name, struct err *err);
/* Adds the size of the file to *bytes. */
enum status data_file_commit(struct data_file *f, int64_t *bytes, struct err *err);
void data_file_discard(struct data_file *f); /* idempotent */

/* A text in quotes; NULL gives null. */
void data_write_text(FILE *to, const char *text);
/* A number with as many digits as single precision holds. */
void data_write_number(FILE *to, double number);
/* [a,b,...] */
void data_write_numbers(FILE *to, const double *numbers, int count);
void data_write_point(FILE *to, struct vec3 p);

#endif
