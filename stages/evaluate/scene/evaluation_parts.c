/* evaluation_parts.c - helpers of the groups of metrics. */
#include "stages/evaluate/scene/evaluation_parts.h"

#include <stdio.h>

enum status evaluation_path(char path[FILE_PATH], const struct evaluation *e, enum product_id id,
                            const struct product_key *key, struct err *err)
{
    char name[FILE_PATH];
    if (product_path(name, id, key, err)) return err->status;
    return file_path(path, products[id].root == PRODUCT_SHARED ? e->shared : e->folder, name, "", err);
}

int evaluation_photo(const struct evaluation *e, const struct view_set *set, int view)
{
    return photo_list_find_id(&e->photos, photo_lens_of_view(&set->cameras, &set->lenses, view)->photo);
}

struct picture_map evaluation_map_of_view(const struct view_set *set, int view)
{
    const struct view *v = &set->cameras.views[view];
    const struct lens *lens = photo_lens_of_view(&set->cameras, &set->lenses, view);
    return (struct picture_map){{CAMERA_PINHOLE, v->width, v->height, {v->fx, v->fy, v->cx, v->cy}},
                                lens->camera,
                                mat3_transpose(mat3_from_quat(lens->view_from_photo))};
}

enum status evaluation_metric(struct evaluation *e, const char *view, const char *prefix, const char *name,
                              double value, struct err *err)
{
    char text[METRIC_NAME];
    const int length = snprintf(text, sizeof text, "%s.%s", prefix, name);
    if (length < 0 || length >= (int)sizeof text)
        return err_set(err, ST_INTERNAL, "the name of the metric %s.%s is too long.", prefix, name);
    return metric_add(&e->table, view, text, value, err);
}

void evaluation_set_white(struct evaluation *e)
{
    e->white = e->params->white > 0 ? e->params->white : e->radiance_scale;
}
