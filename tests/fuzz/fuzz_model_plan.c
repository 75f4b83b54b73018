/* fuzz_model_plan.c - reader of plan.txt: any bytes give a plan whose parts refer to its walls, or an error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/model/model_plan.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct model_plan plan;
    struct vec3 corners[2];
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (model_plan_read(&plan, path, NULL, &err)) {
        if (!strstr(err.text, path) || plan.walls || plan.rooms) abort();
        unlink(path);
        return 0;
    }
    for (int i = 0; i < plan.wall_count; i++)
        for (int k = 0; k < 2; k++)
            if ((plan.walls[i].ends[k] != MODEL_WALL_FREE) != (plan.walls[i].neighbours[k] != NULL)) abort();
    for (int i = 0; i < plan.opening_count; i++) {
        if (plan.openings[i].wall < 0 || plan.openings[i].wall >= plan.wall_count) abort();
        if (model_opening_corners(&plan, i, corners) && !isfinite(corners[0].x + corners[1].y)) abort();
    }
    for (int i = 0; i < plan.room_count; i++)
        for (int k = 0; k < plan.rooms[i].corner_count; k++)
            if (plan.rooms[i].corners[k].wall >= plan.wall_count || !plan.rooms[i].corners[k].wall_name) abort();
    for (int i = 0; i < plan.slot_count; i++)
        if (plan.slots[i].room < 0 || plan.slots[i].room >= plan.room_count) abort();
    model_plan_release(&plan);
    unlink(path);
    return 0;
}
