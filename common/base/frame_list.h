/* frame_list.h - lists of frames on the command line: "1:30", "1:30,45". */
#ifndef REMODEL_FRAME_LIST_H
#define REMODEL_FRAME_LIST_H

#include <stdbool.h>

#include "common/base/err.h"

/* Sets wanted[i] if the list of --frames (numbers and ranges, from 1) contains frame i + 1. ST_USAGE: a syntax error, a
 * number outside 1 .. frame_count, an empty list. */
enum status frame_list_read(bool *wanted, int frame_count, const char *list, struct err *err);

#endif
