/* upright.c - see upright.h. */
#include "common/upright.h"

#include <stdio.h>

#include "common/lens_list.h"
#include "common/photo_list.h"

enum { PATH_SIZE = 4096 };

static enum status join(char out[PATH_SIZE], const char *folder, const char *file, const char *suffix, struct err *err)
{
    if (snprintf(out, PATH_SIZE, "%s/%s%s", folder, file, suffix) < PATH_SIZE) return ST_OK;
    return err_set(err, ST_IO, "the path %s/%s%s is too long.", folder, file, suffix);
}

struct vec3 upright_from_orientation(int orientation)
{
    switch (orientation) {
    case 3:
    case 4:
        return vec3_make(0, 1, 0); /* the first row is at the bottom */
    case 5:
    case 6:
        return vec3_make(-1, 0, 0); /* the first column is at the top */
    case 7:
    case 8:
        return vec3_make(1, 0, 0);
    default:
        return vec3_make(0, -1, 0);
    }
}

enum status upright_read(struct vec3 *ups, const struct camera_set *set, const char *views, const char *records,
                         struct provenance *prov, struct err *err)
{
    struct lens_list lenses = {0};
    char path[PATH_SIZE], name[PATH_SIZE];
    enum status st = join(path, views, "lenses.txt", "", err) || lens_list_read(&lenses, path, err) ||
                             provenance_add_file(prov, "views/lenses.txt", path, err)
                         ? err->status
                         : ST_OK;
    for (int i = 0; !st && i < set->view_count; i++) {
        struct photo_record record = {0};
        int at = lens_list_find(&lenses, set->views[i].name);
        if (at < 0) {
            st = err_set(err, ST_DATA, "%s has no view %s, but images.txt has. Import the views again.", path,
                         set->views[i].name);
            break;
        }
        const struct lens *lens = &lenses.lenses[at];
        char record_path[PATH_SIZE];
        st = photo_record_read(&record, records, lens->photo, err);
        if (!st) st = join(record_path, records, lens->photo, ".txt", err);
        if (!st) st = join(name, "photos", lens->photo, ".txt", err);
        if (!st) st = provenance_add_file(prov, name, record_path, err);
        if (!st)
            ups[i] =
                mat3_apply(mat3_from_quat(lens->view_from_photo), upright_from_orientation(record.info.orientation));
        photo_record_release(&record);
    }
    lens_list_release(&lenses);
    return st;
}
