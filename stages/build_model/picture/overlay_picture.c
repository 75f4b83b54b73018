/* overlay_picture.c - a model's edges on a photograph. */
#include "stages/build_model/picture/overlay_picture.h"

#include <stdlib.h>

#include "stages/build_model/picture/overlay_edges.h"
#include "stages/build_model/picture/raster.h"

struct picture {
    unsigned char *rgb;
    int width, height;
};

static void draw_dot(void *ctx, const struct overlay_dot *dot)
{
    static const unsigned char seen[3] = {255, 70, 20}, blue[3] = {60, 150, 255}, hidden[3] = {250, 240, 90};
    const struct picture *p = ctx;
    raster_dot(p->rgb, p->width, p->height, dot->u, dot->v, dot->seen ? 0.9 : 0.3,
               dot->glass  ? blue
               : dot->seen ? seen
                           : hidden,
               dot->seen ? 0.75 : 0.22);
}

/* The photo, downsampled by an integer factor. */
static enum status shrink(unsigned char **rgb, int *width, int *height, double *scale, const struct photo *photo,
                          int side, struct err *err)
{
    const int longest = photo->info.width > photo->info.height ? photo->info.width : photo->info.height;
    const int k = (longest + side - 1) / side, shift = photo->info.bits == 16 ? 8 : 0;
    *width = photo->info.width / k;
    *height = photo->info.height / k;
    *scale = 1.0 / k;
    if (*width < 1 || *height < 1) *width = *height = 1;
    *rgb = malloc(3 * (size_t)*width * (size_t)*height);
    if (!*rgb) return err_nomem(err, "a picture", 3 * (size_t)*width * (size_t)*height);
    for (int y = 0; y < *height; y++)
        for (int x = 0; x < *width; x++)
            for (int c = 0; c < 3; c++) {
                int sum = 0, n = 0;
                for (int j = y * k; j < y * k + k && j < photo->info.height; j++)
                    for (int i = x * k; i < x * k + k && i < photo->info.width; i++, n++)
                        sum += photo->samples[3 * ((size_t)j * (size_t)photo->info.width + (size_t)i) + (size_t)c] >>
                               shift;
                (*rgb)[3 * ((size_t)y * (size_t)*width + (size_t)x) + (size_t)c] = (unsigned char)(sum / (n ? n : 1));
            }
    return ST_OK;
}

enum status overlay_write(const struct solid_mesh *mesh, const struct photo_camera *camera, const struct photo *photo,
                          int side, const char *path, struct err *err)
{
    struct picture p = {0};
    double scale = 1;
    if (!shrink(&p.rgb, &p.width, &p.height, &scale, photo, side, err)) {
        const struct overlay_edges how = {camera, scale, p.width, p.height, .apart = 0.7, .steps = 4096};
        if (!overlay_edges_trace(mesh, &how, draw_dot, &p, err)) jpeg_write(path, p.rgb, p.width, p.height, 88, err);
    }
    free(p.rgb);
    return err->status;
}
