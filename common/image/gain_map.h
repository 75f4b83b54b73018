/* gain_map.h - what the metadata of a photo's gain map say [ISO 2025; Google 2023].
 *
 * A gain map is a second picture in the file of a photo. With the photo's linear light s and the map's value g, from 0
 * to 1, both of one colour, the linear light on a screen that can show all of it is
 *   (s + base_offset) 2^(low + (high - low) g^(1 / gamma)) - hdr_offset. */
#ifndef REMODEL_GAIN_MAP_H
#define REMODEL_GAIN_MAP_H

#include <stdbool.h>
#include <stddef.h>

#include "common/base/err.h"

struct gain_map_data {      /* of red, green and blue */
    double low[3], high[3]; /* log2 of the gain where the map is 0, and where it is 1 */
    double gamma[3];
    double base_offset[3], hdr_offset[3];
    bool base_is_hdr; /* the photo itself is the HDR picture, and the map leads to a darker one */
};

enum { GAIN_MAP_ITEMS = 16 };

struct gain_map_item { /* a picture of the file, as the photo's XMP data list them */
    bool is_gain_map;
    double length, padding; /* bytes; 0: not stated */
};

struct gain_map_items {
    struct gain_map_item items[GAIN_MAP_ITEMS];
    int count;
};

/* Whether XMP data speak of a gain map at all, damaged or not. */
bool gain_map_in_xmp(const char *xmp, size_t size);
/* The pictures of a file by the XMP data of its photo. ST_DATA, naming path: the data are damaged. */
enum status gain_map_list_items(struct gain_map_items *items, const char *xmp, size_t size, const char *path,
                                struct err *err);
/* The metadata by the XMP data of the gain map itself. ST_DATA, naming path and the property: damaged, missing, or out
 * of range. */
enum status gain_map_from_xmp(struct gain_map_data *data, const char *xmp, size_t size, const char *path,
                              struct err *err);
/* The same by the bytes of ISO 21496-1. */
enum status gain_map_from_iso(struct gain_map_data *data, const unsigned char *bytes, size_t size, const char *path,
                              struct err *err);

#endif
