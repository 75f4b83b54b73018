/* fuzz_scratch.h - files and folders of fuzz targets, in $TMPDIR, or /tmp; whoever makes one removes it. */
#ifndef REMODEL_TESTS_FUZZ_SCRATCH_H
#define REMODEL_TESTS_FUZZ_SCRATCH_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { FUZZ_PATH = 256 };

static inline void fuzz_template(char path[FUZZ_PATH])
{
    const char *tmp = getenv("TMPDIR");
    if (snprintf(path, FUZZ_PATH, "%s/remodel-fuzz-XXXXXX", tmp && *tmp ? tmp : "/tmp") >= FUZZ_PATH) abort();
}

/* path: becomes that of a new file of these bytes. */
static inline void fuzz_file(char path[FUZZ_PATH], const uint8_t *data, size_t size)
{
    fuzz_template(path);
    const int fd = mkstemp(path);
    if (fd < 0 || write(fd, data, size) != (ssize_t)size || close(fd)) abort();
}

/* path: becomes that of a new folder. */
static inline void fuzz_folder(char path[FUZZ_PATH])
{
    fuzz_template(path);
    if (!mkdtemp(path)) abort();
}

#endif
