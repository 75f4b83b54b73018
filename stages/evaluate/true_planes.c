/* true_planes.c - see true_planes.h. */
#include "stages/evaluate/true_planes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/image/exr.h"

/* A channel of a true picture, and for each pixel of the rendered one the true pixel that it sees; -1: none. */
struct seen {
    struct exr_image picture;
    const struct exr_plane *plane;
    int32_t *index;
};

static void seen_release(struct seen *s)
{
    exr_image_release(&s->picture);
    free(s->index);
}

static enum status seen_read(struct seen *s, struct evaluation *e, const char *path, const char *channel,
                             const struct picture_map *map, struct err *err)
{
    const char *const names[] = {channel};
    const size_t pixels = (size_t)map->lens.width * (size_t)map->lens.height;
    char name[FILE_PATH];
    s->index = malloc(pixels * sizeof *s->index);
    if (!s->index) return err_nomem(err, "pixels", pixels * sizeof *s->index);
    snprintf(name, sizeof name, "truth%s", path + strlen(e->truth_folder));
    if (provenance_add_file(e->prov, name, path, err) || exr_read(&s->picture, path, names, 1, err)) return err->status;
    s->plane = exr_find(&s->picture, channel);
    true_pixels_seen(s->index, s->picture.width, s->picture.height, map);
    return ST_OK;
}

enum status true_ids_seen(uint32_t *ids, struct evaluation *e, const char *path, const struct picture_map *map,
                          struct err *err)
{
    const size_t pixels = (size_t)map->lens.width * (size_t)map->lens.height;
    struct seen s = {0};
    enum status st = seen_read(&s, e, path, "id", map, err);
    if (!st && !s.plane->u) st = err_set(err, ST_DATA, "%s: channel id holds no integers, wanted uint.", path);
    for (size_t i = 0; !st && i < pixels; i++) ids[i] = s.index[i] < 0 ? 0 : s.plane->u[s.index[i]];
    seen_release(&s);
    return st;
}

enum status true_depths_seen(float *depths, struct evaluation *e, const char *path, const struct picture_map *map,
                             struct err *err)
{
    const size_t pixels = (size_t)map->lens.width * (size_t)map->lens.height;
    struct seen s = {0};
    enum status st = seen_read(&s, e, path, "Z", map, err);
    if (!st && !s.plane->f) st = err_set(err, ST_DATA, "%s: channel Z holds integers, wanted float.", path);
    for (size_t i = 0; !st && i < pixels; i++) depths[i] = s.index[i] < 0 ? 0 : s.plane->f[s.index[i]];
    seen_release(&s);
    return st;
}

bool true_plain_file(char path[FILE_PATH], const struct evaluation *e, const char *kind, const char *name)
{
    static const char *const folders[] = {"", "novel/"};
    for (int k = 0; k < 2; k++) {
        const int n = snprintf(path, FILE_PATH, "%s/%s%s/%s.exr", e->truth_folder, folders[k], kind, name);
        if (n > 0 && n < FILE_PATH && path_is_file(path)) return true;
    }
    return false;
}
