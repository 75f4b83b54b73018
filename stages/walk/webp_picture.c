/* webp_picture.c - see webp_picture.h. */
#include "stages/walk/webp_picture.h"

#include <stdlib.h>
#include <string.h>
#include <webp/encode.h>

struct memory {
    unsigned char *bytes;
    size_t size, room;
};

static int append(const uint8_t *data, size_t size, const WebPPicture *picture)
{
    struct memory *m = picture->custom_ptr;
    if (m->size + size > m->room) {
        const size_t room = 2 * m->room + size;
        unsigned char *more = realloc(m->bytes, room);
        if (!more) return 0;
        m->bytes = more;
        m->room = room;
    }
    memcpy(m->bytes + m->size, data, size);
    m->size += size;
    return 1;
}

enum status webp_picture_encode(unsigned char **bytes, size_t *size, const unsigned char *rgba, int width, int height,
                                int quality, int effort, struct err *err)
{
    struct memory memory = {0};
    WebPConfig config;
    WebPPicture picture;
    *bytes = NULL;
    if (!WebPConfigPreset(&config, WEBP_PRESET_PHOTO, (float)quality) || !WebPPictureInit(&picture))
        return err_set(err, ST_INTERNAL, "libwebp has another version than its header.");
    config.method = effort;
    config.exact = 1; /* colours beside what is seen are read between texels */
    config.use_sharp_yuv = 0;
    picture.width = width;
    picture.height = height;
    picture.writer = append;
    picture.custom_ptr = &memory;
    if (!WebPPictureImportRGBA(&picture, rgba, 4 * width) || !WebPEncode(&config, &picture)) {
        err_set(err, ST_INTERNAL, "libwebp could not encode a picture of %d x %d pixels: error %d.", width, height,
                (int)picture.error_code);
        free(memory.bytes);
        memory = (struct memory){0};
    }
    WebPPictureFree(&picture);
    *bytes = memory.bytes;
    *size = memory.size;
    return err->status;
}
