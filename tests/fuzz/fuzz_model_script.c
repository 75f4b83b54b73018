/* fuzz_model_script.c - model scripts: any bytes give solids, or an error with file and line. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/build_model/layout/layout.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

enum { MAX_STATEMENTS = 64 }; /* that are applied: thousands take long and test nothing new */

static void apply(struct script *script, const char *path, bool edit)
{
    struct plan plan;
    struct solid_list list = {0};
    struct err err = ERR_INIT;
    plan_begin(&plan, NULL);
    if (plan_apply(&plan, script, edit, NULL, &err)) {
        if (!strstr(err.text, path) || !strchr(err.text + strlen(path), ':')) abort();
    } else if (layout_solids(&list, &plan, &err)) {
        if (!err.text[0]) abort();
    }
    solid_list_release(&list);
    plan_release(&plan);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct script script;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (script_read(&script, path, &err)) {
        if (!strstr(err.text, path) || script.statements || script.count) abort();
    } else {
        const int count = script.count;
        script.count = count < MAX_STATEMENTS ? count : MAX_STATEMENTS;
        apply(&script, path, false);
        apply(&script, path, true);
        script.count = count;
        script_release(&script);
    }
    unlink(path);
    return 0;
}
