/* eyes_picture.c - one picture of those of two eyes.
 *
 * An anaglyph mixes both pictures with the matrices of [Dubois 2001], which bring what each eye sees through the
 * glasses nearest to the picture that it should see, in linear light. Each row sums to 1 over both matrices, so grey
 * stays grey where both eyes see the same. */
#include "stages/encode_video/eyes_picture.h"

#include <string.h>

enum film_eyes eyes_find(const char *name)
{
    static const char *const names[FILM_EYES] = {"one", "side_by_side", "top_bottom", "anaglyph", "vr180"};
    int i = 0;
    while (i < FILM_EYES && strcmp(names[i], name) != 0) i++;
    return (enum film_eyes)i;
}

enum stereo_mode eyes_mode(enum film_eyes eyes)
{
    if (eyes == FILM_SIDE_BY_SIDE || eyes == FILM_VR180) return STEREO_SIDE_BY_SIDE;
    return eyes == FILM_TOP_BOTTOM ? STEREO_TOP_BOTTOM : STEREO_NONE;
}

void eyes_size(enum film_eyes eyes, int *width, int *height)
{
    if (eyes_mode(eyes) == STEREO_SIDE_BY_SIDE) *width *= 2;
    if (eyes_mode(eyes) == STEREO_TOP_BOTTOM) *height *= 2;
}

/* Columns: R G B of the left eye, then of the right one. */
static const double dubois[3][6] = {{0.437, 0.449, 0.164, -0.011, -0.032, -0.007},
                                    {-0.062, -0.062, -0.024, 0.377, 0.761, 0.009},
                                    {-0.048, -0.050, -0.017, -0.026, -0.093, 1.234}};

static void mix(struct image *out, const struct image *left, const struct image *right)
{
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    for (size_t p = 0; p < pixels; p++)
        for (int k = 0; k < 3; k++) {
            double sum = 0, weight = 0;
            for (int i = 0; i < 3; i++) {
                sum += dubois[k][i] * (double)left->data[3 * p + (size_t)i];
                sum += dubois[k][3 + i] * (double)right->data[3 * p + (size_t)i];
                weight += dubois[k][i] + dubois[k][3 + i]; /* 1 but for rounding in the paper */
            }
            out->data[3 * p + (size_t)k] = (float)(sum > 0 ? sum / weight : 0);
        }
}

void eyes_picture(struct image *out, const struct image *left, const struct image *right, enum film_eyes eyes)
{
    const size_t row = 3 * (size_t)left->width;
    if (eyes == FILM_ANAGLYPH) {
        mix(out, left, right);
        return;
    }
    for (int y = 0; y < left->height; y++) {
        const bool below = eyes_mode(eyes) == STEREO_TOP_BOTTOM;
        memcpy(image_at(out, 0, y), image_at(left, 0, y), row * sizeof *out->data);
        memcpy(below ? image_at(out, 0, left->height + y) : image_at(out, left->width, y), image_at(right, 0, y),
               row * sizeof *out->data);
    }
}
