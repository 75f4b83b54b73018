/* exr.c - OpenEXR images in memory. */
#include "common/image/exr.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/image/exr_file.h"
#include "common/image/samples.h"

enum status exr_image_init(struct exr_image *im, int width, int height, struct err *err)
{
    *im = (struct exr_image){0};
    if (width < 1 || height < 1 || (int64_t)width * height > EXR_MAX_PIXELS)
        return err_set(err, ST_DATA, "an image of %d x %d pixels is not possible; the limits are 1 and 2^28 pixels.",
                       width, height);
    im->width = width;
    im->height = height;
    return ST_OK;
}

enum status exr_add_plane(struct exr_image *im, const char *name, enum exr_type type, struct exr_plane **plane,
                          struct err *err)
{
    if (!*name || strlen(name) >= EXR_NAME_SIZE)
        return err_set(err, ST_DATA, "the channel name \"%s\" is not possible; a name has 1 to %d characters.", name,
                       EXR_NAME_SIZE - 1);
    if (exr_find(im, name))
        return err_set(err, ST_DATA, "the channel %s exists already; give each channel its own name.", name);

    if (array_append(&im->planes, (size_t)im->count, sizeof *im->planes, "channels", err)) return err->status;
    size_t samples = (size_t)im->width * (size_t)im->height;
    void *data = samples_alloc((samples + EXR_PADDING) * 4);
    if (!data) return err_nomem(err, "a channel", samples * 4);

    struct exr_plane *p = &im->planes[im->count++];
    *p = (struct exr_plane){.type = type};
    strcpy(p->name, name);
    if (type == EXR_UINT)
        p->u = data;
    else
        p->f = data;
    if (plane) *plane = p;
    return ST_OK;
}

enum status exr_init_rgba(struct exr_image *im, const float *rgba, int width, int height, struct err *err)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    exr_image_init(im, width, height, err);
    for (size_t c = 0; !err->status && c < 4; c++) {
        struct exr_plane *plane;
        exr_add_plane(im, names[c], EXR_HALF, &plane, err);
        for (size_t p = 0; !err->status && p < (size_t)width * (size_t)height; p++) plane->f[p] = rgba[4 * p + c];
    }
    return err->status;
}

struct exr_plane *exr_find(const struct exr_image *im, const char *name)
{
    for (int i = 0; i < im->count; i++)
        if (!strcmp(im->planes[i].name, name)) return &im->planes[i];
    return NULL;
}

enum status exr_set_attribute(struct exr_image *im, const char *name, const char *value, struct err *err)
{
    if (!*name || strlen(name) >= sizeof im->attributes[0][0] || strlen(value) >= sizeof im->attributes[0][1])
        return err_set(err, ST_DATA,
                       "the attribute %s is too long; its name and value may have at most %zu characters each.", name,
                       sizeof im->attributes[0][0] - 1);
    int at = 0;
    while (at < im->attribute_count && strcmp(im->attributes[at][0], name)) at++;
    if (at == im->attribute_count) {
        if (array_append(&im->attributes, (size_t)at, sizeof *im->attributes, "attributes", err)) return err->status;
        im->attribute_count++;
        strcpy(im->attributes[at][0], name);
    }
    strcpy(im->attributes[at][1], value);
    return ST_OK;
}

enum status exr_set_number(struct exr_image *im, const char *name, double value, struct err *err)
{
    char text[32];
    snprintf(text, sizeof text, "%.9g", value);
    return exr_set_attribute(im, name, text, err);
}

const char *exr_attribute(const struct exr_image *im, const char *name)
{
    for (int i = 0; i < im->attribute_count; i++)
        if (!strcmp(im->attributes[i][0], name)) return im->attributes[i][1];
    return NULL;
}

void exr_image_release(struct exr_image *im)
{
    if (!im) return;
    for (int i = 0; i < im->count; i++) {
        free(im->planes[i].f);
        free(im->planes[i].u);
    }
    free(im->planes);
    free(im->attributes);
    *im = (struct exr_image){0};
}
