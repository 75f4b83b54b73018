/* fuzz_round.c - VIEW.round: any bytes give a share from 0 to 1, or an error that names the file. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/segment_depth/depth_rounds.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct round_record r;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (round_record_read(&r, path, NULL, &err)) {
        if (!strstr(err.text, path) || r.estimated) abort();
    } else if (!(r.changed >= 0 && r.changed <= 1)) {
        abort();
    }
    unlink(path);
    return 0;
}
