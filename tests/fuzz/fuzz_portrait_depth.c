/* fuzz_portrait_depth.c - any bytes have no depth, or give a depth map and its units, or an error with the file. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/file_path.h"
#include "stages/import_photos/portrait_depth.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH], folder[FUZZ_PATH], map[FUZZ_PATH + 16], units[FUZZ_PATH + 16];
    struct err err = ERR_INIT, none = ERR_INIT;
    bool taken = true;
    fuzz_file(path, data, size);
    fuzz_folder(folder);
    snprintf(map, sizeof map, "%s/me.pfm", folder);
    snprintf(units, sizeof units, "%s/depth.txt", folder);
    const enum status st = portrait_depth_take(&taken, path, "me", folder, &err);
    if (st != err.status || (st && taken) || (st == ST_DATA && !strstr(err.text, path))) abort();
    if (taken != path_is_file(map) || taken != path_is_file(units)) abort();
    if (portrait_depth_remove(NULL, folder, &none) || path_is_folder(folder)) abort();
    unlink(path);
    return 0;
}
