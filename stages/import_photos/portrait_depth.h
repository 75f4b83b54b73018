/* portrait_depth.h - the depth that a phone's portrait carries, as HEIC or AVIF, beside its picture. */
#ifndef REMODEL_PORTRAIT_DEPTH_H
#define REMODEL_PORTRAIT_DEPTH_H

#include <stdbool.h>

#include "common/base/err.h"

/* Writes OUT/ID.pfm and OUT/depth.txt, as DEPTH may have them (docs/formats/what-people-write.md), if the file at
 * `photo` carries depth, which *taken says. Files are rewritten only if they change. ST_DATA: the depth is damaged. */
enum status portrait_depth_take(bool *taken, const char *photo, const char *id, const char *out, struct err *err);

/* Removes what it has written in `out` but for ID.pfm and its depth.txt; id NULL: all, and the folder. */
enum status portrait_depth_remove(const char *id, const char *out, struct err *err);

#endif
