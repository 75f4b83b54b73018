/* fuzz_scratch.h - files and folders of fuzz targets; whoever makes one removes it. */
#ifndef REMODEL_TESTS_FUZZ_SCRATCH_H
#define REMODEL_TESTS_FUZZ_SCRATCH_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "tests/scratch_name.h"

enum { FUZZ_PATH = 256 };

/* path: becomes that of a new file of these bytes. */
static inline void fuzz_file(char path[FUZZ_PATH], const uint8_t *data, size_t size)
{
    const int fd = scratch_name(path, FUZZ_PATH, "fuzz") ? mkstemp(path) : -1;
    if (fd < 0 || write(fd, data, size) != (ssize_t)size || close(fd)) abort();
}

/* path: becomes that of a new folder. */
static inline void fuzz_folder(char path[FUZZ_PATH])
{
    if (!scratch_name(path, FUZZ_PATH, "fuzz") || !mkdtemp(path)) abort();
}

#endif
