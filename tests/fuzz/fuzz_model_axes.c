/* fuzz_model_axes.c - the model's axes: any bytes give a valid transform, which is written and read back unchanged, or
 * an error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/model/model_axes.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct model_axes axes, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (model_axes_read(&axes, path, NULL, &err)) {
        if (!strstr(err.text, path) || axes.scale != 0) abort();
    } else {
        const struct vec3 d = model_from_world_direction(&axes, vec3_make(1, 2, 3));
        if (!(axes.scale > 0) || !(axes.ceiling >= 0) || !(axes.thickness >= 0)) abort();
        if (!(fabs(vec3_length(d) - sqrt(14)) < 1e-4)) abort();
        if (model_axes_write(&axes, path, NULL, &err) || model_axes_read(&again, path, NULL, &err)) abort();
        if (axes.scale != again.scale || axes.rotation.w != again.rotation.w || axes.ceiling != again.ceiling ||
            axes.translation.x != again.translation.x || axes.scale_error != again.scale_error)
            abort();
    }
    unlink(path);
    return 0;
}
