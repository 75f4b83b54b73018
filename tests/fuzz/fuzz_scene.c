/* fuzz_scene.c - scene files: any bytes give faces with finite areas and textures within their bounds, or an error
 * message. An edit may change base.txt; its full description is read again. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/simulate/geometry.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check_scene(const struct scene *s)
{
    struct scene_geometry g;
    struct err err = ERR_INIT;
    for (int i = 0; i < s->texture_count; i++)
        for (int k = 0; k < 16; k++) {
            const struct rgb c = texture_at(&s->textures[i].texture, 7, k * 0.37 - 2, k * k * 0.11 - 3);
            if (!(c.r >= 0 && c.g >= 0 && c.b >= 0 && rgb_max(c) <= texture_bound(&s->textures[i].texture) + 1e-9))
                abort();
        }
    if (geometry_init(&g, s, &err)) {
        if (!err.text[0]) abort();
        return;
    }
    for (int i = 0; i < g.face_count; i++) {
        const struct scene_face *f = &g.faces[i];
        if (!(f->area >= 0) || !isfinite(f->area) || f->item < 0 || f->item >= s->item_count) abort();
        if (f->material >= s->material_count || !(vec3_length(f->normal) < 1.001)) abort();
    }
    geometry_release(&g);
}

#define BASE                                                                                                \
    "remodel-scene 2\ntexture t rgb 0.5 0.5 0.5\nmaterial m lambert t\nroom r 0 0 4 3 0 2 m m\n"            \
    "wall w 0 0 4 0 0 2 0.2 m\nopening o w 1 2 0 1.5\nwall v 4 0 4 3 0 2 0.2 m\nwindow win v 1 2 0.5 1.5\n" \
    "furniture on\nbox b 1 1 0 2 2 1 m\nsun 0 40 1 9 9 9\npanorama 1 2 2 2 1 1 1\n"

static void write_file(const char *path, const void *data, size_t size)
{
    FILE *fp = fopen(path, "wb");
    if (!fp || fwrite(data, 1, size, fp) != size || fclose(fp)) abort();
}

/* The full description of an edit has the same items. */
static void check_whole(const struct scene *s, const char *folder)
{
    char path[FUZZ_PATH + 64];
    struct scene whole;
    struct err err = ERR_INIT;
    snprintf(path, sizeof path, "%s/whole.txt", folder);
    if (scene_write(s, folder, "scene.txt", path, &err) || scene_read(&whole, folder, "whole.txt", NULL, &err)) {
        fprintf(stderr, "%s\n", err.text);
        abort();
    }
    if (whole.item_count != s->item_count || whole.base) abort();
    for (int i = 0; i < s->item_count; i++)
        if (strcmp(whole.items[i].name, s->items[i].name) || whole.items[i].furniture != s->items[i].furniture) abort();
    scene_release(&whole);
    unlink(path);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[FUZZ_PATH], path[FUZZ_PATH + 64], base[FUZZ_PATH + 64];
    struct scene s;
    struct err err = ERR_INIT;
    fuzz_folder(folder);
    snprintf(path, sizeof path, "%s/scene.txt", folder);
    snprintf(base, sizeof base, "%s/base.txt", folder);
    write_file(path, data, size);
    write_file(base, BASE, sizeof BASE - 1);
    if (scene_read(&s, folder, "scene.txt", NULL, &err)) {
        if (!err.text[0] || s.items) abort();
    } else {
        check_scene(&s);
        if (s.base) check_whole(&s, folder);
        scene_release(&s);
    }
    unlink(path);
    unlink(base);
    rmdir(folder);
    return 0;
}
