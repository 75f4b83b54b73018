/* fuzz_lamp_notes.c - reader of a scene's marked lamps and points: any bytes give annotations in range, or an error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/fit_lights/annotations.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check(const struct annotation_list *list, const struct annotation *a)
{
    if (!a->name || (a->kind > NOTE_SHUT) != (a->view != NULL)) abort();
    for (int i = 0; i < 2 * a->pixels; i++)
        if (!(a->pixel[i] >= 0 && a->pixel[i] <= 1e6)) abort();
    if (a->kind >= NOTE_LIT && (a->lamp < 0 || a->lamp >= list->count || list->items[a->lamp].kind < NOTE_DISK))
        abort();
    if (a->has_normal && !(fabs(vec3_length(a->normal) - 1) < 1e-9)) abort();
    if (a->has_beta == QUANTITY_GIVEN && !(a->beta > 0 && a->beta <= 90)) abort();
    if (!(a->off >= 0) || !(a->exponent >= 0)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct annotation_list list;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (annotation_list_read(&list, path, NULL, &err)) {
        if (!strstr(err.text, path) || list.items || list.path) abort();
        unlink(path);
        return 0;
    }
    for (int i = 0; i < list.count; i++) check(&list, &list.items[i]);
    annotation_list_release(&list);
    unlink(path);
    return 0;
}
