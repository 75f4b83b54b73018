/* fuzz_ledger.c - readers of `make verify`: any bytes as the lines of a process give entries with a hash each, which
 * are read back as written, or an error that names the file; any bytes as a product give inputs with a hash each. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/verify/ledger_file.h"
#include "stages/verify/product_inputs.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check_inputs(const uint8_t *data, size_t size)
{
    struct product_inputs inputs;
    struct err err = ERR_INIT;
    if (product_inputs_read(&inputs, (const char *)data, size, &err)) abort();
    for (int i = 0; i < inputs.count; i++)
        if (strlen(inputs.items[i].hash) != HASH_TEXT - 1) abort();
    product_inputs_release(&inputs);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct ledger l = {0}, again = {0};
    struct err err = ERR_INIT, other = ERR_INIT;

    check_inputs(data, size);
    fuzz_file(path, data, size);
    if (ledger_read(&again, path, &other) && !strstr(other.text, path)) abort();
    ledger_release(&again);
    if (ledger_add_lines(&l, path, &err)) {
        if (!strstr(err.text, path)) abort();
    } else if (ledger_sort(&l, &err) || ledger_write(&l, path, &err) || ledger_read(&again, path, &err)) {
        abort();
    } else {
        if (again.count != l.count) abort();
        for (int i = 0; i < l.count; i++)
            if (strcmp(again.entries[i].path, l.entries[i].path) || strcmp(again.entries[i].hash, l.entries[i].hash))
                abort();
    }
    ledger_release(&l);
    ledger_release(&again);
    unlink(path);
    return 0;
}
