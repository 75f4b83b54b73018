/* jpeg_segment.h - the segments of a JPEG file before its pixels. */
#ifndef REMODEL_JPEG_SEGMENT_H
#define REMODEL_JPEG_SEGMENT_H

#include <stdbool.h>
#include <stddef.h>

struct jpeg_segment {
    unsigned char marker;      /* 0xe0: APP0 */
    const unsigned char *body; /* after the length */
    size_t size;               /* of the body */
};

/* The segment at *at, which is 2 before the first one and moves behind each. False: the pixels follow (marker 0xda), or
 * nothing that is a segment. */
bool jpeg_segment_next(struct jpeg_segment *s, const unsigned char *bytes, size_t size, size_t *at);
/* Whether a segment's body begins with this text and its NUL. */
bool jpeg_segment_is(const struct jpeg_segment *s, unsigned char marker, const char *name);
/* The end of the JPEG at the beginning of the bytes, behind its end marker; 0: it has none. */
size_t jpeg_segment_end(const unsigned char *bytes, size_t size);

#endif
