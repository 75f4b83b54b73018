/* photo_colour.c - the colour spaces of photos. */
#include <stdio.h>
#include <stdlib.h>

#include "common/image/photo_formats.h"

static enum status take(struct photo *p, struct colour_space *space, struct err *err)
{
    p->space = space;
    if (space) snprintf(p->info.colour, sizeof p->info.colour, "%s", space->name);
    return err->status;
}

enum status photo_set_icc(struct photo *p, const unsigned char *icc, size_t size, bool pixels, const char *path,
                          struct err *err)
{
    struct colour_space *space = NULL;
    const int bits = p->info.bits;
    bool tables = false;
    if (size)
        colour_space_from_icc(&space, &tables, icc, size, bits, path, err);
    else if (p->info.adobe_rgb)
        colour_space_adobe(&space, bits, err);
    if (tables) p->info.bits = 16;
    if (!err->status && tables && pixels)
        colour_space_widen(p->samples, (size_t)p->info.width * (size_t)p->info.height, bits, icc, size, path, err);
    return take(p, space, err);
}

enum status photo_set_codes(struct photo *p, int primaries, int transfer, const char *path, struct err *err)
{
    struct colour_space *space = NULL;
    colour_space_from_codes(&space, primaries, transfer, p->info.bits, path, err);
    return take(p, space, err);
}

enum status photo_set_primaries(struct photo *p, const struct chromaticities *primaries, double gamma, const char *name,
                                const char *path, struct err *err)
{
    struct colour_space *space = NULL;
    if (colour_space_from_primaries(&space, primaries, gamma, p->info.bits, name, err))
        return err_context(err, "%s", path);
    return take(p, space, err);
}
