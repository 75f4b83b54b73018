/* evaluation_parts.c - helpers of the groups of metrics. */
#include "stages/evaluate/evaluation_parts.h"

enum status evaluation_input(struct evaluation *e, char path[FILE_PATH], const char *where, const char *file,
                             const char *suffix, struct err *err)
{
    char name[FILE_PATH];
    if (file_path(name, where, file, suffix, err) || file_path(path, e->folder, name, "", err)) return err->status;
    return provenance_add_file(e->prov, name, path, err);
}

const struct lens *lens_of_view(const struct view_set *set, int view)
{
    return &set->lenses.lenses[lens_list_find(&set->lenses, set->cameras.views[view].name)];
}

int photo_of_view(const struct evaluation *e, const struct view_set *set, int view)
{
    return photo_list_find_id(&e->photos, lens_of_view(set, view)->photo);
}
