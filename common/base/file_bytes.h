/* file_bytes.h - a whole file in memory. */
#ifndef REMODEL_FILE_BYTES_H
#define REMODEL_FILE_BYTES_H

#include <stddef.h>

#include "common/base/err.h"

struct file_bytes {
    char *bytes; /* owned; a NUL follows them */
    size_t size;
};

/* On failure f is empty. */
enum status file_bytes_read(struct file_bytes *f, const char *path, struct err *err);
void file_bytes_release(struct file_bytes *f);

#endif
