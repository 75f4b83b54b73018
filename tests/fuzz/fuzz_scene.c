/* fuzz_scene.c - scene files: any bytes give faces with finite areas and textures within their bounds, or an error
 * message. Bytes that do not begin with "remodel" are read as a mesh. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/simulate/geometry.h"
#include "stages/simulate/mesh_file.h"
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

static void check_mesh(const char *path)
{
    struct vec3(*triangles)[3];
    struct err err = ERR_INIT;
    int count;
    if (mesh_file_read(&triangles, &count, path, &err) ? !err.text[0] : count < 1) abort();
    free(triangles);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[FUZZ_PATH], path[FUZZ_PATH + 64];
    struct scene s;
    struct err err = ERR_INIT;
    fuzz_folder(folder);
    snprintf(path, sizeof path, "%s/scene.txt", folder);
    FILE *fp = fopen(path, "wb");
    if (!fp || fwrite(data, 1, size, fp) != size || fclose(fp)) abort();
    if (size < 7 || memcmp(data, "remodel", 7)) {
        check_mesh(path);
    } else if (scene_read(&s, folder, "scene.txt", NULL, &err)) {
        if (!err.text[0] || s.items) abort();
    } else {
        check_scene(&s);
        scene_release(&s);
    }
    unlink(path);
    rmdir(folder);
    return 0;
}
