/* atlas_file.c - atlases on disk: atlas.txt and its pages (docs/formats.md).
 *
 * A page is an EXR with R G B A as half floats and `source`, which says where a texel comes from: none, synthesised,
 * the default colour, or the number of a view. atlas.txt lists viewpoint, views, sources, pages, and tiles with the
 * matrix that leads from the model to the page.
 *
 * Pages are written first and the list last: a list stands for a complete atlas. Then pages beyond the last number
 * are removed, so that a smaller atlas leaves nothing of a larger one before it.
 *
 * Order. Tiles are written by face, then view, so that a look-up of a face is a binary search, and so that the file
 * does not depend on the order of the work. The reader refuses another order, names that are not sorted, and tiles
 * that do not lie in their page.
 *
 * Pages are read one at a time by atlas_page_read(): an atlas of many pages is never in memory as a whole. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/array.h"
#include "common/image/exr.h"
#include "common/product/product.h"
#include "common/texture/atlas.h"

enum { NAME_SIZE = 1024 }; /* of a quoted name */

static const char *const channels[] = {"R", "G", "B", "A", "source"};

/* ---------------------------------------------------------------------------------------------------------- writing */

enum status atlas_page_path(char path[FILE_PATH], const char *folder, int page, struct err *err)
{
    return product_path_in(path, folder, PRODUCT_ATLAS_PAGE, &(struct product_key){.page = page}, err);
}

enum status atlas_write_page(const struct atlas_page *p, const char *folder, int page, const struct provenance *prov,
                             struct err *err)
{
    const size_t texels = (size_t)p->width * (size_t)p->height;
    struct exr_image exr = {0};
    char path[FILE_PATH];
    if (!atlas_page_path(path, folder, page, err)) exr_image_init(&exr, p->width, p->height, err);
    for (int k = 0; !err->status && k < 5; k++)
        exr_add_plane(&exr, channels[k], k < 4 ? EXR_HALF : EXR_UINT, NULL, err);
    for (size_t i = 0; !err->status && i < texels; i++) {
        if (p->source[i] == ATLAS_NONE) continue;
        for (int c = 0; c < 3; c++) {
            const float value = p->rgb[3 * i + (size_t)c];
            exr.planes[c].f[i] = value < 0 ? 0 : value;
        }
        exr.planes[3].f[i] = 1;
        exr.planes[4].u[i] = p->source[i];
    }
    if (!err->status) exr_write(&exr, path, prov, err);
    exr_image_release(&exr);
    return err->status;
}

static void print_tile(FILE *to, const struct atlas_tile *t)
{
    fprintf(to, "tile %d %d %d %d %d %d %d", t->face, t->view, t->page, t->x, t->y, t->width, t->height);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++) fprintf(to, " %.17g", t->matrix[i][k]);
    fputc('\n', to);
}

/* The order of tiles in the file: by face, then view, then as they were. */
static int compare_tiles(const void *a, const void *b)
{
    const struct atlas_tile *p = *(const struct atlas_tile *const *)a, *q = *(const struct atlas_tile *const *)b;
    if (p->face != q->face) return p->face < q->face ? -1 : 1;
    if (p->view != q->view) return p->view < q->view ? -1 : 1;
    return p < q ? -1 : p > q;
}

static enum status print_tiles(FILE *to, const struct atlas *a, struct err *err)
{
    const size_t n = (size_t)a->tile_count;
    const struct atlas_tile **order = malloc((n + 1) * sizeof *order);
    if (!order) return err_nomem(err, "tiles", n * sizeof *order);
    for (size_t i = 0; i < n; i++) order[i] = &a->tiles[i];
    qsort(order, n, sizeof *order, compare_tiles);
    for (size_t i = 0; i < n; i++) print_tile(to, order[i]);
    free(order);
    return ST_OK;
}

static enum status print_names(FILE *to, const char *what, char *const *names, int count, struct err *err)
{
    char name[NAME_SIZE];
    for (int i = 0; i < count; i++) {
        if (textfile_quote(names[i], name, sizeof name, err)) return err->status;
        fprintf(to, "%s %s\n", what, name);
    }
    return ST_OK;
}

static enum status print_list(FILE *to, const struct atlas *a, struct err *err)
{
    char name[NAME_SIZE];
    if (a->viewpoint) {
        if (textfile_quote(a->viewpoint, name, sizeof name, err)) return err->status;
        fprintf(to, "viewpoint %s %.17g %.17g %.17g\n", name, a->centre.x, a->centre.y, a->centre.z);
    }
    if (print_names(to, "view", a->views, a->view_count, err) ||
        print_names(to, "source", a->sources, a->source_count, err))
        return err->status;
    for (int i = 0; i < a->page_count; i++) fprintf(to, "page %d %d\n", a->page_sizes[i][0], a->page_sizes[i][1]);
    return print_tiles(to, a, err);
}

static enum status write_list(const struct atlas *a, const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile file = {0};
    if (!product_begin(&file, PRODUCT_ATLAS, path, prov, err) && !print_list(file.fp, a, err))
        outfile_commit(&file, err);
    outfile_discard(&file);
    return err->status;
}

enum status atlas_write_list(const struct atlas *a, const char *folder, const struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    if (!product_path_in(path, folder, PRODUCT_ATLAS, NULL, err)) write_list(a, path, prov, err);
    for (int i = a->page_count; !err->status; i++)
        if (!atlas_page_path(path, folder, i, err) && unlink(path)) break;
    return err->status;
}

enum status atlas_write(const struct atlas *a, const struct atlas_page *pages, const char *folder,
                        const struct provenance *prov, struct err *err)
{
    for (int i = 0; !err->status && i < a->page_count; i++) atlas_write_page(&pages[i], folder, i, prov, err);
    if (!err->status) atlas_write_list(a, folder, prov, err);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

/* The first word of the next line; NULL: there is no line. */
static enum status next_word(struct textfile *t, char **word, struct err *err)
{
    *word = NULL;
    return textfile_next(t) ? textfile_word(t, "viewpoint, view, source, page or tile", word, err) : ST_OK;
}

static enum status copy_name(char **name, struct textfile *t, const char *what, char **word, struct err *err)
{
    if (textfile_word(t, what, word, err)) return err->status;
    *name = strdup(*word);
    return *name ? ST_OK : err_nomem(err, "a name", strlen(*word) + 1);
}

/* Lines WHAT NAME. *word: the first word of the current line, and of the line after them. */
static enum status read_names(char ***names, int *count, struct textfile *t, const char *what, char **word,
                              struct err *err)
{
    while (*word && !strcmp(*word, what)) {
        char *found = NULL;
        if (array_append(names, (size_t)*count, sizeof **names, "names", err)) return err->status;
        if (copy_name(&(*names)[*count], t, "a name", &found, err)) return err->status;
        const int i = (*count)++;
        if (i && strcmp((*names)[i - 1], (*names)[i]) >= 0)
            return textfile_error(t, err, found, "a name after %s, as each is listed once, in order", (*names)[i - 1]);
        if (textfile_end(t, err) || next_word(t, word, err)) return err->status;
    }
    return ST_OK;
}

static enum status read_viewpoint(struct atlas *a, struct textfile *t, char **word, struct err *err)
{
    char *found;
    if (!*word || strcmp(*word, "viewpoint")) return ST_OK;
    if (copy_name(&a->viewpoint, t, "a photo", &found, err) || textfile_double(t, "X", &a->centre.x, err) ||
        textfile_double(t, "Y", &a->centre.y, err) || textfile_double(t, "Z", &a->centre.z, err) ||
        textfile_end(t, err))
        return err->status;
    return next_word(t, word, err);
}

struct number {
    const char *what;
    int min, max;
};

static enum status read_numbers(struct textfile *t, const struct number *n, int count, int *values, struct err *err)
{
    for (int i = 0; i < count; i++) {
        int64_t value = 0;
        if (textfile_int(t, n[i].what, n[i].min, n[i].max, &value, err)) return err->status;
        values[i] = (int)value;
    }
    return ST_OK;
}

static enum status read_pages(struct atlas *a, struct textfile *t, char **word, struct err *err)
{
    static const struct number sides[] = {{"width", 1, ATLAS_PAGE}, {"height", 1, ATLAS_PAGE}};
    while (*word && !strcmp(*word, "page")) {
        if (array_append(&a->page_sizes, (size_t)a->page_count, sizeof *a->page_sizes, "pages", err) ||
            read_numbers(t, sides, 2, a->page_sizes[a->page_count], err) || textfile_end(t, err))
            return err->status;
        a->page_count++;
        if (next_word(t, word, err)) return err->status;
    }
    return ST_OK;
}

static enum status read_rectangle(struct atlas_tile *tile, const struct atlas *a, struct textfile *t, struct err *err)
{
    int v[4];
    const int *page = a->page_sizes[tile->page];
    const struct number corner[] = {{"x", 0, page[0] - 1}, {"y", 0, page[1] - 1}};
    if (read_numbers(t, corner, 2, v, err)) return err->status;
    const struct number sides[] = {{"width inside the page", 1, page[0] - v[0]},
                                   {"height inside the page", 1, page[1] - v[1]}};
    if (read_numbers(t, sides, 2, v + 2, err)) return err->status;
    tile->x = v[0], tile->y = v[1], tile->width = v[2], tile->height = v[3];
    return ST_OK;
}

static enum status read_tile(struct atlas *a, struct textfile *t, struct err *err)
{
    const int first_view = a->viewpoint ? 0 : -1, last_view = a->viewpoint ? a->view_count - 1 : -1;
    const struct number numbers[] = {
        {"face", 1, INT_MAX}, {"view", first_view, last_view}, {"page", 0, a->page_count - 1}};
    int v[3];
    if (array_append(&a->tiles, (size_t)a->tile_count, sizeof *a->tiles, "tiles", err) ||
        read_numbers(t, numbers, 3, v, err))
        return err->status;
    struct atlas_tile *tile = &a->tiles[a->tile_count];
    *tile = (struct atlas_tile){.face = v[0], .view = v[1], .page = v[2]};
    if (a->tile_count && (tile[-1].face > v[0] || (tile[-1].face == v[0] && tile[-1].view > v[1])))
        return textfile_wrong_number(t, v[0], "tiles in order of face, then view", err);
    if (read_rectangle(tile, a, t, err)) return err->status;
    for (int i = 0; i < 12; i++)
        if (textfile_double(t, "an element of the matrix", &tile->matrix[i / 4][i % 4], err)) return err->status;
    a->tile_count++;
    return textfile_end(t, err);
}

static enum status read_tiles(struct atlas *a, struct textfile *t, char **word, struct err *err)
{
    while (*word) {
        if (strcmp(*word, "tile")) return textfile_error(t, err, *word, "viewpoint, view, source, page, tile in order");
        if (read_tile(a, t, err) || next_word(t, word, err)) return err->status;
    }
    return ST_OK;
}

static enum status read_list(struct atlas *a, struct textfile *t, struct err *err)
{
    char *word = NULL;
    if (next_word(t, &word, err) || read_viewpoint(a, t, &word, err) ||
        read_names(&a->views, &a->view_count, t, "view", &word, err))
        return err->status;
    if (!a->viewpoint != !a->view_count)
        return textfile_error(t, err, word, a->viewpoint ? "a view of the viewpoint" : "a viewpoint before its views");
    if (read_names(&a->sources, &a->source_count, t, "source", &word, err) || read_pages(a, t, &word, err))
        return err->status;
    return read_tiles(a, t, &word, err);
}

enum status atlas_read(struct atlas *a, const char *folder, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    char path[FILE_PATH];
    *a = (struct atlas){0};
    if (!product_path_in(path, folder, PRODUCT_ATLAS, NULL, err) &&
        !product_open(&t, NULL, PRODUCT_ATLAS, path, prov, err))
        read_list(a, &t, err);
    textfile_release(&t);
    if (err->status) atlas_release(a);
    return err->status;
}

static enum status wrong_texel(const struct exr_image *exr, size_t at, uint32_t source, int sources, const char *path,
                               struct err *err)
{
    return err_set(err, ST_DATA,
                   "%s: texel (%zu, %zu) has R G B %g %g %g, A %g and source %u; wanted colours of 0 or more, a source "
                   "below %d, and A 1 with a source, or all 0 without. Bake it again.",
                   path, at % (size_t)exr->width, at / (size_t)exr->width, (double)exr_find(exr, "R")->f[at],
                   (double)exr_find(exr, "G")->f[at], (double)exr_find(exr, "B")->f[at],
                   (double)exr_find(exr, "A")->f[at], source, ATLAS_VIEWS + sources);
}

static enum status take_page(struct atlas_page *p, const struct exr_image *exr, const struct atlas *a, const char *path,
                             struct err *err)
{
    const struct exr_plane *planes[5];
    for (int k = 0; k < 5; k++) {
        planes[k] = exr_find(exr, channels[k]);
        if (k < 4 ? !planes[k]->f : !planes[k]->u)
            return err_set(err, ST_DATA, "%s: channel %s has the wrong type; bake it again.", path, channels[k]);
    }
    if (atlas_page_init(p, exr->width, exr->height, err)) return err->status;
    const size_t texels = (size_t)exr->width * (size_t)exr->height;
    const uint32_t sources = (uint32_t)ATLAS_VIEWS + (uint32_t)a->source_count;
    for (size_t i = 0; i < texels; i++) {
        const uint32_t source = planes[4]->u[i];
        const float alpha = planes[3]->f[i];
        bool right = source < sources && alpha == (source == ATLAS_NONE ? 0 : 1);
        for (int c = 0; c < 3; c++) {
            const float value = planes[c]->f[i];
            right &= source == ATLAS_NONE ? value == 0 : value >= 0;
            p->rgb[3 * i + (size_t)c] = value;
        }
        if (!right) return wrong_texel(exr, i, source, a->source_count, path, err);
        p->source[i] = source;
    }
    return ST_OK;
}

enum status atlas_page_read(struct atlas_page *p, const struct atlas *a, int page, const char *folder,
                            struct provenance *prov, struct err *err)
{
    struct exr_image exr = {0};
    char path[FILE_PATH];
    *p = (struct atlas_page){0};
    if (!atlas_page_path(path, folder, page, err))
        exr_read_product(&exr, PRODUCT_ATLAS_PAGE, path, channels, 5, prov, err);
    if (!err->status && (exr.width != a->page_sizes[page][0] || exr.height != a->page_sizes[page][1]))
        err_set(err, ST_DATA, "%s has %d x %d texels, but atlas.txt says %d x %d; bake it again.", path, exr.width,
                exr.height, a->page_sizes[page][0], a->page_sizes[page][1]);
    if (!err->status) take_page(p, &exr, a, path, err);
    exr_image_release(&exr);
    if (err->status) atlas_page_release(p);
    return err->status;
}
