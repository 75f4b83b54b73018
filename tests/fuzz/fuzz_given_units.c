/* fuzz_given_units.c - depth.txt: any bytes give a positive scale or none, or an error that names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/segment_depth/given_read.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct given_units units;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (given_units_read(&units, path, &err)) {
        if (!strstr(err.text, path) || units.scale > 0) abort();
    } else if (!isfinite(units.scale) || units.scale < 0 || units.scale > 1e12 || units.pixels > PIXELS_OF_PHOTO ||
               units.samples > SAMPLES_DISPARITY) {
        abort();
    }
    unlink(path);
    return 0;
}
