/* fuzz_lux_marks.c - reader of lux.txt: any bytes give measurements above 0 with a place, or an error that names the
 * file. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/calibrate_light/lux_marks.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct lux_marks marks;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (lux_marks_read(&marks, path, NULL, &err)) {
        if (!strstr(err.text, path) || marks.items) abort();
    } else {
        if (marks.count < 1) abort();
        for (int i = 0; i < marks.count; i++) {
            const struct lux_mark *m = &marks.items[i];
            if (!m->name || !(m->value > 0) || !m->view == !m->face || m->pixels > 2) abort();
            if (m->within > 1) abort();
        }
        lux_marks_release(&marks);
    }
    unlink(path);
    return 0;
}
