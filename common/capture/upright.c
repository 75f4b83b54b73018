/* upright.c - the upright direction of photographs in the cameras of their views. */
#include "common/capture/upright.h"

#include "common/capture/lens_list.h"
#include "common/capture/photo_list.h"
#include "common/product/product.h"

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
    char path[FILE_PATH];
    if (!product_path_in(path, views, PRODUCT_LENSES, NULL, err)) lens_list_read(&lenses, path, prov, err);
    for (int i = 0; !err->status && i < set->view_count; i++) {
        struct photo_record record = {0};
        int at = lens_list_find(&lenses, set->views[i].name);
        if (at < 0) {
            err_set(err, ST_DATA, "%s has no view %s, which is in images.txt; import the views again.", path,
                    set->views[i].name);
            break;
        }
        const struct lens *lens = &lenses.lenses[at];
        photo_record_read(&record, records, lens->photo, prov, err);
        if (!err->status)
            ups[i] =
                mat3_apply(mat3_from_quat(lens->view_from_photo), upright_from_orientation(record.info.orientation));
        photo_record_release(&record);
    }
    lens_list_release(&lenses);
    return err->status;
}

struct vec3 upright_mean(const struct camera_set *set, const struct vec3 *ups)
{
    struct vec3 sum = {0, 0, 0};
    for (int i = 0; i < set->view_count; i++) {
        const struct vec3 up = ups ? ups[i] : vec3_make(0, -1, 0);
        sum = vec3_add(sum, mat3_apply(mat3_transpose(set->views[i].cam_from_world), up));
    }
    return vec3_normalize(sum);
}
