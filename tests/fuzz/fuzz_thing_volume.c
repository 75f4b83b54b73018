/* fuzz_thing_volume.c - reader of things/volume.exr: any bytes give voxels whose ids and distances are in range, or an
 * error that names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/model/thing_volume.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct thing_volume v = {0};
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (thing_volume_read(&v, path, 3, NULL, &err)) {
        if (!strstr(err.text, path) || v.id || v.distance) abort();
    } else {
        if (!(v.grid.voxel > 0) || !voxel_count(&v.grid)) abort();
        for (size_t i = 0; i < voxel_count(&v.grid); i++)
            if (v.id[i] > 3 || isnan(v.distance[i])) abort();
        thing_volume_at(&v, v.grid.origin);
        thing_volume_release(&v);
    }
    unlink(path);
    return 0;
}
