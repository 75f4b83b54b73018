/* level_file.c - see level_file.h. Column g of the picture is group g, row p is point p. */
#include "stages/light_levels/level_file.h"

#include <stdio.h>
#include <string.h>

#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/image/exr.h"
#include "common/product/product.h"

static void put_name(FILE *to, const char *name, struct err *err)
{
    char quoted[1024];
    if (!textfile_quote(name, quoted, sizeof quoted, err)) fprintf(to, " %s\n", quoted);
}

static void put_groups(FILE *to, const struct light_groups *g, struct err *err)
{
    for (int i = 0; i < g->rest; i++) {
        fprintf(to, "group %d lamp", i);
        put_name(to, g->field->lights.lamps[i].name, err);
    }
    fprintf(to, "group %d rest\n", g->rest);
    for (int w = 0; w < g->windows_count; w++) {
        fprintf(to, "group %d sky", g->sky + w);
        put_name(to, g->windows[w].name, err);
        fprintf(to, "group %d sun", g->sun + w);
        put_name(to, g->windows[w].name, err);
        fprintf(to, "groups %d %d patches", groups_patch(g, w, 0), g->patches.count);
        put_name(to, g->windows[w].name, err);
        fprintf(to, "groups %d %d beams", groups_beam(g, w, 0), g->patches.count);
        put_name(to, g->windows[w].name, err);
    }
    for (int i = g->planned; i < g->count; i++) {
        fprintf(to, "group %d planned", i);
        put_name(to, g->planned_lamps->list[i - g->planned].name, err);
    }
}

static void put_points(FILE *to, const struct sensors *s, struct err *err)
{
    for (int k = 0; k < s->area_count; k++) {
        const struct sensor_area *a = &s->areas[k];
        fprintf(to, "area %s %d %d", sensor_kind_word(a->kind), a->first, a->count);
        put_name(to, a->name, err);
    }
    for (int i = 0; i < s->count; i++)
        fprintf(to, "point %.9g %.9g %.9g\n", s->points[i].at.x, s->points[i].at.y, s->points[i].at.z);
}

static enum status write_text(const struct sensors *s, const struct light_groups *g, const char *folder,
                              const struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    struct outfile f = {0};
    if (product_path_in(path, folder, PRODUCT_LIGHT_LEVELS, &(struct product_key){0}, err) ||
        product_begin(&f, PRODUCT_LIGHT_LEVELS, path, prov, err))
        return err->status;
    const locale_t was = uselocale(scan_c_locale());
    put_groups(f.fp, g, err);
    put_points(f.fp, s, err);
    uselocale(was);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

static enum status add_plane(struct exr_image *im, const char *name, const float *values, struct err *err)
{
    struct exr_plane *plane;
    if (exr_add_plane(im, name, EXR_FLOAT, &plane, err)) return err->status;
    memcpy(plane->f, values, (size_t)im->width * (size_t)im->height * sizeof *values);
    return ST_OK;
}

enum status level_file_write(const struct level_points *points, const struct sensors *sensors,
                             const struct light_groups *groups, const char *folder, const struct provenance *prov,
                             struct err *err)
{
    char path[FILE_PATH];
    struct exr_image im = {0};
    if (!points->count) return write_text(sensors, groups, folder, prov, err);
    if (!product_path_in(path, folder, PRODUCT_LIGHT_COEFFICIENTS, &(struct product_key){0}, err) &&
        !exr_image_init(&im, points->groups, points->count, err) && !add_plane(&im, "direct", points->direct, err) &&
        !add_plane(&im, "whole", points->whole, err) && !exr_write(&im, path, prov, err))
        write_text(sensors, groups, folder, prov, err);
    exr_image_release(&im);
    return err->status;
}
