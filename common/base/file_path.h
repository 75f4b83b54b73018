/* file_path.h - the path of a file in a folder. */
#ifndef REMODEL_FILE_PATH_H
#define REMODEL_FILE_PATH_H

#include <stdbool.h>

#include "common/base/err.h"

enum { FILE_PATH = 4096 }; /* bytes of a path, with the final NUL */

/* Sets path to FOLDER/FILESUFFIX; it must not overlap them. ST_IO: too long. */
enum status file_path(char path[FILE_PATH], const char *folder, const char *file, const char *suffix, struct err *err);

const char *path_file_name(const char *path); /* the part after the last slash */
/* It exists and is a regular file, or a link to one; or an error of the disk hides it, which opening it then tells. */
bool path_is_file(const char *path);
bool path_is_folder(const char *path); /* the same of a folder */

#endif
