/* fuzz_usage.c - the report's reader of logs. The first line of the input is the log's name. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "stages/report/usage.c" /* stages are in no library */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct usage_table table = {0};
    struct err err = ERR_INIT;
    char name[64] = "stage.item.log";
    const uint8_t *end = memchr(data, '\n', size);

    if (end && (size_t)(end - data) < sizeof name) {
        memcpy(name, data, (size_t)(end - data));
        name[end - data] = 0;
        size -= (size_t)(end + 1 - data);
        data = end + 1;
    }
    if (usage_add_log(&table, name, (const char *)data, size, &err)) abort(); /* any log is valid */
    for (int i = 0; i < table.stage_count; i++)
        if (!(table.stages[i].sum.wall >= 0 && table.stages[i].sum.mib <= 1e12)) abort();
    usage_table_release(&table);
    return 0;
}
