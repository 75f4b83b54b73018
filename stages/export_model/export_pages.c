/* export_pages.c - see export_pages.h. */
#include "stages/export_model/export_pages.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/image/image.h"
#include "common/image/photo.h"
#include "common/product/product.h"
#include "common/texture/page_spread.h"

static const double saturated = 0.01;

enum status export_exposure(double *exposure, const struct atlas *a, const char *folder, struct err *err)
{
    float *values = NULL;
    size_t count = 0, room = 1;
    for (int i = 0; i < a->page_count; i++) room += (size_t)a->page_sizes[i][0] * (size_t)a->page_sizes[i][1];
    values = malloc(room * sizeof *values);
    if (!values) err_nomem(err, "texels", room * sizeof *values);
    for (int i = 0; !err->status && i < a->page_count; i++) {
        struct atlas_page page = {0};
        atlas_page_read(&page, a, i, folder, NULL, err);
        for (size_t k = 0; !err->status && k < (size_t)page.width * (size_t)page.height; k++) {
            const float *rgb = page.rgb + 3 * k, most = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
            if (page.source[k] != ATLAS_NONE && most > 0) values[count++] = most;
        }
        atlas_page_release(&page);
    }
    if (!err->status && count) sort_floats(values, count);
    *exposure = !err->status && count ? 1 / (double)values[(size_t)((1 - saturated) * (double)(count - 1))] : 1;
    free(values);
    return err->status;
}

static enum status write_page(const struct atlas_page *page, double exposure, const char *path, struct err *err)
{
    const size_t texels = (size_t)page->width * (size_t)page->height;
    struct image im = {0};
    unsigned char *bytes = malloc(3 * texels);
    if (bytes)
        image_init(&im, page->width, page->height, 3, err);
    else
        err_nomem(err, "a page", 3 * texels);
    for (size_t i = 0; !err->status && i < 3 * texels; i++) im.data[i] = (float)(exposure * (double)page->rgb[i]);
    if (!err->status) {
        image_to_srgb8(&im, bytes);
        png_write(path, bytes, page->width, page->height, 3, err);
    }
    image_release(&im);
    free(bytes);
    return err->status;
}

enum status export_pages_write(const struct atlas *a, const char *folder, double exposure, const char *out,
                               struct provenance *prov, struct err *err)
{
    for (int i = 0; !err->status && i < a->page_count; i++) {
        struct atlas_page page = {0};
        char path[FILE_PATH];
        atlas_page_read(&page, a, i, folder, prov, err);
        for (int t = 0; !err->status && t < a->tile_count; t++)
            if (a->tiles[t].page == i) page_spread(&page, &a->tiles[t], err);
        if (!err->status && !product_path_in(path, out, PRODUCT_EXPORT_PAGE, &(struct product_key){.page = i}, err))
            write_page(&page, exposure, path, err);
        atlas_page_release(&page);
    }
    return err->status;
}
