/* fuzz_thing_list.c - lists of things: any bytes give a list that can be used, written and read back, or an error with
 * the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/model/thing_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void use(const struct thing_list *list, int i)
{
    const struct thing *t = &list->things[i];
    if (!t->name || !t->view || thing_list_find(list, t->name) != i) abort();
    if (!thing_support_word(t->support) || t->voxels < 1 || t->views < 0) abort();
    if (!(t->low.x < t->high.x && t->low.y < t->high.y && t->low.z < t->high.z)) abort();
    for (int k = 0; k < 4; k++)
        if (!isfinite(t->rect[k])) abort();
}

static void is_same(const struct thing *a, const struct thing *b)
{
    if (strcmp(a->name, b->name) || strcmp(a->view, b->view) || a->support != b->support || a->voxels != b->voxels ||
        a->views != b->views)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct thing_list list, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (thing_list_read(&list, path, NULL, &err)) {
        if (!strstr(err.text, path) || list.things || list.count) abort();
    } else {
        for (int i = 0; i < list.count && i < 100; i++) use(&list, i);
        /* a name may be too long once it is quoted, and a box too small for the digits that are written */
        if (!thing_list_write(&list, path, NULL, &err)) {
            if (!thing_list_read(&again, path, NULL, &err)) {
                if (again.count != list.count) abort();
                for (int i = 0; i < list.count; i++) is_same(&list.things[i], &again.things[i]);
            } else if (!strstr(err.text, "without size") || again.things) {
                abort();
            }
            thing_list_release(&again);
        }
        thing_list_release(&list);
    }
    unlink(path);
    return 0;
}
