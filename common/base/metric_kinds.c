/* metric_kinds.c - the table of metrics, and look-ups by name. */
#include "common/base/metric_kinds.h"

#include <fnmatch.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

enum { NAME_SIZE = 128 };

enum group {
    holdout,
    camera,
    depth,
    axes,
    walls,
    faces,
    radiance,
    rendered,
    revealed,
    relit,
    shell,
    textures,
    heldout_textures,
    irradiance,
    irradiance_pictures,
};

static const char *const prefixes[][2] = {
    [holdout] = {"holdout"},
    [camera] = {"camera"},
    [depth] = {"depth"},
    [axes] = {"axes"},
    [walls] = {"model", "edited.*"},
    [faces] = {"model", "edited.*"},
    [radiance] = {"radiance", "radiance.merged"},
    [rendered] = {"novel", "edited.*"},
    [revealed] = {"edited.*"},
    [relit] = {"edited.*"},
    [shell] = {"shell"},
    [textures] = {"texture", "texture.vita"},
    [heldout_textures] = {"texture", "texture.vita"},
    [irradiance] = {"irradiance"},
    [irradiance_pictures] = {"irradiance"},
};

static const struct row {
    enum group group;
    const char *name;
    struct metric_kind kind;
} rows[] = {
#define METRIC(group, name, unit, direction, meaning, definition) {group, name, {unit, direction, meaning}},
#include "common/base/metric_kinds.def"
#undef METRIC
};

static bool fits(const struct row *r, const char *name)
{
    for (int k = 0; k < 2; k++) {
        const char *prefix = prefixes[r->group][k];
        char pattern[NAME_SIZE];
        if (!prefix || prefix[0] != name[0]) continue;
        snprintf(pattern, sizeof pattern, "%s.%s", prefix, r->name);
        if (!fnmatch(pattern, name, 0)) return true;
    }
    return false;
}

bool metric_kind_find(struct metric_kind *kind, const char *name)
{
    const struct row *r = rows, *end = rows + sizeof rows / sizeof *rows;
    while (r < end && !fits(r, name)) r++;
    if (r == end) return false;
    *kind = r->kind;
    if (*kind->unit) return true;
    struct metric_kind base;
    const char *suffix = strrchr(name, '_');
    char base_name[NAME_SIZE];
    snprintf(base_name, sizeof base_name, "%.*s", (int)(suffix - name), name);
    if (!metric_kind_find(&base, base_name)) return false;
    kind->unit = base.unit;
    kind->direction = base.direction;
    return true;
}
