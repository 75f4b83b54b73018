/* fuzz_light_sheet.c - readers of sheet.tsv and of the record of gathered light: any bytes
 * give rows and numbers in range, or an error that names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/gather/light_record.h"
#include "stages/light_levels/sheet.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct light_sheet sheet = {0};
    struct light_record record;
    struct err err = ERR_INIT, record_err = ERR_INIT;

    fuzz_file(path, data, size);
    if (sheet_read(&sheet, path, NULL, &err)) {
        if (!strstr(err.text, path)) abort();
    } else {
        for (int i = 0; i < sheet.count; i++) {
            const struct sheet_row *r = &sheet.rows[i];
            if (!r->state || !r->kind || !r->place || !r->unit || r->points < 0 || !isfinite(r->mean)) abort();
        }
    }
    sheet_release(&sheet);
    if (light_record_read(&record, path, &record_err)) {
        if (!strstr(record_err.text, path)) abort();
    } else {
        if (record.points < 0 || record.dark < 0 || record.dark > record.points ||
            record.example_count > LIGHT_EXAMPLES_MAX)
            abort();
        for (int i = 0; i < LIGHT_SOURCES; i++)
            if (!(record.from[i] >= 0 && record.from[i] <= 1)) abort();
    }
    unlink(path);
    return 0;
}
