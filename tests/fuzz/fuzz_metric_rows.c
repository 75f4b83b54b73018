/* fuzz_metric_rows.c - the report's reader of metrics, of scenes and of views: finite values, or an error. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "fuzz.h"
#include "stages/report/metric_rows.c" /* stages are in no library */
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    fuzz_file(path, data, size);
    for (int of_views = 0; of_views < 2; of_views++) {
        struct metric_rows r;
        struct err err = ERR_INIT;
        enum status st = metric_rows_read(&r, path, of_views, &err);
        if (st != err.status || (st && r.count)) abort();
        for (int i = 0; i < r.count; i++)
            if (!isfinite(r.rows[i].value) || !metric_rows_find(&r, r.rows[i].view, r.rows[i].name)) abort();
        metric_rows_release(&r);
    }
    unlink(path);
    return 0;
}
