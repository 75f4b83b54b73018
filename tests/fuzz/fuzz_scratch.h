/* fuzz_scratch.h - temporary files and folders for fuzz targets; the caller removes them. */
#ifndef REMODEL_TESTS_FUZZ_SCRATCH_H
#define REMODEL_TESTS_FUZZ_SCRATCH_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "tests/scratch_name.h"

enum { FUZZ_PATH = 256 };

/* Makes a file with these bytes and sets path. */
static inline void fuzz_file(char path[FUZZ_PATH], const uint8_t *data, size_t size)
{
    const int fd = scratch_name(path, FUZZ_PATH, "fuzz") ? mkstemp(path) : -1;
    if (fd < 0 || write(fd, data, size) != (ssize_t)size || close(fd)) abort();
}

/* Makes a folder and sets path. */
static inline void fuzz_folder(char path[FUZZ_PATH])
{
    if (!scratch_name(path, FUZZ_PATH, "fuzz") || !mkdtemp(path)) abort();
}

#endif
