/* fuzz_photometry.c - reader of IES files: any bytes give finite intensities that are not negative, or an error that
 * names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/daylight/photometry.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct photometry p;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (photometry_read(&p, path, NULL, &err)) {
        if (!strstr(err.text, path) || p.candela || p.name) abort();
    } else {
        if (!p.name || p.vertical_count < 2 || p.horizontal_count < 1) abort();
        for (int v = -20; v <= 200; v += 20)
            for (int h = -50; h <= 400; h += 30) {
                const double i = photometry_intensity(&p, v, h);
                if (!(i >= 0) || !isfinite(i)) abort();
            }
        if (!(photometry_lumens(&p) >= -1e-6 * (1 + photometry_intensity(&p, 90, 0)))) abort();
        if (!(photometry_tilt(&p, 33) >= 0)) abort();
        photometry_release(&p);
    }
    unlink(path);
    return 0;
}
