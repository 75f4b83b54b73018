/* fuzz_texture_map.c - texture.txt: any bytes give a map that can be looked up, written and read back, or a message. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/texture/texture_map.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void look_up(const struct texture_map *map)
{
    for (int i = 0; i < map->face_count; i++) {
        const struct texture_face *f = &map->faces[i];
        if (i && f[-1].id > f->id) abort();
        if (!texture_map_find(map, f->id, vec3_make(1, 2, 3))) abort();
        for (int k = 0; k < f->rule_count; k++) {
            texture_rule_holds(&f->rules[k], f->normal, vec3_make(0.5, 0.5, 0));
            texture_rule_place(&f->rules[k], vec3_make(0.5, 0.5, 0));
        }
    }
    texture_map_clears(map, vec3_make(0.5, 0.5, 1));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct texture_map map, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (texture_map_read(&map, path, NULL, &err)) {
        if (!strstr(err.text, path) || map.faces || map.zones || map.base) abort();
    } else {
        look_up(&map);
        /* a name may be too long once it is quoted */
        if (!texture_map_write(&map, path, NULL, &err)) {
            if (texture_map_read(&again, path, NULL, &err)) abort();
            if (again.face_count != map.face_count || again.zone_count != map.zone_count) abort();
            if (again.thing_count != map.thing_count) abort();
            texture_map_release(&again);
        }
        texture_map_release(&map);
    }
    unlink(path);
    return 0;
}
