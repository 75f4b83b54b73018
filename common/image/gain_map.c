/* gain_map.c - the metadata of gain maps, by libexpat.
 *
 * XMP data [ISO 2019] state a property as an attribute, as an element with text, or as a list (rdf:Seq) with an item
 * for each colour. Google's container directory lists the pictures of a file in their order: elements
 * Container:Item with the properties Item:Semantic and Item:Length; the photo is first. ISO 21496-1 has the same
 * numbers as fractions in binary, high bytes first: versions, flags, the headroom of both pictures, then for one or
 * three colours low, high, gamma and both offsets. libultrahdr may write one denominator for all. */
#include "common/image/gain_map.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <expat.h>

#include "common/base/scan.h"
#include "common/base/xml_line.h"

#define HDRGM "http://ns.adobe.com/hdr-gain-map/1.0/"
#define ITEM  "http://ns.google.com/photos/1.0/container/item/"
#define RDF   "http://www.w3.org/1999/02/22-rdf-syntax-ns#"

static const double MOST_STOPS = 32, MOST_OFFSET = 16, LEAST_GAMMA = 1e-3, MOST_GAMMA = 1e3;

enum { MAX_DEPTH = 32, MAX_NAME = 128, MAX_TEXT = 64 };

enum property { LOW, HIGH, GAMMA, BASE_OFFSET, HDR_OFFSET, NUMBERS };
static const char *const number_names[NUMBERS] = {"GainMapMin", "GainMapMax", "Gamma", "OffsetSDR", "OffsetHDR"};

struct reader {
    char names[MAX_DEPTH][MAX_NAME]; /* of the open elements: namespace, a blank, name */
    int entry[MAX_DEPTH];            /* list items so far in this element */
    int depth;
    char text[MAX_TEXT]; /* inside of the innermost element */
    size_t length;
    bool too_deep, too_many;
    bool wants_items; /* else gain map data */
    struct gain_map_items *items;
    char number[NUMBERS][3][MAX_TEXT]; /* as in the file; "": missing */
    char version[MAX_TEXT], base_is_hdr[MAX_TEXT];
};

static void keep(char to[MAX_TEXT], const char *text) { snprintf(to, MAX_TEXT, "%s", text); }

/* A property of the innermost item. */
static void take_item(struct reader *r, const char *name, const char *text)
{
    double value = 0;
    if (!r->items->count) return;
    struct gain_map_item *item = &r->items->items[r->items->count - 1];
    if (!strcmp(name, "Semantic")) item->is_gain_map = !strcmp(text, "GainMap");
    const bool number = scan_double(text, &value) && value >= 0 && value < 1e12;
    if (number && !strcmp(name, "Length")) item->length = value;
    if (number && !strcmp(name, "Padding")) item->padding = value;
}

/* A property, or an entry of it, from 0. */
static void take(struct reader *r, const char *name, int entry, const char *text)
{
    const size_t space = r->wants_items ? sizeof ITEM - 1 : sizeof HDRGM - 1;
    if (strncmp(name, r->wants_items ? ITEM : HDRGM, space) != 0 || name[space] != ' ') return;
    name += space + 1;
    if (r->wants_items) {
        take_item(r, name, text);
        return;
    }
    for (int i = 0; i < NUMBERS; i++)
        if (!strcmp(name, number_names[i]) && entry < 3)
            for (int c = entry; c < 3; c++) keep(r->number[i][c], text); /* one value is that of all colours */
    if (!strcmp(name, "Version")) keep(r->version, text);
    if (!strcmp(name, "BaseRenditionIsHDR")) keep(r->base_is_hdr, text);
}

static bool is_item(const char *name)
{
    static const char container[] = "http://ns.google.com/photos/1.0/container/ Item";
    return !strcmp(name, container);
}

static void XMLCALL open_element(void *ctx, const char *name, const char **attributes)
{
    struct reader *r = ctx;
    r->length = 0;
    if (r->depth == MAX_DEPTH || strlen(name) >= MAX_NAME) {
        r->too_deep |= r->depth == MAX_DEPTH;
        if (r->depth == MAX_DEPTH) return;
        name = "";
    }
    snprintf(r->names[r->depth], MAX_NAME, "%s", name);
    r->entry[r->depth++] = 0;
    if (r->wants_items && is_item(name)) {
        r->too_many |= r->items->count == GAIN_MAP_ITEMS;
        if (!r->too_many) r->items->items[r->items->count++] = (struct gain_map_item){0};
    }
    for (; !r->too_many && *attributes; attributes += 2) take(r, attributes[0], 0, attributes[1]);
}

static void XMLCALL add_text(void *ctx, const char *text, int length)
{
    struct reader *r = ctx;
    for (int i = 0; i < length && r->length + 1 < MAX_TEXT; i++)
        if (r->length || !strchr(" \t\r\n", text[i])) r->text[r->length++] = text[i];
}

static void XMLCALL close_element(void *ctx, const char *name)
{
    struct reader *r = ctx;
    (void)name;
    if (r->too_deep) return;
    r->depth--;
    while (r->length && strchr(" \t\r\n", r->text[r->length - 1])) r->length--;
    r->text[r->length] = 0;
    const bool entry = r->depth >= 2 && !strcmp(r->names[r->depth], RDF " li");
    if (r->length && !r->too_many && entry) /* in a list in a property */
        take(r, r->names[r->depth - 2], r->entry[r->depth - 1]++, r->text);
    else if (r->length && !r->too_many)
        take(r, r->names[r->depth], 0, r->text);
    r->length = 0;
}

static enum status read_xmp(struct reader *r, const char *xmp, size_t size, const char *path, struct err *err)
{
    XML_Parser parser = XML_ParserCreateNS(NULL, ' ');
    if (!parser) return err_nomem(err, "an XML parser", 0);
    while (size && (!xmp[size - 1] || strchr(" \t\r\n", xmp[size - 1]))) size--;
    XML_SetUserData(parser, r);
    XML_SetElementHandler(parser, open_element, close_element);
    XML_SetCharacterDataHandler(parser, add_text);
    if (size > INT32_MAX || XML_Parse(parser, xmp, (int)size, 1) != XML_STATUS_OK)
        err_set(err, ST_DATA,
                "%s: its XMP data, which describe its gain map, are damaged (%s in line %llu); export the photo again, "
                "or set [import_photos] gain_map = no.",
                path, XML_ErrorString(XML_GetErrorCode(parser)), (unsigned long long)xml_line(parser));
    else if (r->too_deep || r->too_many)
        err_set(err, ST_DATA,
                "%s: its XMP data, which describe its gain map, have more than %d %s; export the photo again, or set "
                "[import_photos] gain_map = no.",
                path, r->too_deep ? (int)MAX_DEPTH : (int)GAIN_MAP_ITEMS, r->too_deep ? "nested elements" : "pictures");
    XML_ParserFree(parser);
    return err->status;
}

bool gain_map_in_xmp(const char *xmp, size_t size)
{
    return memmem(xmp, size, HDRGM, sizeof HDRGM - 1) || memmem(xmp, size, "\"GainMap\"", 9);
}

enum status gain_map_list_items(struct gain_map_items *items, const char *xmp, size_t size, const char *path,
                                struct err *err)
{
    *items = (struct gain_map_items){0};
    struct reader *r = calloc(1, sizeof *r);
    if (!r) return err_nomem(err, "XMP data", sizeof *r);
    r->wants_items = true;
    r->items = items;
    read_xmp(r, xmp, size, path, err);
    free(r);
    return err->status;
}

/* One message for all numbers that do not fit. */
static enum status check(const struct gain_map_data *d, const char *path, struct err *err)
{
    for (int c = 0; c < 3; c++) {
        const double values[NUMBERS] = {d->low[c], d->high[c], d->gamma[c], d->base_offset[c], d->hdr_offset[c]};
        const double least[NUMBERS] = {-MOST_STOPS, d->low[c], LEAST_GAMMA, -MOST_OFFSET, -MOST_OFFSET};
        const double most[NUMBERS] = {MOST_STOPS, MOST_STOPS, MOST_GAMMA, MOST_OFFSET, MOST_OFFSET};
        for (int i = 0; i < NUMBERS; i++)
            if (!(values[i] >= least[i] && values[i] <= most[i]))
                return err_set(err, ST_DATA,
                               "%s: %s of its gain map is %.6g, wanted %.6g to %.6g; export the photo again, or set "
                               "[import_photos] gain_map = no.",
                               path, number_names[i], values[i], least[i], most[i]);
    }
    return ST_OK;
}

static enum status missing(const char *name, const char *found, const char *wanted, const char *path, struct err *err)
{
    return err_set(err, ST_DATA,
                   "%s: %s of its gain map is %s, wanted %s; export the photo again, or set [import_photos] gain_map = "
                   "no.",
                   path, name, *found ? found : "missing", wanted);
}

enum status gain_map_from_xmp(struct gain_map_data *data, const char *xmp, size_t size, const char *path,
                              struct err *err)
{
    static const double absent[NUMBERS] = {0, NAN, 1, 1 / 64.0, 1 / 64.0};
    double values[NUMBERS][3];
    struct reader *r = calloc(1, sizeof *r);
    if (!r) return err_nomem(err, "XMP data", sizeof *r);
    read_xmp(r, xmp, size, path, err);
    if (!err->status && strncmp(r->version, "1.", 2) != 0) missing("Version", r->version, "1.0", path, err);
    for (int i = 0; i < NUMBERS; i++)
        for (int c = 0; !err->status && c < 3; c++) {
            values[i][c] = absent[i];
            if (*r->number[i][c] ? !scan_double(r->number[i][c], &values[i][c]) : isnan(absent[i]))
                missing(number_names[i], r->number[i][c], "a number", path, err);
        }
    const bool is_hdr = !strcmp(r->base_is_hdr, "True") || !strcmp(r->base_is_hdr, "true");
    free(r);
    if (err->status) return err->status;
    *data = (struct gain_map_data){.base_is_hdr = is_hdr};
    for (int c = 0; c < 3; c++) {
        data->low[c] = values[LOW][c];
        data->high[c] = values[HIGH][c];
        data->gamma[c] = values[GAMMA][c];
        data->base_offset[c] = values[BASE_OFFSET][c];
        data->hdr_offset[c] = values[HDR_OFFSET][c];
    }
    return check(data, path, err);
}

/* ------------------------------------------------------------------------------------------------------------- ISO */

struct bytes {
    const unsigned char *at, *end;
    bool cut;
};

static uint32_t take_u32(struct bytes *b)
{
    if (b->end - b->at < 4) {
        b->cut = true;
        return 0;
    }
    const unsigned char *p = b->at;
    b->at += 4;
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* common: the denominator of all; 0: each has its own. NaN for a denominator of 0. */
static double take_fraction(struct bytes *b, bool is_signed, uint32_t common)
{
    const uint32_t top = take_u32(b), below = common ? common : take_u32(b);
    const double number = is_signed ? (double)(int32_t)top : (double)top;
    return below ? number / (double)below : NAN;
}

enum status gain_map_from_iso(struct gain_map_data *data, const unsigned char *bytes, size_t size, const char *path,
                              struct err *err)
{
    enum { THREE = 0x80, COMMON = 8, BACKWARD = 4 };
    struct bytes b = {bytes, bytes + size, size < 5};
    *data = (struct gain_map_data){0};
    if (!b.cut && (bytes[0] || bytes[1]))
        return err_set(err, ST_DATA,
                       "%s: its gain map needs version %d of ISO 21496-1, wanted 0; set [import_photos] gain_map = no.",
                       path, bytes[0] << 8 | bytes[1]);
    const int flags = b.cut ? 0 : bytes[4], colours = flags & THREE ? 3 : 1;
    if (!b.cut) b.at += 5;
    const uint32_t common = flags & COMMON ? take_u32(&b) : 0;
    if (flags & COMMON && !common && !b.cut) return missing("the denominator", "0", "1 or more", path, err);
    const double base_headroom = take_fraction(&b, false, common), headroom = take_fraction(&b, false, common);
    for (int c = 0; c < colours; c++) {
        data->low[c] = take_fraction(&b, true, common);
        data->high[c] = take_fraction(&b, true, common);
        data->gamma[c] = take_fraction(&b, false, common);
        data->base_offset[c] = take_fraction(&b, true, common);
        data->hdr_offset[c] = take_fraction(&b, true, common);
    }
    for (int c = colours; c < 3; c++) {
        data->low[c] = data->low[0];
        data->high[c] = data->high[0];
        data->gamma[c] = data->gamma[0];
        data->base_offset[c] = data->base_offset[0];
        data->hdr_offset[c] = data->hdr_offset[0];
    }
    data->base_is_hdr = base_headroom > headroom || flags & BACKWARD;
    if (b.cut)
        return err_set(err, ST_DATA,
                       "%s: the ISO 21496-1 data of its gain map end too soon; export the photo again, or set "
                       "[import_photos] gain_map = no.",
                       path);
    return check(data, path, err);
}
