/* stereo_boxes.c - the boxes st3d and sv3d.
 *
 * An MP4 is a list of boxes, each of 4 bytes of size, big-endian and with these 8 bytes, 4 of type, and a content,
 * which may be boxes again. The new boxes become the last ones of the first track's first sample entry,
 * moov/trak/mdia/minf/stbl/stsd/ENTRY, so the sizes of these seven grow. What lies behind the index (moov) moves by as
 * much, and with it the places of chunks in stco or co64, which count from the beginning of the file. The file is
 * changed in place, its tail from behind. */
#include "common/film/stereo_boxes.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_INDEX = 64 << 20, MAX_ADDED = 256, BLOCK = 1 << 20, ENTRY_HEAD = 86, DEPTH = 7 };

static uint32_t get32(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static void put32(uint8_t *p, uint32_t v)
{
    for (int i = 0; i < 4; i++) p[i] = (uint8_t)(v >> (24 - 8 * i));
}

/* --------------------------------------------------------------------------------------------------- the new boxes */

struct bytes {
    uint8_t data[MAX_ADDED];
    size_t size;
};

static void add32(struct bytes *b, uint32_t v)
{
    put32(b->data + b->size, v);
    b->size += 4;
}

static void add_text(struct bytes *b, const char *text, size_t size)
{
    memcpy(b->data + b->size, text, size);
    b->size += size;
}

static size_t begin_box(struct bytes *b, const char *type)
{
    const size_t at = b->size;
    add32(b, 0);
    add_text(b, type, 4);
    return at;
}

static void end_box(struct bytes *b, size_t at) { put32(b->data + at, (uint32_t)(b->size - at)); }

static void make_boxes(struct bytes *b, enum stereo_mode mode, bool half_sphere)
{
    static const char source[] = "remodel";
    size_t box = begin_box(b, "st3d");
    add32(b, 0); /* version and flags */
    b->data[b->size++] = (uint8_t)mode;
    end_box(b, box);
    if (!half_sphere) return;
    const size_t sphere = begin_box(b, "sv3d");
    box = begin_box(b, "svhd");
    add32(b, 0);
    add_text(b, source, sizeof source);
    end_box(b, box);
    const size_t projection = begin_box(b, "proj");
    box = begin_box(b, "prhd"); /* pose: yaw, pitch, roll */
    for (int i = 0; i < 4; i++) add32(b, 0);
    end_box(b, box);
    box = begin_box(b, "equi"); /* what is cut off at the top, bottom, left and right, in 2^-32 of the whole sphere */
    add32(b, 0);
    add32(b, 0);
    add32(b, 0);
    add32(b, 1u << 30);
    add32(b, 1u << 30);
    end_box(b, box);
    end_box(b, projection);
    end_box(b, sphere);
}

/* --------------------------------------------------------------------------------------------------------- the file */

struct index {
    long at;            /* of moov in the file */
    size_t size;        /* of moov */
    uint8_t *data;      /* MAX_ADDED bytes larger */
    size_t path[DEPTH]; /* places in data of moov, trak, mdia, minf, stbl, stsd and the sample entry */
};

static enum status not_mp4(const char *path, const char *what, struct err *err)
{
    return err_set(err, ST_DATA, "%s: found %s, wanted an MP4 as ffmpeg writes it; encode the film again.", path, what);
}

/* Finds the child of that type of the box at `parent`, whose children begin `skip` bytes after its head. */
static bool find_child(size_t *at, const struct index *m, size_t parent, size_t skip, const char *type)
{
    const size_t end = parent + get32(m->data + parent);
    for (size_t k = parent + 8 + skip; k + 8 <= end;) {
        const size_t size = get32(m->data + k);
        if (size < 8 || size > end - k) return false;
        if (!type || !memcmp(m->data + k + 4, type, 4)) {
            *at = k;
            return true;
        }
        k += size;
    }
    return false;
}

static enum status read_index(struct index *m, FILE *fp, const char *path, struct err *err)
{
    uint8_t head[16];
    for (;;) {
        const size_t got = fread(head, 1, 8, fp);
        uint64_t size = got == 8 ? get32(head) : 0;
        if (size == 1 && fread(head + 8, 1, 8, fp) == 8) size = (uint64_t)get32(head + 8) << 32 | get32(head + 12);
        if (size < 8 || size > (uint64_t)1 << 62) return not_mp4(path, "no index (box moov)", err);
        if (!memcmp(head + 4, "moov", 4)) {
            if (size > MAX_INDEX) return not_mp4(path, "an index of more than 64 MiB", err);
            m->size = (size_t)size;
            break;
        }
        m->at += (long)size;
        if (fseek(fp, m->at, SEEK_SET)) return err_errno(err, "read", path);
    }
    if (!(m->data = malloc(m->size + MAX_ADDED))) return err_nomem(err, "the index of a film", m->size);
    if (fseek(fp, m->at, SEEK_SET) || fread(m->data, 1, m->size, fp) != m->size)
        return not_mp4(path, "an index that ends early", err);
    return ST_OK;
}

static enum status find_entry(struct index *m, const char *path, struct err *err)
{
    static const char *const types[DEPTH] = {"moov", "trak", "mdia", "minf", "stbl", "stsd", NULL};
    for (int i = 1; i < DEPTH; i++)
        if (!find_child(&m->path[i], m, m->path[i - 1], i == DEPTH - 1 ? 8 : 0, types[i]))
            return not_mp4(path, "an index without a sample entry", err);
    if (get32(m->data + m->path[DEPTH - 1]) < ENTRY_HEAD) return not_mp4(path, "a sample entry that is too short", err);
    return ST_OK;
}

/* Adds `by` to the places of chunks behind the index. */
static enum status move_chunks(struct index *m, size_t by, const char *path, struct err *err)
{
    size_t at;
    const bool small = find_child(&at, m, m->path[4], 0, "stco");
    if (!small && !find_child(&at, m, m->path[4], 0, "co64")) return not_mp4(path, "an index without chunks", err);
    const size_t width = small ? 4 : 8, count = get32(m->data + at + 12);
    if (get32(m->data + at) < 16 || count > (get32(m->data + at) - 16) / width)
        return not_mp4(path, "a broken table of chunks", err);
    for (size_t i = 0; i < count; i++) {
        uint8_t *p = m->data + at + 16 + i * width;
        uint64_t place = small ? get32(p) : (uint64_t)get32(p) << 32 | get32(p + 4);
        if (place <= (uint64_t)m->at) continue;
        place += by;
        if (small && place > UINT32_MAX) return not_mp4(path, "a film of 4 GiB with small places of chunks", err);
        if (!small) put32(p, (uint32_t)(place >> 32));
        put32(p + width - 4, (uint32_t)place);
    }
    return ST_OK;
}

static void insert(struct index *m, const struct bytes *more)
{
    const size_t entry = m->path[DEPTH - 1], end = entry + get32(m->data + entry);
    memmove(m->data + end + more->size, m->data + end, m->size - end);
    memcpy(m->data + end, more->data, more->size);
    for (int i = 0; i < DEPTH; i++) {
        uint8_t *box = m->data + m->path[i];
        put32(box, get32(box) + (uint32_t)more->size);
    }
    m->size += more->size;
}

/* Moves everything from `from` to the end of the file by `by`, from behind. */
static enum status move_tail(FILE *fp, long from, size_t by, const char *path, struct err *err)
{
    uint8_t *block = malloc(BLOCK);
    if (!block) return err_nomem(err, "a part of a film", BLOCK);
    long end = fseek(fp, 0, SEEK_END) ? -1 : ftell(fp);
    while (end > from) {
        const size_t size = end - from < BLOCK ? (size_t)(end - from) : BLOCK;
        end -= (long)size;
        if (fseek(fp, end, SEEK_SET) || fread(block, 1, size, fp) != size || fseek(fp, end + (long)by, SEEK_SET) ||
            fwrite(block, 1, size, fp) != size) {
            err_errno(err, "move a part of", path);
            break;
        }
    }
    if (end < 0) err_errno(err, "read", path);
    free(block);
    return err->status;
}

enum status stereo_boxes_add(const char *path, enum stereo_mode mode, bool half_sphere, struct err *err)
{
    struct index m = {0};
    struct bytes more = {.size = 0};
    FILE *fp = fopen(path, "r+b");
    if (!fp) return err_errno(err, "open", path);
    make_boxes(&more, mode, half_sphere);
    if (!read_index(&m, fp, path, err) && !find_entry(&m, path, err) && !move_chunks(&m, more.size, path, err) &&
        !move_tail(fp, m.at + (long)m.size, more.size, path, err)) {
        insert(&m, &more);
        if (fseek(fp, m.at, SEEK_SET) || fwrite(m.data, 1, m.size, fp) != m.size) err_errno(err, "write", path);
    }
    free(m.data);
    if (fclose(fp) && !err->status) err_errno(err, "write", path);
    return err->status;
}
