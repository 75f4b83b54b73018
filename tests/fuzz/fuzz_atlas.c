/* fuzz_atlas.c - reading of texture atlases: any list and page give an error message, or an atlas whose indices are in
 * range, which can be looked up anywhere, packed again, and written and read back.
 *
 * The input is atlas.txt, a line "%%", and page0.exr. Without this line, an input that begins like an OpenEXR file is
 * the page, and the list gets its size; otherwise it is the list. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/image/exr.h"
#include "common/texture/atlas.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static char folder[FUZZ_PATH];
static char list[FUZZ_PATH + 64], picture[FUZZ_PATH + 64];

static void remove_folder(void)
{
    unlink(list);
    unlink(picture);
    rmdir(folder);
}

static void make_folder(void)
{
    fuzz_folder(folder);
    if (atexit(remove_folder)) abort();
    snprintf(list, sizeof list, "%s/atlas.txt", folder);
    snprintf(picture, sizeof picture, "%s/page0.exr", folder);
}

static void write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *fp = fopen(path, "wb");
    if (!fp || (size && fwrite(bytes, 1, size, fp) != size) || fclose(fp)) abort();
}

/* The list of an atlas that has the picture as its page, and a tile as large. */
static void write_list_of_size(void)
{
    struct err none = ERR_INIT;
    struct exr_image im;
    char text[300];
    if (exr_read(&im, picture, (const char *const[]){NULL}, 0, &none)) im.width = im.height = 1;
    snprintf(text, sizeof text,
             "remodel-atlas 1\nviewpoint P 0 0 0\nview P\nsource P\nsource Q\npage %d %d\n"
             "tile 7 0 0 0 0 %d %d 9 0 3 0 0 9 2 0 0 0 1 0\n",
             im.width, im.height, im.width, im.height);
    exr_image_release(&im);
    write_bytes(list, text, strlen(text));
}

static void check_order(char *const *names, int count)
{
    for (int i = 1; i < count; i++)
        if (strcmp(names[i - 1], names[i]) >= 0) abort();
}

static void check_atlas(const struct atlas *a)
{
    check_order(a->views, a->view_count);
    check_order(a->sources, a->source_count);
    for (int i = 0; i < a->page_count; i++)
        for (int k = 0; k < 2; k++)
            if (a->page_sizes[i][k] < 1 || a->page_sizes[i][k] > ATLAS_PAGE) abort();
    for (int i = 0; i < a->tile_count; i++) {
        const struct atlas_tile *t = &a->tiles[i];
        if (t->face < 1 || t->page < 0 || t->page >= a->page_count || t->x < 0 || t->y < 0 || t->width < 1 ||
            t->height < 1 || t->x > a->page_sizes[t->page][0] - t->width ||
            t->y > a->page_sizes[t->page][1] - t->height)
            abort();
        if (a->viewpoint ? t->view < 0 || t->view >= a->view_count : t->view != -1) abort();
        if (i && (t[-1].face > t->face || (t[-1].face == t->face && t[-1].view > t->view))) abort();
        for (int k = 0; k < 12; k++)
            if (!isfinite(t->matrix[k / 4][k % 4])) abort();
    }
}

/* Looks up some points of each face. */
static void look_up(const struct atlas *a, const struct atlas_page *p)
{
    for (int i = 0; i < a->tile_count; i++)
        for (int k = 0; k < 27; k++) {
            const struct vec3 at = vec3_make(k % 3 - 0.7, k / 3 % 3 - 0.9, k / 9 - 0.6);
            double x, y;
            float rgb[3];
            uint32_t nearest;
            const struct atlas_tile *t = atlas_find(a, a->tiles[i].face, at, &x, &y);
            if (t && t->face != a->tiles[i].face) abort();
            if (!t || !p || t->page || !atlas_sample(rgb, &nearest, p, t, x, y)) continue;
            if (!(rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0)) abort();
            if (nearest == ATLAS_NONE || nearest >= (uint32_t)(ATLAS_VIEWS + a->source_count)) abort();
        }
}

static void write_again(struct atlas *a)
{
    struct atlas again;
    struct err err = ERR_INIT;
    if (atlas_write_list(a, folder, NULL, &err)) return; /* a name is too long once it is quoted */
    if (atlas_read(&again, folder, NULL, &err)) abort();
    if (again.tile_count != a->tile_count || again.page_count != a->page_count || again.view_count != a->view_count ||
        again.source_count != a->source_count || !again.viewpoint != !a->viewpoint)
        abort();
    if (a->tile_count && memcmp(again.tiles, a->tiles, (size_t)a->tile_count * sizeof *a->tiles)) abort();
    if (atlas_pack(&again, &err)) abort();
    check_atlas(&again);
    atlas_release(&again);
}

static void write_page_again(const struct atlas *a, const struct atlas_page *p)
{
    const size_t texels = (size_t)p->width * (size_t)p->height;
    struct atlas_page again;
    struct err err = ERR_INIT;
    if (atlas_write_page(p, folder, 0, NULL, &err) || atlas_page_read(&again, a, 0, folder, NULL, &err)) abort();
    if (memcmp(again.source, p->source, texels * sizeof *p->source)) abort();
    atlas_page_release(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint8_t magic[] = {0x76, 0x2f, 0x31, 0x01};
    struct atlas a;
    struct atlas_page page = {0};
    struct err err = ERR_INIT;

    if (!list[0]) make_folder();
    unlink(picture);
    const uint8_t *separator = memmem(data, size, "%%\n", 3);
    if (size >= sizeof magic && !memcmp(data, magic, sizeof magic)) {
        write_bytes(picture, data, size);
        write_list_of_size();
    } else {
        const size_t length = separator ? (size_t)(separator - data) : size;
        write_bytes(list, data, length);
        if (separator) write_bytes(picture, separator + 3, size - length - 3);
    }

    enum status st = atlas_read(&a, folder, NULL, &err);
    if (st) {
        static const struct atlas empty;
        if (st != err.status || !strstr(err.text, folder) || memcmp(&a, &empty, sizeof empty)) abort();
        return 0;
    }
    check_atlas(&a);
    st = a.page_count ? atlas_page_read(&page, &a, 0, folder, NULL, &err) : ST_DATA;
    if (a.page_count && st && (!strstr(err.text, folder) || page.rgb)) abort();
    look_up(&a, st ? NULL : &page);
    if (!st) write_page_again(&a, &page);
    write_again(&a);
    atlas_page_release(&page);
    atlas_release(&a);
    return 0;
}
