/* fuzz_lights.c - reader of lights.txt: any bytes give lamps with finite light, which are read back as written, or an
 * error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/gather/light_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check_lamp(const struct lamp *l)
{
    const struct vec3 at = vec3_sub(l->centre, l->normal), aside = vec3_make(0.3, -0.7, 0.1);
    const struct rgb e = lamp_irradiance(l, at, vec3_scale(l->normal, -1));
    const struct rgb o = lamp_irradiance(l, vec3_add(at, aside), vec3_normalize(aside));
    if (!l->name || !(l->beta >= 0) || !(e.r >= 0) || !(o.g >= 0)) abort();
    if (isinf(l->radiance.r) || isinf(lamp_radiance(l, l->normal).b)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct light_list list, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (light_list_read(&list, path, NULL, &err)) {
        if (!strstr(err.text, path) || list.lamps || list.openings) abort();
        unlink(path);
        return 0;
    }
    for (int i = 0; i < list.lamp_count; i++) check_lamp(&list.lamps[i]);
    if (light_list_write(&list, path, NULL, &err) || light_list_read(&again, path, NULL, &err)) abort();
    if (again.lamp_count != list.lamp_count || again.opening_count != list.opening_count) abort();
    for (int i = 0; i < list.lamp_count; i++)
        if (again.lamps[i].centre.x != list.lamps[i].centre.x || again.lamps[i].bound != list.lamps[i].bound) abort();
    light_list_release(&again);
    light_list_release(&list);
    unlink(path);
    return 0;
}
