/* fuzz_materials.c - readers of materials.txt, written by hand and by fit_materials: any bytes give usable materials,
 * or an error that names the file; what was read is written and read back. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/fit_materials/marked_materials.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check_regions(const struct material_list *l)
{
    for (int i = 0; i < l->count; i++)
        for (int k = 0; k < l->items[i].region_count; k++) {
            const struct material_region *r = &l->items[i].regions[k];
            if (r->corners < 3 || !(material_region_area(r) > 0)) abort();
            material_region_holds(r, r->pixel[0], r->pixel[1]);
        }
}

static void check_fitted(const char *path)
{
    struct material_list l = {0}, again = {0};
    const struct provenance prov = {.stage = "fuzz", .version = "0"};
    struct err err = ERR_INIT;
    if (material_list_read(&l, path, NULL, &err)) {
        if (!strstr(err.text, path) || l.count) abort();
        return;
    }
    check_regions(&l);
    for (int i = 0; i < l.count; i++) {
        const struct material *m = &l.items[i];
        for (int c = 0; c < 3; c++)
            if (!(m->k_d[c] >= 0 && isfinite(m->k_d[c]))) abort();
        if (!(m->ks >= 0 && isfinite(m->ks)) || !(m->shape >= 0 && m->shape <= MATERIAL_PHONG_MAX)) abort();
    }
    if (material_list_write(&l, path, &prov, &err) || material_list_read(&again, path, NULL, &err)) abort();
    if (again.count != l.count) abort();
    for (int i = 0; i < l.count; i++)
        if (strcmp(l.items[i].name, again.items[i].name) || l.items[i].ks != again.items[i].ks ||
            l.items[i].region_count != again.items[i].region_count)
            abort();
    material_list_release(&l);
    material_list_release(&again);
}

static void check_marked(const char *path)
{
    struct marked_materials m = {0};
    struct err err = ERR_INIT;
    if (marked_materials_read(&m, path, NULL, &err)) {
        if (!strstr(err.text, path) || m.list.count || m.declared) abort();
        return;
    }
    if (m.list.count < 1) abort();
    check_regions(&m.list);
    marked_materials_release(&m);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    fuzz_file(path, data, size);
    check_marked(path);
    check_fitted(path);
    unlink(path);
    return 0;
}
