/* fuzz_scene_exposure.c - reader of a scene's exposure: any bytes give a number above 0, or an error with the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/texture/scene_exposure.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    double exposure;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (scene_exposure_read(&exposure, path, NULL, &err)) {
        if (!strstr(err.text, path)) abort();
    } else if (!(exposure > 0 && isfinite(exposure))) {
        abort();
    }
    unlink(path);
    return 0;
}
