/* split_name.h - the pictures of a photo of a multi-lens camera: how many there are, COLUMNSxROWS, and their names,
 * ID_cXrY.png. Columns X count from 1 at the left, rows Y from 1 at the top of the photo as stored. */
#ifndef REMODEL_SPLIT_NAME_H
#define REMODEL_SPLIT_NAME_H

#include <stdbool.h>
#include <stddef.h>

#include "common/base/err.h"

enum { MAX_SPLIT = 99 }; /* pictures per side of a photo */

struct split_size {
    int columns, rows; /* 0: the photos are not split */
};

struct split_name {
    int column, row;
    size_t photo_length; /* of what precedes _cXrY: the photo's id, with its folder if the name has one */
};

/* Parses the value of --split, "3x2". ST_USAGE. */
enum status split_size_parse(struct split_size *size, const char *text, struct err *err);

/* The file name of a picture; the caller frees it. NULL: out of memory. */
char *split_name_make(const char *photo_id, int column, int row);

/* Reads the name of a picture, with or without an extension. False: it is not like that of a picture of the split. */
bool split_name_read(struct split_name *name, const char *text, struct split_size size);

#endif
