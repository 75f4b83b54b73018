/* fuzz_true_room.c - reader of true rooms: any bytes give a floor below a ceiling, no room, or an error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/evaluate/truth/true_room.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];

    fuzz_file(path, data, size);
    for (int frame = 0; frame < 2; frame++) {
        struct true_room room;
        struct err err = ERR_INIT;
        if (true_room_read_file(&room, path, frame, &err)) {
            if (!strstr(err.text, path) || room.known) abort();
        } else if (room.known != (room.count > 0)) {
            abort();
        } else if (!isfinite(room.room_from_world.m[0][0])) {
            abort();
        }
        for (int i = 0; i < room.count; i++)
            if (!(room.heights[i].ceiling > room.heights[i].floor)) abort();
        true_room_release(&room);
    }
    unlink(path);
    return 0;
}
