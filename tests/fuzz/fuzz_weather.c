/* fuzz_weather.c - reader of weather files: any bytes give hours with finite skies, or an error that names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/daylight/weather.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct weather w;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (weather_read(&w, path, NULL, &err)) {
        if (!strstr(err.text, path) || w.hours || w.place) abort();
    } else {
        if (!w.place || w.count < 1 || w.missing >= w.count) abort();
        for (int i = 0; i < w.count && i < 100; i++) {
            struct sun_position sun;
            sun_position_find(&sun, &w.at, &w.hours[i].middle);
            const struct sky_luminance s = sky_from_weather(&w.hours[i].sky, &sun, 0, GROUND_TYPICAL);
            if (!isfinite(sun.altitude) || !isfinite(sun.azimuth)) abort();
            if (!(s.diffuse >= 0) || !(s.sun >= 0) || !isfinite(sky_luminance_at(&s, vec3_make(0.6, 0, 0.8)))) abort();
        }
        weather_release(&w);
    }
    unlink(path);
    return 0;
}
