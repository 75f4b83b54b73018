/* photo_kind.c - what a file holds, by its first bytes. */
#include "common/image/photo_kind.h"

#include <string.h>

struct mark {
    size_t at;
    const char *bytes;
    size_t size;
    enum photo_kind kind;
};

static const struct mark marks[] = {
    {0, "\xff\xd8\xff", 3, PHOTO_KIND_JPEG},
    {0, "\x89PNG\r\n\x1a\n", 8, PHOTO_KIND_PNG},
    {0, "\x76\x2f\x31\x01", 4, PHOTO_KIND_EXR},
    {0, "FUJIFILMCCD-RAW", 15, PHOTO_KIND_RAW},
    {0, "IIRO", 4, PHOTO_KIND_RAW},
    {0, "IIRS", 4, PHOTO_KIND_RAW},
    {0, "MMOR", 4, PHOTO_KIND_RAW},
    {0, "IIU\0", 4, PHOTO_KIND_RAW},
    {6, "HEAPCCDR", 8, PHOTO_KIND_RAW},
    {0, "FOVb", 4, PHOTO_KIND_RAW},
    {0, "\0MRM", 4, PHOTO_KIND_RAW},
    {4, "ftypcrx ", 8, PHOTO_KIND_RAW},
    {8, "CR\2\0", 4, PHOTO_KIND_RAW},
    {0, "II\x2a\0", 4, PHOTO_KIND_TIFF},
    {0, "MM\0\x2a", 4, PHOTO_KIND_TIFF},
    {0, "II\x2b\0", 4, PHOTO_KIND_TIFF},
    {0, "MM\0\x2b", 4, PHOTO_KIND_TIFF},
    {8, "WEBP", 4, PHOTO_KIND_WEBP},
    {0, "\xff\x0a", 2, PHOTO_KIND_JXL},
    {0, "\0\0\0\x0cJXL \r\n\x87\n", 12, PHOTO_KIND_JXL},
    {0, "\x1a\x45\xdf\xa3", 4, PHOTO_KIND_VIDEO}, /* Matroska, WebM */
    {8, "AVI LIST", 8, PHOTO_KIND_VIDEO},
    {4, "moov", 4, PHOTO_KIND_VIDEO}, /* QuickTime before it had brands */
    {4, "mdat", 4, PHOTO_KIND_VIDEO},
    {4, "wide", 4, PHOTO_KIND_VIDEO},
};

/* An ISO media file is a picture if its main brand, or one of those it is compatible with, is that of HEIF pictures. */
static bool is_heif(const unsigned char *b, size_t size)
{
    static const char *const pictures[] = {"heic", "heix", "heim", "heis", "mif1", "mif2", "avif"};
    if (size < 12 || memcmp(b + 4, "ftyp", 4) != 0) return false;
    const size_t length = (size_t)b[0] << 24 | (size_t)b[1] << 16 | (size_t)b[2] << 8 | b[3];
    for (size_t at = 8; at + 4 <= size && at + 4 <= length;
         at += at == 8 ? 8 : 4) /* a version follows the main brand */
        for (size_t i = 0; i < sizeof pictures / sizeof *pictures; i++)
            if (!memcmp(b + at, pictures[i], 4)) return true;
    return false;
}

/* Any other ISO media file, but for those that say that they hold sound alone. */
static bool is_video(const unsigned char *b, size_t size)
{
    static const char *const sounds[] = {"M4A ", "M4B ", "M4P ", "F4A ", "F4B "};
    if (size < 12 || memcmp(b + 4, "ftyp", 4) != 0) return false;
    for (size_t i = 0; i < sizeof sounds / sizeof *sounds; i++)
        if (!memcmp(b + 8, sounds[i], 4)) return false;
    return true;
}

enum photo_kind photo_kind_of(const unsigned char *bytes, size_t size)
{
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
        if (size >= marks[i].at + marks[i].size && !memcmp(bytes + marks[i].at, marks[i].bytes, marks[i].size))
            return marks[i].kind;
    if (is_heif(bytes, size)) return PHOTO_KIND_HEIF;
    return is_video(bytes, size) ? PHOTO_KIND_VIDEO : PHOTO_KIND_OTHER;
}
