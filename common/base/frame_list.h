/* frame_list.h - the frames of a move that a command line asks for: "1:30", "1:30,45". */
#ifndef REMODEL_FRAME_LIST_H
#define REMODEL_FRAME_LIST_H

#include <stdbool.h>

#include "common/base/err.h"

/* wanted[i] for frame i + 1 of --frames: ranges and single numbers, from 1. ST_USAGE: anything else, a number that
 * is no frame of the path, an empty list. */
enum status frame_list_read(bool *wanted, int frame_count, const char *list, struct err *err);

#endif
