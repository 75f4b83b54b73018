/* photo_kind.h - what a file holds, by its first bytes. */
#ifndef REMODEL_PHOTO_KIND_H
#define REMODEL_PHOTO_KIND_H

#include <stdbool.h>
#include <stddef.h>

enum photo_kind {
    PHOTO_KIND_OTHER, /* no picture that is read here */
    PHOTO_KIND_JPEG,
    PHOTO_KIND_PNG,
    PHOTO_KIND_TIFF, /* many raw files too */
    PHOTO_KIND_EXR,
    PHOTO_KIND_RAW,  /* a camera's raw file that is no TIFF */
    PHOTO_KIND_HEIF, /* HEIC and AVIF */
    PHOTO_KIND_WEBP,
    PHOTO_KIND_JXL,
    PHOTO_KIND_VIDEO, /* MP4, QuickTime, Matroska, AVI; no photo */
};

enum photo_kind photo_kind_of(const unsigned char *bytes, size_t size);

#endif
