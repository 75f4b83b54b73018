/* face_index.c - see face_index.h. */
#include "common/texture/face_index.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/base/textfile.h"

#define RECORD_HEADER "remodel-view-faces"
#define INDEX_HEADER  "remodel-face-index"

static enum status read_header(struct textfile *t, const char *header, struct err *err)
{
    int64_t version;
    enum status st = textfile_expect_line(t, header, err);
    if (!st) st = textfile_int(t, "version", 1, 1, &version, err);
    return st ? st : textfile_end(t, err);
}

/* PIXELS CLEAN Z COSINE, to the end of the line. */
static enum status read_seen(struct textfile *t, struct face_view *v, struct err *err)
{
    int64_t pixels, clean;
    enum status st = textfile_int(t, "pixels", 1, INT_MAX, &pixels, err);
    if (!st) st = textfile_int(t, "clean pixels", 0, pixels, &clean, err);
    if (!st) st = textfile_double(t, "mean depth", &v->z, err);
    if (!st && !(v->z > 0)) st = textfile_wrong_number(t, v->z, "a depth above 0", err);
    if (!st) st = textfile_double(t, "mean cosine", &v->cosine, err);
    if (!st && !(v->cosine >= 0 && v->cosine <= 1))
        st = textfile_wrong_number(t, v->cosine, "a cosine from 0 to 1", err);
    if (!st) st = textfile_end(t, err);
    if (!st) v->pixels = (int)pixels, v->clean = (int)clean;
    return st;
}

static void print_seen(FILE *to, const struct face_view *v)
{
    fprintf(to, "%d %d %.9g %.9g\n", v->pixels, v->clean, v->z, v->cosine);
}

enum status face_records_write(const struct face_record *records, int count, const char *path,
                               const struct provenance *prov, struct err *err)
{
    struct outfile file = {0};
    enum status st = outfile_open(&file, path, err);
    if (!st) {
        fprintf(file.fp, RECORD_HEADER " 1\n");
        provenance_print(prov, file.fp);
        for (int i = 0; i < count; i++) {
            fprintf(file.fp, "face %d ", records[i].id);
            print_seen(file.fp, &records[i].seen);
        }
        st = outfile_commit(&file, err);
    }
    outfile_discard(&file);
    return st;
}

/* ------------------------------------------------------------------------------------------------ making the index */

struct entry {
    int id, view; /* index into the views' names */
    struct face_view seen;
};

static double worth(const struct face_view *v) { return v->clean * v->cosine; }

static int compare_entries(const void *a, const void *b)
{
    const struct entry *p = a, *q = b;
    if (p->id != q->id) return p->id < q->id ? -1 : 1;
    const double worth_p = worth(&p->seen), worth_q = worth(&q->seen);
    if (worth_p != worth_q) return worth_p > worth_q ? -1 : 1;
    return p->view < q->view ? -1 : p->view > q->view;
}

static enum status read_record(struct entry **entries, size_t *count, size_t *room, const char *path, int view,
                               struct err *err)
{
    struct textfile t = {0};
    enum status st = textfile_open(&t, path, err);
    if (!st) st = read_header(&t, RECORD_HEADER, err);
    while (!st && textfile_next(&t)) {
        struct entry e = {.view = view};
        int64_t id;
        st = textfile_expect(&t, "face", err);
        if (!st) st = textfile_int(&t, "face id", 1, INT_MAX, &id, err);
        if (!st) st = read_seen(&t, &e.seen, err);
        if (!st) st = array_reserve(entries, room, *count + 1, sizeof **entries, "faces of views", err);
        if (!st) e.id = (int)id, (*entries)[(*count)++] = e;
    }
    textfile_release(&t);
    return st;
}

enum status face_index_write(const char *folder, const char *const *views, int view_count, const char *path,
                             struct provenance *prov, struct err *err)
{
    struct entry *entries = NULL;
    size_t count = 0, room = 0;
    struct outfile file = {0};
    enum status st = ST_OK;
    for (int i = 0; !st && i < view_count; i++) {
        char record[FILE_PATH];
        st = provenance_add_in(prov, "ids", folder, views[i], ".txt", record, err);
        if (!st) st = read_record(&entries, &count, &room, record, i, err);
    }
    if (!st && count) qsort(entries, count, sizeof *entries, compare_entries);
    if (!st) st = outfile_open(&file, path, err);
    if (!st) {
        fprintf(file.fp, INDEX_HEADER " 1\n");
        for (size_t i = 0; i < count; i++) {
            fprintf(file.fp, "face %d %s ", entries[i].id, views[entries[i].view]);
            print_seen(file.fp, &entries[i].seen);
        }
        st = outfile_commit(&file, err);
    }
    outfile_discard(&file);
    free(entries);
    return st;
}

/* ------------------------------------------------------------------------------------------------------- reading it */

static bool is_asked_for(int id, const int *ids, int count)
{
    int low = 0, high = count;
    if (!ids) return true;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (ids[middle] < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && ids[low] == id;
}

static enum status add_view(struct face_index *index, int id, const struct face_view *seen, const char *view,
                            struct err *err)
{
    if (!index->count || index->faces[index->count - 1].id != id) {
        if (array_append(&index->faces, (size_t)index->count, sizeof *index->faces, "faces", err)) return err->status;
        index->faces[index->count++] = (struct face_views){.id = id};
    }
    struct face_views *f = &index->faces[index->count - 1];
    if (array_append(&f->views, (size_t)f->count, sizeof *f->views, "views of a face", err)) return err->status;
    f->views[f->count] = *seen;
    f->views[f->count].view = strdup(view);
    if (!f->views[f->count].view) return err_nomem(err, "a name", strlen(view));
    f->count++;
    return ST_OK;
}

enum status face_index_read(struct face_index *index, const char *path, const int *ids, int id_count, struct err *err)
{
    struct textfile t = {0};
    int64_t last = 0;
    *index = (struct face_index){0};
    enum status st = textfile_open(&t, path, err);
    if (!st) st = read_header(&t, INDEX_HEADER, err);
    while (!st && textfile_next(&t)) {
        struct face_view seen = {0};
        char *view = NULL;
        int64_t id;
        st = textfile_expect(&t, "face", err);
        if (!st) st = textfile_int(&t, "face id, in ascending order", last > 1 ? last : 1, INT_MAX, &id, err);
        if (!st) st = textfile_word(&t, "view", &view, err);
        if (!st) st = read_seen(&t, &seen, err);
        if (!st) last = id;
        if (!st && is_asked_for((int)id, ids, id_count)) st = add_view(index, (int)id, &seen, view, err);
    }
    textfile_release(&t);
    if (st) face_index_release(index);
    return st;
}

static int compare_faces(const void *id, const void *face)
{
    const int a = *(const int *)id, b = ((const struct face_views *)face)->id;
    return a < b ? -1 : a > b;
}

const struct face_views *face_index_find(const struct face_index *index, int id)
{
    if (!index->count) return NULL;
    return bsearch(&id, index->faces, (size_t)index->count, sizeof *index->faces, compare_faces);
}

void face_index_release(struct face_index *index)
{
    for (int i = 0; i < index->count; i++) {
        for (int k = 0; k < index->faces[i].count; k++) free(index->faces[i].views[k].view);
        free(index->faces[i].views);
    }
    free(index->faces);
    *index = (struct face_index){0};
}
