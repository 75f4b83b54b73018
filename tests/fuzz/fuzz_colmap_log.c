/* fuzz_colmap_log.c - COLMAP's log: any bytes give a count and a line. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/sfm/colmap_log.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH], line[100];

    fuzz_file(path, data, size);
    colmap_log_connected(path);
    colmap_log_last_line(line, sizeof line, path);
    if (strlen(line) >= sizeof line || strchr(line, '\n')) abort();
    unlink(path);
    return 0;
}
