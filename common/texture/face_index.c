/* face_index.c - reading and writing ids/index.txt: the views of each face, best first.
 *
 * A scene of 10 000 views has an index of hundreds of megabytes, and a process wants the lists of a few faces. So
 * the text begins with a table, one row of fixed length a face: id, offset and length of its list, number of views,
 * number of the first line. A face is found by binary search in the file, O(log faces) reads of a row, then its list
 * is read by one pread(). Memory is that of one list.
 *
 * Each piece is read as a text file of its own whose first line has the number that it has in the whole file, so
 * that errors name the right line. The provenance is in front of the table, whose beginning is found in the first 8
 * KiB.
 *
 * Writing: the lists are formatted twice, first for their lengths alone, so that the table can precede them. */
#include "common/texture/face_index.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/array.h"
#include "common/base/memory_text.h"
#include "common/product/product.h"

enum {
    HEAD = 8192,      /* bytes in which the table begins: the provenance is before it */
    LIST = 1 << 26,   /* bytes of the longest list */
    NAME_SIZE = 1024, /* of a view's name, quoted */
};
#define VIEW_FORMAT "view %s %d %d %.9g %.9g\n"
#define ROW_FORMAT  "at %10d %14lld %9lld %7d %14lld"

struct row {
    int64_t id, offset, bytes, views, line;
};

void face_views_release(struct face_views *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) free(list->views[i].name);
    free(list->views);
    *list = (struct face_views){0};
}

/* Reads a piece of the file as a text file of its own, whose first line has the number `line`. */
static enum status read_piece(struct textfile *t, struct face_index *index, int64_t offset, int64_t bytes, int line,
                              struct err *err)
{
    *t = (struct textfile){.path = strdup(index->path), .bytes = malloc((size_t)bytes + 1), .line = line - 1};
    if (!t->path || !t->bytes) return err_nomem(err, "a list of views", (size_t)bytes);
    while ((int64_t)t->size < bytes) {
        const ssize_t got = pread(index->file, t->bytes + t->size, (size_t)bytes - t->size, offset + (int64_t)t->size);
        if (got < 0) return err_errno(err, "read", index->path);
        if (!got) return err_set(err, ST_DATA, "%s has changed while it was read; try again.", index->path);
        t->size += (size_t)got;
    }
    t->bytes[t->size] = 0;
    index->bytes_read += bytes;
    if (!memchr(t->bytes, 0, t->size)) return ST_OK;
    return err_set(err, ST_DATA, "%s has a NUL byte; run trace_ids again.", index->path);
}

static enum status read_head(struct face_index *index, struct err *err)
{
    struct textfile t = {0};
    int64_t faces = 0;
    if (!read_piece(&t, index, 0, index->size < HEAD ? index->size : HEAD, 1, err) &&
        !product_read_head(&t, NULL, PRODUCT_FACE_INDEX, err) && !textfile_expect_line(&t, "faces", err) &&
        !textfile_int(&t, "number of faces", 0, index->size / FACE_INDEX_ROW, &faces, err))
        textfile_end(&t, err);
    index->faces = (int)faces;
    index->table = (int64_t)t.at;
    if (!err->status && index->table + faces * FACE_INDEX_ROW > index->size)
        err_set(err, ST_DATA, "%s ends within its table of %d faces; run trace_ids again.", index->path, index->faces);
    textfile_release(&t);
    return err->status;
}

enum status face_index_open(struct face_index *index, const char *path, struct provenance *prov, struct err *err)
{
    *index = (struct face_index){.file = -1};
    /* read in pieces, so that it is hashed by itself */
    if (prov && provenance_add_file(prov, product_name(PRODUCT_FACE_INDEX, path), path, err)) return err->status;
    index->file = open(path, O_RDONLY | O_CLOEXEC);
    if (index->file < 0) return err_errno(err, "open", path);
    index->path = strdup(path);
    if (!index->path) {
        close(index->file);
        return err_nomem(err, "a file name", strlen(path));
    }
    index->size = lseek(index->file, 0, SEEK_END);
    if (index->size < 0)
        err_errno(err, "read", path);
    else
        read_head(index, err);
    if (err->status) face_index_close(index);
    return err->status;
}

void face_index_close(struct face_index *index)
{
    if (!index) return;
    if (index->path) close(index->file);
    free(index->path);
    *index = (struct face_index){0};
}

static enum status read_row(struct row *r, struct face_index *index, int at, struct err *err)
{
    struct textfile t = {0};
    const int64_t end = index->table + (int64_t)index->faces * FACE_INDEX_ROW;
    if (!read_piece(&t, index, index->table + (int64_t)at * FACE_INDEX_ROW, FACE_INDEX_ROW, 1, err) &&
        t.bytes[FACE_INDEX_ROW - 1] != '\n')
        textfile_error(&t, err, NULL, "a row of %d bytes", FACE_INDEX_ROW);
    if (!err->status && !textfile_expect_line(&t, "at", err) && !textfile_int(&t, "face id", 1, INT_MAX, &r->id, err) &&
        !textfile_int(&t, "offset behind the table", end, index->size, &r->offset, err))
        textfile_int(&t, "bytes within the file", 1, index->size - r->offset, &r->bytes, err);
    if (!err->status && !textfile_int(&t, "number of views", 1, r->bytes, &r->views, err) &&
        !textfile_int(&t, "number of a line", 1, INT_MAX, &r->line, err))
        textfile_end(&t, err);
    if (!err->status && r->bytes > LIST) textfile_wrong_number(&t, (double)r->bytes, "fewer bytes", err);
    textfile_release(&t);
    return err_context(err, "row %d of the table of faces", at + 1);
}

/* Sets row to the face's, or its id to 0. */
static enum status find_row(struct row *row, struct face_index *index, int face, struct err *err)
{
    int low = 0, high = index->faces;
    while (low < high) {
        const int mid = low + (high - low) / 2;
        if (read_row(row, index, mid, err)) return err->status;
        if (row->id == face) return ST_OK;
        if (row->id < face)
            low = mid + 1;
        else
            high = mid;
    }
    row->id = 0;
    return ST_OK;
}

static enum status read_view(struct face_view *v, struct textfile *t, struct err *err)
{
    char *name = NULL;
    int64_t pixels = 0, clean = 0;
    if (textfile_expect_line(t, "view", err) || textfile_word(t, "name of a view", &name, err) ||
        textfile_int(t, "pixels", 1, INT_MAX, &pixels, err) ||
        textfile_int(t, "clean pixels", 0, pixels, &clean, err) || textfile_double(t, "distance", &v->distance, err) ||
        textfile_number(t, "cosine", 0, 1, &v->cosine, err) || textfile_end(t, err))
        return err->status;
    if (!(v->distance > 0)) return textfile_wrong_number(t, v->distance, "a distance above 0", err);
    v->pixels = (int)pixels;
    v->clean = (int)clean;
    v->name = strdup(name);
    return v->name ? ST_OK : err_nomem(err, "a name", strlen(name));
}

enum status face_index_load(struct face_views *list, struct face_index *index, int face, struct err *err)
{
    struct textfile t = {0};
    struct row row = {0};
    *list = (struct face_views){0};
    if (find_row(&row, index, face, err) || !row.id) return err->status;
    read_piece(&t, index, row.offset, row.bytes, (int)row.line, err);
    for (int64_t i = 0; !err->status && i < row.views; i++) {
        if (array_append(&list->views, (size_t)list->count, sizeof *list->views, "views", err)) break;
        struct face_view *v = &list->views[list->count++];
        *v = (struct face_view){0};
        read_view(v, &t, err);
    }
    if (!err->status) textfile_end_of_file(&t, err);
    textfile_release(&t);
    if (err->status) face_views_release(list);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------- writing */

static enum status print_view(char *line, size_t size, const struct face_view *v, int *length, struct err *err)
{
    char name[NAME_SIZE];
    if (textfile_quote(v->name, name, sizeof name, err)) return err->status;
    *length = snprintf(line, size, VIEW_FORMAT, name, v->pixels, v->clean, v->distance, v->cosine);
    return ST_OK;
}

/* The table; the lists follow it. offset: of the first list; line: its first line. */
static enum status write_table(FILE *to, const int *ids, const struct face_views *lists, int count, int64_t offset,
                               int64_t line, struct err *err)
{
    char text[NAME_SIZE + 128];
    for (int i = 0; i < count; i++) {
        int64_t bytes = 0;
        for (int k = 0; k < lists[i].count; k++) {
            int length = 0;
            if (print_view(text, sizeof text, &lists[i].views[k], &length, err)) return err->status;
            bytes += length;
        }
        if (bytes > LIST) return err_set(err, ST_DATA, "face %d: the list of its views is too long.", ids[i]);
        snprintf(text, sizeof text, ROW_FORMAT, ids[i], (long long)offset, (long long)bytes, lists[i].count,
                 (long long)line);
        fprintf(to, "%-*s\n", FACE_INDEX_ROW - 1, text);
        offset += bytes;
        line += lists[i].count;
    }
    return ST_OK;
}

/* Lines that were written so far: those of the provenance are counted by reading it again. */
static int64_t count_lines(const struct provenance *prov, struct err *err)
{
    struct memory_text m = {0};
    int64_t lines = 0;
    if (!prov || memory_text_open(&m, "a file's head", err)) return 0;
    provenance_print(prov, m.to);
    memory_text_close(&m, "a file's head", err);
    for (size_t i = 0; i < m.size; i++) lines += m.text[i] == '\n';
    memory_text_release(&m);
    return lines;
}

enum status face_index_write(const char *path, const int *ids, const struct face_views *lists, int count,
                             const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    char text[NAME_SIZE + 128];
    if (!product_begin(&f, PRODUCT_FACE_INDEX, path, prov, err)) {
        fprintf(f.fp, "faces %d\n", count);
        const int64_t table = ftell(f.fp);
        const int64_t head = count_lines(prov, err);
        if (!err->status)
            write_table(f.fp, ids, lists, count, table + (int64_t)count * FACE_INDEX_ROW, head + 3 + count, err);
    }
    for (int i = 0; !err->status && i < count; i++)
        for (int k = 0; !err->status && k < lists[i].count; k++) {
            int length = 0;
            if (!print_view(text, sizeof text, &lists[i].views[k], &length, err)) fwrite(text, 1, (size_t)length, f.fp);
        }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
