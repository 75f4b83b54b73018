/* fuzz_exposure_list.c - exposures.txt: any bytes give unique photos with positive exposures, or an error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/import_photos/exposure_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct exposure_list list;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (exposure_list_read(&list, path, &err)) {
        if (!strstr(err.text, path) || list.lines) abort();
    } else {
        for (int i = 0; i < list.count; i++) {
            double value = exposure_value(&list.lines[i].exposure);
            if (!(value > 0) || !isfinite(value)) abort();
            for (int k = 0; k < i; k++)
                if (!strcmp(list.lines[i].file, list.lines[k].file)) abort();
        }
        exposure_list_release(&list);
    }
    unlink(path);
    return 0;
}
