/* shell_doubles.h - what tests of the shell take in place of common/texture/{texture_map,outdoors}.c: maps are filled
 * by hand, and outdoors is a formula of the direction. */
#ifndef REMODEL_TESTS_SHELL_DOUBLES_H
#define REMODEL_TESTS_SHELL_DOUBLES_H

#include <stdlib.h>
#include <string.h>

#include "common/texture/outdoors.h"
#include "common/texture/texture_map.h"

static inline void outdoors_formula(float rgb[3], struct vec3 direction)
{
    const struct vec3 d = vec3_normalize(direction);
    rgb[0] = (float)(2 + d.x), rgb[1] = (float)(2 + d.y), rgb[2] = (float)(2 + d.z);
}

__attribute__((weak)) enum outdoors_source outdoors_sample(float rgb[3], const struct outdoors *o,
                                                           struct vec3 direction)
{
    (void)o;
    outdoors_formula(rgb, direction);
    return OUTDOORS_REFERENCE;
}

__attribute__((weak)) void texture_map_release(struct texture_map *map)
{
    for (int i = 0; i < map->face_count; i++) {
        for (int k = 0; k < map->faces[i].rule_count; k++) free(map->faces[i].rules[k].lit);
        free(map->faces[i].rules);
    }
    free(map->faces);
    memset(map, 0, sizeof *map);
}

__attribute__((weak)) enum status texture_map_read(struct texture_map *map, const char *path, struct provenance *prov,
                                                   struct err *err)
{
    (void)prov;
    memset(map, 0, sizeof *map);
    return err_set(err, ST_INTERNAL, "tests fill texture maps by hand, so that %s is not read.", path);
}

#endif
