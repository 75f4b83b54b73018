/* fuzz_layered_depth.c - reading of layered depth maps: any list and picture give an error message, or a depth map
 * whose ids index its segments and which can be written and read back.
 *
 * The input is the list, a line "%%", and the picture. Without this line, an input that begins like an OpenEXR file is
 * the picture, and the list gets three segments and its size; otherwise it is the list of a valid picture of 4 x 3. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/image/exr.h"
#include "common/layers/layered_depth.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static char folder[FUZZ_PATH];
static char list[FUZZ_PATH + 64], picture[FUZZ_PATH + 64], valid_picture[FUZZ_PATH + 64];

static void remove_folder(void)
{
    unlink(list);
    unlink(picture);
    unlink(valid_picture);
    snprintf(list, sizeof list, "%s/good.txt", folder);
    unlink(list);
    rmdir(folder);
}

static void make_folder(void)
{
    struct layered_depth d;
    struct err err = ERR_INIT;

    fuzz_folder(folder);
    if (atexit(remove_folder)) abort();
    snprintf(list, sizeof list, "%s/d.txt", folder);
    snprintf(picture, sizeof picture, "%s/d.exr", folder);
    snprintf(valid_picture, sizeof valid_picture, "%s/good.exr", folder);
    if (layered_depth_init(&d, 4, 3, &err) || layered_depth_write(&d, NULL, valid_picture, NULL, &err)) abort();
    layered_depth_release(&d);
}

static void write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *fp = fopen(path, "wb");
    if (!fp || (size && fwrite(bytes, 1, size, fp) != size) || fclose(fp)) abort();
}

static void write_list_of_size(void)
{
    struct err none = ERR_INIT;
    struct exr_image im;
    char text[200];
    if (exr_read(&im, picture, (const char *const[]){NULL}, 0, &none)) im.width = im.height = 1;
    snprintf(text, sizeof text,
             "remodel-segments 1\nsize %d %d\nsegments 3\n1 0 0 0 1 0.1 1\n2 0 0.5 0 1 0.1 1\n3 0 0 0 0 0 0\n",
             im.width, im.height);
    exr_image_release(&im);
    write_bytes(list, text, strlen(text));
}

static void check_segments(const struct layered_depth *d)
{
    if (d->width < 1 || d->height < 1 || d->segment_count < 0) abort();
    for (int i = 0; i < d->segment_count; i++) {
        const struct depth_segment *s = &d->segments[i];
        if (s->id != (uint32_t)i + 1 || s->pixels < 0 || (int64_t)s->pixels > (int64_t)d->width * d->height) abort();
        for (int k = 0; k < 3; k++)
            if (!isfinite(s->plane[k])) abort();
        if (!(s->sigma >= 0 && s->sigma < INFINITY && s->confidence >= 0 && s->confidence <= 1)) abort();
    }
}

static void check_layer(const struct layer *l, const struct layered_depth *d)
{
    for (size_t i = 0; i < (size_t)d->width * (size_t)d->height; i++) {
        for (int k = 0; k < 4; k++)
            if (!isfinite(l->rgba[4 * i + (size_t)k])) abort();
        if (l->id[i] > (uint32_t)d->segment_count || !(l->z[i] >= 0 && l->z[i] < INFINITY)) abort();
        if (!(l->rgba[4 * i + 3] >= 0 && l->rgba[4 * i + 3] <= 1)) abort();
    }
}

static void check_empty(const struct layered_depth *d, enum status st, const struct err *err)
{
    static const struct layered_depth empty;
    if (st != err->status || !strstr(err->text, folder) || memcmp(d, &empty, sizeof empty)) abort();
}

static void write_again(const struct layered_depth *d)
{
    struct layered_depth again;
    struct err err = ERR_INIT;
    const size_t pixels = (size_t)d->width * (size_t)d->height;

    if (layered_depth_write(d, NULL, picture, NULL, &err) || layered_depth_read(&again, picture, NULL, &err)) abort();
    if (again.width != d->width || again.height != d->height || again.segment_count != d->segment_count) abort();
    for (int i = 0; i < d->segment_count; i++)
        if (memcmp(again.segments[i].plane, d->segments[i].plane, sizeof d->segments[i].plane)) abort();
    if (memcmp(again.interior.z, d->interior.z, pixels * sizeof *d->interior.z) ||
        memcmp(again.boundary.id, d->boundary.id, pixels * sizeof *d->boundary.id))
        abort();
    layered_depth_release(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint8_t magic[] = {0x76, 0x2f, 0x31, 0x01};
    struct layered_depth d;
    struct err err = ERR_INIT;

    if (!list[0]) make_folder();
    unlink(picture); /* may be a link to the valid picture */
    const uint8_t *separator = memmem(data, size, "%%\n", 3);
    if (size >= sizeof magic && !memcmp(data, magic, sizeof magic)) {
        write_bytes(picture, data, size);
        write_list_of_size();
    } else {
        const size_t length = separator ? (size_t)(separator - data) : size;
        write_bytes(list, data, length);
        if (separator)
            write_bytes(picture, separator + 3, size - length - 3);
        else if (link(valid_picture, picture))
            abort();
    }

    enum status st = layered_depth_read_segments(&d, list, NULL, &err);
    if (st) {
        check_empty(&d, st, &err);
    } else {
        check_segments(&d);
        if (d.interior.rgba || d.boundary.id) abort();
        layered_depth_release(&d);
    }
    err = (struct err)ERR_INIT;
    st = layered_depth_read(&d, picture, NULL, &err);
    if (st) {
        check_empty(&d, st, &err);
        return 0;
    }
    check_segments(&d);
    check_layer(&d.interior, &d);
    check_layer(&d.boundary, &d);
    write_again(&d);
    layered_depth_release(&d);
    return 0;
}
