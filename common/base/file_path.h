/* file_path.h - where a file of a folder is. */
#ifndef REMODEL_FILE_PATH_H
#define REMODEL_FILE_PATH_H

#include "common/base/err.h"

enum { FILE_PATH = 4096 }; /* bytes of a path, its end included */

/* path: FOLDER/FILESUFFIX, which it may not overlap. ST_IO: it is too long. */
enum status file_path(char path[FILE_PATH], const char *folder, const char *file, const char *suffix, struct err *err);

#endif
