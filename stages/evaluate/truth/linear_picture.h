/* linear_picture.h - a rendered picture to be measured, and the true picture as its camera sees it.
 *
 * A picture is FOLDER/NAME.exr, .png, .jpg or .tif. EXR holds scene-linear R G B, with A premultiplied (a pixel with A
 * 0 is black), and may have a channel `hole`, above 0.5 where nothing is known before filling. The others are 8 or 16
 * bits of sRGB; their white is 1. */
#ifndef REMODEL_LINEAR_PICTURE_H
#define REMODEL_LINEAR_PICTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/file_path.h"
#include "common/capture/camera.h"
#include "common/image/image.h"

struct linear_picture {
    struct image rgb; /* 3 channels */
    uint8_t *hole;    /* owned; 1: a hole */
    uint8_t *known;   /* owned; 0: the file's channel `clipped` or A excludes this pixel (of views) */
    bool encoded;     /* from a file that is clipped at white */
};

/* False: FOLDER holds no picture of this name. */
bool linear_picture_find(char path[FILE_PATH], const char *folder, const char *name);
/* ST_DATA: a damaged file, or integers in a colour channel. The caller releases the picture. */
enum status linear_picture_read(struct linear_picture *p, const char *path, struct err *err);
void linear_picture_release(struct linear_picture *p);

/* How a picture sees what a true picture shows. The two cameras share their centre. */
struct picture_map {
    struct camera lens;            /* of the picture */
    struct camera true_lens;       /* of any size of the true picture */
    struct mat3 true_from_picture; /* of directions in the cameras' axes */
};

/* out: the picture's size, 4 channels: R G B of the truth, interpolated linearly between its pixels, and A, 1 where the
 * truth has the point. out is empty on entry; the caller releases it. */
enum status picture_of_truth(struct image *out, const struct image *truth, const struct picture_map *map,
                             struct err *err);

/* The index of the true pixel (of width x height) that contains the centre of each pixel of the picture; -1: none.
 * index: as many as the picture's pixels. */
void picture_true_pixels(int32_t *index, int width, int height, const struct picture_map *map);

#endif
