/* atlas_file.c - atlases on disk: atlas.txt and its pages (docs/formats.md). */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/base/textfile.h"
#include "common/image/exr.h"
#include "common/texture/atlas.h"

#define HEADER "remodel-atlas"

static const char *const channels[] = {"R", "G", "B", "A", "source"};

/* ---------------------------------------------------------------------------------------------------------- writing */

static enum status page_path(char path[FILE_PATH], const char *folder, int page, struct err *err)
{
    char name[32];
    snprintf(name, sizeof name, "page%d", page);
    return file_path(path, folder, name, ".exr", err);
}

enum status atlas_write_page(const struct atlas_page *p, const char *folder, int page, const struct provenance *prov,
                             struct err *err)
{
    const size_t texels = (size_t)p->width * (size_t)p->height;
    struct exr_image exr = {0};
    char path[FILE_PATH];
    enum status st = page_path(path, folder, page, err);
    if (!st) st = exr_image_init(&exr, p->width, p->height, err);
    for (int k = 0; !st && k < 5; k++) st = exr_add_plane(&exr, channels[k], k < 4 ? EXR_HALF : EXR_UINT, NULL, err);
    for (size_t i = 0; !st && i < texels; i++) {
        if (p->source[i] == ATLAS_NONE) continue;
        for (int c = 0; c < 3; c++) exr.planes[c].f[i] = p->rgb[3 * i + (size_t)c];
        exr.planes[3].f[i] = 1;
        exr.planes[4].u[i] = p->source[i];
    }
    if (!st) st = exr_write(&exr, path, prov, err);
    exr_image_release(&exr);
    return st;
}

static void print_tile(FILE *to, const struct atlas_tile *t)
{
    fprintf(to, "tile %d %d %d %d %d %d %d", t->face, t->view, t->page, t->x, t->y, t->width, t->height);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++) fprintf(to, " %.17g", t->matrix[i][k]);
    fputc('\n', to);
}

static enum status write_list(const struct atlas *a, const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile file = {0};
    enum status st = outfile_open(&file, path, err);
    if (!st) {
        fprintf(file.fp, HEADER " 1\n");
        provenance_print(prov, file.fp);
        if (a->viewpoint)
            fprintf(file.fp, "viewpoint %s %.17g %.17g %.17g\n", a->viewpoint, a->centre.x, a->centre.y, a->centre.z);
        for (int i = 0; i < a->view_count; i++) fprintf(file.fp, "view %s\n", a->views[i]);
        for (int i = 0; i < a->source_count; i++) fprintf(file.fp, "source %s\n", a->sources[i]);
        for (int i = 0; i < a->page_count; i++)
            fprintf(file.fp, "page %d %d\n", a->page_sizes[i][0], a->page_sizes[i][1]);
        for (int i = 0; i < a->tile_count; i++) print_tile(file.fp, &a->tiles[i]);
        st = outfile_commit(&file, err);
    }
    outfile_discard(&file);
    return st;
}

enum status atlas_write_list(const struct atlas *a, const char *folder, const struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    enum status st = file_path(path, folder, "atlas", ".txt", err);
    if (!st) st = write_list(a, path, prov, err);
    for (int i = a->page_count; !st; i++) {
        st = page_path(path, folder, i, err);
        if (!st && unlink(path)) break;
    }
    return st;
}

enum status atlas_write(const struct atlas *a, const struct atlas_page *pages, const char *folder,
                        const struct provenance *prov, struct err *err)
{
    enum status st = ST_OK;
    for (int i = 0; !st && i < a->page_count; i++) st = atlas_write_page(&pages[i], folder, i, prov, err);
    return st ? st : atlas_write_list(a, folder, prov, err);
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_name(char ***names, int *count, struct textfile *t, const char *what, struct err *err)
{
    char *word = NULL;
    enum status st = textfile_word(t, what, &word, err);
    if (!st) st = array_append(names, (size_t)*count, sizeof **names, what, err);
    if (!st && !((*names)[*count] = strdup(word))) st = err_nomem(err, "a name", strlen(word));
    if (!st) ++*count;
    return st ? st : textfile_end(t, err);
}

static enum status read_viewpoint(struct atlas *a, struct textfile *t, struct err *err)
{
    char *word = NULL;
    if (a->viewpoint) return textfile_error(t, err, "viewpoint", "one line viewpoint");
    enum status st = textfile_word(t, "photo", &word, err);
    if (!st && !(a->viewpoint = strdup(word))) st = err_nomem(err, "a name", strlen(word));
    if (!st) st = textfile_double(t, "X", &a->centre.x, err);
    if (!st) st = textfile_double(t, "Y", &a->centre.y, err);
    if (!st) st = textfile_double(t, "Z", &a->centre.z, err);
    return st ? st : textfile_end(t, err);
}

static enum status read_ints(struct textfile *t, const char *const *what, const int (*limits)[2], int *values,
                             int count, struct err *err)
{
    enum status st = ST_OK;
    for (int i = 0; !st && i < count; i++) {
        int64_t value = 0;
        st = textfile_int(t, what[i], limits[i][0], limits[i][1], &value, err);
        values[i] = (int)value;
    }
    return st;
}

static enum status read_page_size(struct atlas *a, struct textfile *t, struct err *err)
{
    static const char *const what[] = {"width", "height"};
    static const int limits[][2] = {{1, ATLAS_PAGE}, {1, ATLAS_PAGE}};
    int size[2];
    enum status st = read_ints(t, what, limits, size, 2, err);
    if (!st) st = array_append(&a->page_sizes, (size_t)a->page_count, sizeof *a->page_sizes, "pages", err);
    if (!st) memcpy(a->page_sizes[a->page_count++], size, sizeof size);
    return st ? st : textfile_end(t, err);
}

static enum status read_tile(struct atlas *a, struct textfile *t, struct err *err)
{
    static const char *const what[] = {"face", "view", "page", "x", "y", "width", "height"};
    const int limits[][2] = {{1, INT_MAX},           {a->viewpoint ? 0 : -1, a->viewpoint ? a->view_count - 1 : -1},
                             {0, a->page_count - 1}, {0, ATLAS_PAGE - 1},
                             {0, ATLAS_PAGE - 1},    {1, ATLAS_PAGE},
                             {1, ATLAS_PAGE}};
    int v[7];
    enum status st = read_ints(t, what, limits, v, 7, err);
    struct atlas_tile tile = {v[0], v[1], v[2], v[3], v[4], v[5], v[6], {{0}}};
    if (!st &&
        (tile.x + tile.width > a->page_sizes[tile.page][0] || tile.y + tile.height > a->page_sizes[tile.page][1]))
        st = textfile_error(t, err, "a tile that is larger", "a tile inside its page of %d x %d texels",
                            a->page_sizes[tile.page][0], a->page_sizes[tile.page][1]);
    for (int i = 0; !st && i < 12; i++)
        st = textfile_double(t, "an element of the matrix", &tile.matrix[i / 4][i % 4], err);
    if (!st) st = array_append(&a->tiles, (size_t)a->tile_count, sizeof *a->tiles, "tiles", err);
    if (!st) a->tiles[a->tile_count++] = tile;
    return st ? st : textfile_end(t, err);
}

static enum status read_line(struct atlas *a, struct textfile *t, struct err *err)
{
    char *word = NULL;
    enum status st = textfile_word(t, "viewpoint, view, source, page or tile", &word, err);
    if (st) return st;
    if (!strcmp(word, "viewpoint")) return read_viewpoint(a, t, err);
    if (!strcmp(word, "view")) return read_name(&a->views, &a->view_count, t, "view", err);
    if (!strcmp(word, "source")) return read_name(&a->sources, &a->source_count, t, "source", err);
    if (!strcmp(word, "page")) return read_page_size(a, t, err);
    if (!strcmp(word, "tile")) return read_tile(a, t, err);
    return textfile_error(t, err, word, "viewpoint, view, source, page or tile");
}

enum status atlas_read(struct atlas *a, const char *folder, struct err *err)
{
    struct textfile t = {0};
    char path[FILE_PATH];
    int64_t version;
    *a = (struct atlas){0};
    enum status st = file_path(path, folder, "atlas", ".txt", err);
    if (!st) st = textfile_open(&t, path, err);
    if (!st) st = textfile_expect_line(&t, HEADER, err);
    if (!st) st = textfile_int(&t, "version", 1, 1, &version, err);
    if (!st) st = textfile_end(&t, err);
    while (!st && textfile_next(&t)) st = read_line(a, &t, err);
    textfile_release(&t);
    if (st) atlas_release(a);
    return st;
}

enum status atlas_page_read(struct atlas_page *p, const struct atlas *a, int page, const char *folder, struct err *err)
{
    struct exr_image exr = {0};
    char path[FILE_PATH];
    *p = (struct atlas_page){0};
    enum status st = page_path(path, folder, page, err);
    if (!st) st = exr_read(&exr, path, channels, 5, err);
    if (!st && (exr.width != a->page_sizes[page][0] || exr.height != a->page_sizes[page][1]))
        st = err_set(err, ST_DATA, "%s has %d x %d texels, but atlas.txt says %d x %d; bake it again.", path, exr.width,
                     exr.height, a->page_sizes[page][0], a->page_sizes[page][1]);
    for (int k = 0; !st && k < 5; k++)
        if ((k < 4) != (exr_find(&exr, channels[k])->f != NULL))
            st = err_set(err, ST_DATA, "%s: channel %s has the wrong type; bake it again.", path, channels[k]);
    if (!st) st = atlas_page_init(p, exr.width, exr.height, err);
    const size_t texels = st ? 0 : (size_t)exr.width * (size_t)exr.height;
    const uint32_t *source = st ? NULL : exr_find(&exr, "source")->u;
    for (size_t i = 0; !st && i < texels; i++) {
        p->source[i] = source[i];
        if (source[i] >= (uint32_t)ATLAS_VIEWS + (uint32_t)a->source_count)
            st =
                err_set(err, ST_DATA, "%s: texel %zu, %zu comes from source %u, but atlas.txt lists %d; bake it again.",
                        path, i % (size_t)exr.width, i / (size_t)exr.width, source[i] - ATLAS_VIEWS, a->source_count);
    }
    for (int c = 0; !st && c < 3; c++) {
        const float *from = exr_find(&exr, channels[c])->f;
        for (size_t i = 0; i < texels; i++) p->rgb[3 * i + (size_t)c] = from[i];
    }
    exr_image_release(&exr);
    if (st) atlas_page_release(p);
    return st;
}
