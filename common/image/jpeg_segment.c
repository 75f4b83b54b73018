/* jpeg_segment.c - the segments of a JPEG file before its pixels. */
#include "common/image/jpeg_segment.h"

#include <string.h>

bool jpeg_segment_next(struct jpeg_segment *s, const unsigned char *bytes, size_t size, size_t *at)
{
    while (*at + 4 <= size && bytes[*at] == 0xff && bytes[*at + 1] == 0xff) (*at)++; /* fill bytes */
    if (*at + 4 > size || bytes[*at] != 0xff || bytes[*at + 1] == 0xda) return false;
    const unsigned char *b = bytes + *at;
    const size_t length = (size_t)b[2] << 8 | b[3];
    if (length < 2 || length > size - *at - 2) return false;
    *s = (struct jpeg_segment){b[1], b + 4, length - 2};
    *at += 2 + length;
    return true;
}

bool jpeg_segment_is(const struct jpeg_segment *s, unsigned char marker, const char *name)
{
    const size_t length = strlen(name) + 1;
    return s->marker == marker && s->size >= length && !memcmp(s->body, name, length);
}

/* Segments, then pixels in one scan or several, in which a 0xff is followed by 0 or a restart marker. */
size_t jpeg_segment_end(const unsigned char *bytes, size_t size)
{
    struct jpeg_segment segment;
    for (size_t at = 2; at + 2 <= size;) {
        while (jpeg_segment_next(&segment, bytes, size, &at)) {
        }
        if (at + 2 > size || bytes[at] != 0xff) return 0;
        if (bytes[at + 1] == 0xd9) return at + 2;
        if (bytes[at + 1] != 0xda) return 0;
        for (at += 2; at + 2 <= size; at++) { /* to the next marker */
            const unsigned char *b = memchr(bytes + at, 0xff, size - at - 1);
            if (!b) return 0;
            at = (size_t)(b - bytes);
            if (b[1] && b[1] != 0xff && (b[1] & 0xf8) != 0xd0) break;
        }
    }
    return 0;
}
