/* fuzz_relit_file.c - reader of relit.js: any bytes give fields of the size that it states, or an error that names the
 * file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/light_levels/relit_file.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct relit_light r = {0};
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (relit_file_read(&r, path, &err)) {
        if (!strstr(err.text, path)) abort();
    } else {
        for (int i = 0; i < r.field_count; i++)
            for (int k = 0; k < 3 * r.places; k++)
                if (!isfinite(r.fields[i].values[k])) abort();
        for (int i = 0; i < r.window_count; i++)
            if (!r.windows[i]) abort();
    }
    relit_light_release(&r);
    unlink(path);
    return 0;
}
