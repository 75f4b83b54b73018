/* fuzz_outdoors.c - reader of the outdoors: any bytes give a picture of radiances of at least 0 that can be looked up
 * and written again, or an error that names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/texture/outdoors.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void look_up(const struct outdoors *o)
{
    for (int i = 0; i < 26; i++) {
        float rgb[3];
        const struct vec3 d = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
        if (outdoors_sample(rgb, o, d) > OUTDOORS_PHOTO) abort();
        for (int c = 0; c < 3; c++)
            if (!(rgb[c] >= 0 && isfinite(rgb[c]))) abort();
    }
}

static void write_again(const struct outdoors *o, const char *path)
{
    struct outdoors again;
    struct err err = ERR_INIT;
    if (outdoors_write(o, path, NULL, &err) || outdoors_read(&again, path, NULL, &err)) abort();
    if (again.width != o->width || memcmp(again.source, o->source, (size_t)o->width * (size_t)o->height)) abort();
    outdoors_release(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct outdoors o;
    struct err err = ERR_INIT;
    char path[FUZZ_PATH];

    fuzz_file(path, data, size);
    if (outdoors_read(&o, path, NULL, &err)) {
        if (o.rgb || o.source || o.width || !strstr(err.text, path)) abort();
    } else {
        if (o.height < 1 || o.width != 2 * o.height) abort();
        look_up(&o);
        write_again(&o, path);
        outdoors_release(&o);
    }
    unlink(path);
    return 0;
}
