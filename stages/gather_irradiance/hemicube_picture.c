/* hemicube_picture.c - see hemicube_picture.h. */
#include "stages/gather_irradiance/hemicube_picture.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/image/draw.h"
#include "common/image/photo.h"
#include "stages/gather_irradiance/unfold.h"

enum { QUALITY = 90, CORNER = 110, STRIPE = 10 /* px */ };

struct sketch {
    const struct light_field *field;
    struct gather_point at;
    struct vec3 right, down;
    int n;
    struct image light;      /* R G B A; A is 0 in the corners */
    unsigned char *is_known; /* of each pixel: a picture shows what is there */
};

static bool is_known(enum light_source source)
{
    return source != LIGHT_NONE && source != LIGHT_SYNTHESISED && source != LIGHT_SKY_GUESSED;
}

static void look_at(struct sketch *s, int x, int y)
{
    struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
    struct light_look seen[RAY_PACKET] = {0};
    unsigned active = 0;
    for (int k = 0; k < RAY_PACKET; k++) {
        struct vec3 d = {0, 0, 1};
        if (unfold_direction(&d, s->n, x + k, y)) active |= 1u << k;
        const struct vec3 flat = vec3_add(vec3_scale(s->right, d.x), vec3_scale(s->down, d.y));
        direction[k] = vec3_normalize(vec3_add(flat, vec3_scale(s->at.normal, d.z)));
        from[k] = s->at.at;
    }
    if (!active) return;
    s->field->look(s->field->ctx, from, s->at.normal, direction, active, seen);
    for (int k = 0; k < RAY_PACKET; k++) {
        if (!(active >> k & 1)) continue;
        float *to = image_at(&s->light, x + k, y);
        to[0] = (float)seen[k].radiance.r;
        to[1] = (float)seen[k].radiance.g;
        to[2] = (float)seen[k].radiance.b;
        to[3] = 1;
        s->is_known[(size_t)y * (size_t)s->light.width + (size_t)(x + k)] = is_known(seen[k].source);
    }
}

static void look_at_rows(void *ctx, size_t begin, size_t end, int thread)
{
    struct sketch *s = ctx;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < s->light.width; x += RAY_PACKET) look_at(s, x, y);
}

static void mark_unknown(unsigned char *rgb, const struct sketch *s)
{
    const int side = s->light.width;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            const size_t at = (size_t)y * (size_t)side + (size_t)x;
            unsigned char *to = rgb + 3 * at;
            if (!(s->light.data[4 * at + 3] > 0))
                memset(to, CORNER, 3);
            else if (!s->is_known[at] && (x + y) % (2 * STRIPE) < STRIPE / 2)
                for (int c = 0; c < 3; c++) to[c] = (unsigned char)((to[c] + 128) / 2);
        }
}

static void draw_folds(unsigned char *rgb, int n)
{
    static const unsigned char colour[3] = {255, 255, 255};
    const struct canvas k = {rgb, 2 * n, 2 * n};
    const double low = n / 2, high = n / 2 + n;
    draw_line(&k, low, low, high, low, 0.6, colour);
    draw_line(&k, low, high, high, high, 0.6, colour);
    draw_line(&k, low, low, low, high, 0.6, colour);
    draw_line(&k, high, low, high, high, 0.6, colour);
}

enum status hemicube_picture_write(const struct light_field *f, struct gather_point p, int n, const char *path,
                                   struct err *err)
{
    const int side = 2 * n;
    const size_t pixels = (size_t)side * (size_t)side;
    struct sketch s = {.field = f, .at = p, .n = n, .is_known = calloc(pixels, 1)};
    unsigned char *rgb = malloc(3 * pixels);
    if (s.is_known && rgb)
        image_init(&s.light, side, side, 4, err);
    else
        err_nomem(err, "a picture of a hemicube", 4 * pixels);
    unfold_frame(&s.right, &s.down, p.normal);
    if (!err->status) parallel_for((size_t)side, 8, look_at_rows, &s);
    if (!err->status && !image_expose(&s.light, 0.9, 0.5, err)) {
        image_to_srgb8(&s.light, rgb);
        mark_unknown(rgb, &s);
        draw_folds(rgb, n);
        jpeg_write(path, rgb, side, side, QUALITY, err);
    }
    image_release(&s.light);
    free(s.is_known);
    free(rgb);
    return err->status;
}
