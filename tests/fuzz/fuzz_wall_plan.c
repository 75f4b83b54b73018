/* fuzz_wall_plan.c - reader of plans and truths: any bytes give finite faces and openings, or an error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/evaluate/truth/wall_plan.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];

    fuzz_file(path, data, size);
    for (int kind = PLAN_FROM_MODEL; kind <= PLAN_FROM_SCENE_TRUTH; kind++) {
        struct measured_plan plan = {0};
        struct wall_errors errors = {0};
        struct err err = ERR_INIT;
        if (wall_plan_read(&plan, path, (enum measured_plan_kind)kind, &err)) {
            if (!strstr(err.text, path) || plan.faces.count || plan.openings.count) abort();
            continue;
        }
        if (wall_errors_find(&errors, &plan, &plan, 1, &err)) abort();
        for (int i = 0; i < errors.faces.count; i++)
            if (!isfinite(errors.faces.errors[i])) abort();
        for (int i = 0; i < errors.openings.count; i++)
            if (!isfinite(errors.openings.errors[i])) abort();
        wall_errors_release(&errors);
        wall_plan_release(&plan);
    }
    unlink(path);
    return 0;
}
