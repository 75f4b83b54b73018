/* file_path.c - paths of files. */
#include "common/base/file_path.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum status file_path(char path[FILE_PATH], const char *folder, const char *file, const char *suffix, struct err *err)
{
    if (snprintf(path, FILE_PATH, "%s/%s%s", folder, file, suffix) < FILE_PATH) return ST_OK;
    return err_set(err, ST_IO, "the path %s/%s%s is longer than %d bytes; use a shorter folder or file name.", folder,
                   file, suffix, FILE_PATH - 1);
}

const char *path_file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* If stat() fails although the path may exist, it counts as existing: opening it then gives the reason. */
static bool is_there(const char *path, mode_t kind)
{
    struct stat info;
    if (!stat(path, &info)) return (info.st_mode & S_IFMT) == kind;
    return errno != ENOENT && errno != ENOTDIR && errno != ENAMETOOLONG && errno != ELOOP;
}

bool path_is_file(const char *path) { return is_there(path, S_IFREG); }
bool path_is_folder(const char *path) { return is_there(path, S_IFDIR); }
