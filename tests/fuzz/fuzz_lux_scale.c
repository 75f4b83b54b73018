/* fuzz_lux_scale.c - reader of lux/scale.txt: any bytes give a scale within its interval, which is read back as
 * written, or an error that names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/daylight/lux_scale.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct lux_scale s, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (lux_scale_read(&s, path, NULL, &err)) {
        if (!strstr(err.text, path) || s.measurements) abort();
        unlink(path);
        return 0;
    }
    if (s.from != LUX_UNKNOWN && !(s.is.low > 0)) abort();
    if (!(s.is.low >= 0 && s.is.low <= s.is.scale && s.is.scale <= s.is.high && isfinite(s.is.high))) abort();
    if (lux_scale_write(&s, path, NULL, &err)) { /* a name with a line break */
        if (!strstr(err.text, "line break")) abort();
    } else {
        if (lux_scale_read(&again, path, NULL, &err)) abort();
        if (again.is.scale != s.is.scale || again.count != s.count || again.photos != s.photos) abort();
        lux_scale_release(&again);
    }
    lux_scale_release(&s);
    unlink(path);
    return 0;
}
