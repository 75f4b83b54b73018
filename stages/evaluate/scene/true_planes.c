/* true_planes.c - see true_planes.h. */
#include "stages/evaluate/scene/true_planes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/image/exr.h"
#include "stages/evaluate/truth/linear_picture.h"

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
    picture_true_pixels(s->index, s->picture.width, s->picture.height, map);
    return ST_OK;
}

enum status true_ids_seen(uint32_t *ids, struct evaluation *e, const char *path, const struct picture_map *map,
                          struct err *err)
{
    const size_t pixels = (size_t)map->lens.width * (size_t)map->lens.height;
    struct seen s = {0};
    seen_read(&s, e, path, "id", map, err);
    if (!err->status && !s.plane->u) err_set(err, ST_DATA, "%s: channel id holds no integers, wanted uint.", path);
    for (size_t i = 0; !err->status && i < pixels; i++) ids[i] = s.index[i] < 0 ? 0 : s.plane->u[s.index[i]];
    seen_release(&s);
    return err->status;
}

enum status true_depths_seen(float *depths, struct evaluation *e, const char *path, const struct picture_map *map,
                             struct err *err)
{
    const size_t pixels = (size_t)map->lens.width * (size_t)map->lens.height;
    struct seen s = {0};
    seen_read(&s, e, path, "Z", map, err);
    if (!err->status && !s.plane->f) err_set(err, ST_DATA, "%s: channel Z holds integers, wanted float.", path);
    for (size_t i = 0; !err->status && i < pixels; i++) depths[i] = s.index[i] < 0 ? 0 : s.plane->f[s.index[i]];
    seen_release(&s);
    return err->status;
}

enum status true_colours_seen(float *rgb, struct evaluation *e, const char *path, const struct picture_map *map,
                              struct err *err)
{
    const size_t pixels = (size_t)map->lens.width * (size_t)map->lens.height;
    struct linear_picture p = {0};
    char name[FILE_PATH];
    int32_t *index = malloc(pixels * sizeof *index);
    snprintf(name, sizeof name, "truth%.4000s", path + strlen(e->truth_folder));
    if (!index) err_nomem(err, "pixels", pixels * sizeof *index);
    if (!err->status && !provenance_add_file(e->prov, name, path, err) && !linear_picture_read(&p, path, err))
        picture_true_pixels(index, p.rgb.width, p.rgb.height, map);
    for (size_t i = 0; !err->status && i < pixels; i++)
        for (size_t c = 0; c < 3; c++) rgb[3 * i + c] = index[i] < 0 ? 0 : p.rgb.data[3 * (size_t)index[i] + c];
    linear_picture_release(&p);
    free(index);
    return err->status;
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

enum status true_planes_read(struct surface_planes *p, bool *found, struct evaluation *e, const struct true_set *set,
                             const char *name, const struct picture_map *map, struct err *err)
{
    const size_t pixels = (size_t)map->lens.width * (size_t)map->lens.height;
    char paths[4][FILE_PATH];
    *p = (struct surface_planes){{NULL, NULL}, {NULL, NULL}};
    *found = true_plain_file(paths[0], e, "ids", name) && true_set_file(paths[1], set, "ids", name) &&
             true_plain_file(paths[2], e, "depth", name) && true_set_file(paths[3], set, "depth", name);
    for (int k = 0; *found && !err->status && k < 2; k++) {
        p->ids[k] = malloc(pixels * sizeof *p->ids[k]);
        p->depths[k] = malloc(pixels * sizeof *p->depths[k]);
        if (!p->ids[k] || !p->depths[k]) err_nomem(err, "ids and depths", pixels * sizeof *p->ids[k]);
        if (!err->status && !true_ids_seen(p->ids[k], e, paths[k], map, err))
            true_depths_seen(p->depths[k], e, paths[2 + k], map, err);
    }
    return err->status;
}

void true_planes_release(struct surface_planes *p)
{
    for (int k = 0; k < 2; k++) {
        free(p->ids[k]);
        free(p->depths[k]);
    }
    *p = (struct surface_planes){{NULL, NULL}, {NULL, NULL}};
}
