/* ledger_file.c - reads and writes the ledger of a scene. */
#include "stages/verify/ledger_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/memory_text.h"
#include "common/base/outfile.h"
#include "common/base/textfile.h"

enum status ledger_append(struct ledger *l, const char *hash, const char *maker, const char *path, struct err *err)
{
    struct ledger_entry e = {0};
    snprintf(e.hash, sizeof e.hash, "%s", hash);
    snprintf(e.maker, sizeof e.maker, "%s", maker);
    if (array_append(&l->entries, (size_t)l->count, sizeof e, "files of a ledger", err)) return err->status;
    if (!(e.path = strdup(path))) return err_nomem(err, "a file of a ledger", strlen(path) + 1);
    l->entries[l->count++] = e;
    return ST_OK;
}

static int by_path(const void *a, const void *b)
{
    return strcmp(((const struct ledger_entry *)a)->path, ((const struct ledger_entry *)b)->path);
}

/* Merges halves: unlike qsort() it keeps the order of equal paths. */
static void sort_range(struct ledger_entry *e, struct ledger_entry *spare, int count)
{
    if (count < 2) return;
    const int half = count / 2;
    sort_range(e, spare, half);
    sort_range(e + half, spare, count - half);
    memcpy(spare, e, (size_t)half * sizeof *e);
    for (int i = 0, j = half, k = 0; i < half; k++)
        e[k] = j < count && by_path(&e[j], &spare[i]) < 0 ? e[j++] : spare[i++];
}

enum status ledger_sort(struct ledger *l, struct err *err)
{
    struct ledger_entry *spare = malloc(((size_t)l->count / 2 + 1) * sizeof *spare);
    if (!spare) return err_nomem(err, "sorting a ledger", (size_t)l->count * sizeof *spare);
    sort_range(l->entries, spare, l->count);
    free(spare);
    return ST_OK;
}

const struct ledger_entry *ledger_find(const struct ledger *l, const char *path)
{
    const struct ledger_entry key = {.path = (char *)path};
    return l->count ? bsearch(&key, l->entries, (size_t)l->count, sizeof key, by_path) : NULL;
}

bool ledger_is_given(const struct ledger_entry *e)
{
    return !strcmp(e->maker, LEDGER_SCENE) || !strcmp(e->maker, LEDGER_PHOTO);
}

static enum status read_hash(struct textfile *t, char **hash, struct err *err)
{
    if (textfile_word(t, "a hash", hash, err)) return err->status;
    if (strlen(*hash) == HASH_TEXT - 1 && strspn(*hash, "0123456789abcdef") == HASH_TEXT - 1) return ST_OK;
    return textfile_error(t, err, *hash, "a hash of 32 hexadecimal digits");
}

static enum status read_entry(struct ledger *l, struct textfile *t, struct err *err)
{
    char *hash, *path, maker[sizeof l->entries->maker];
    if (read_hash(t, &hash, err) || textfile_word_into(t, "a stage", maker, sizeof maker, err) ||
        textfile_word(t, "a file", &path, err) || textfile_end(t, err))
        return err->status;
    return ledger_append(l, hash, maker, path, err);
}

/* The last line's hash must be that of all bytes before it. */
static enum status read_end(const char *bytes, size_t size, struct textfile *t, struct err *err)
{
    char *found, hash[HASH_TEXT];
    if (textfile_expect(t, "end", err) || read_hash(t, &found, err) || textfile_end_of_file(t, err)) return err->status;
    hash_bytes(hash, bytes, size);
    if (!strcmp(hash, found)) return ST_OK;
    return err_set(
        err, ST_DATA,
        "%s was changed since a run wrote it. Delete it; the next run writes it anew, but knows only what it "
        "makes itself, so that products are checked again when all of them have been made again.",
        t->path);
}

enum status ledger_read(struct ledger *l, const char *path, struct err *err)
{
    struct file_bytes file = {0};
    struct textfile t = {0};
    if (!path_is_file(path)) return ST_OK;
    if (file_bytes_read(&file, path, err)) return err->status;
    const char *last = file.size > 1 ? memrchr(file.bytes, '\n', file.size - 1) : NULL;
    const size_t before = last ? (size_t)(last - file.bytes) + 1 : 0;
    char *copy = malloc(before + 1); /* the reader ends words in place */
    if (!copy) {
        file_bytes_release(&file);
        return err_nomem(err, "a ledger", before);
    }
    memcpy(copy, file.bytes, before);
    if (!textfile_take(&t, &file, path, err) && !textfile_expect_line(&t, "remodel-ledger", err) &&
        !textfile_expect(&t, "1", err))
        textfile_end(&t, err);
    while (!err->status && t.at < before && textfile_next(&t)) read_entry(l, &t, err);
    if (!err->status && !textfile_next(&t)) textfile_error(&t, err, NULL, "the line \"end HASH\"");
    if (!err->status) read_end(copy, before, &t, err);
    textfile_release(&t);
    free(copy);
    return err->status;
}

enum status ledger_add_lines(struct ledger *l, const char *path, struct err *err)
{
    struct file_bytes file = {0};
    struct textfile t = {0};
    if (file_bytes_read(&file, path, err)) return err->status;
    while (file.size && file.bytes[file.size - 1] != '\n') file.bytes[--file.size] = '\0';
    if (!textfile_take(&t, &file, path, err))
        while (!err->status && textfile_next(&t)) read_entry(l, &t, err);
    textfile_release(&t);
    return err->status;
}

static enum status print_entries(const struct ledger *l, FILE *to, struct err *err)
{
    char quoted[2 * FILE_PATH];
    fputs("remodel-ledger 1\n", to);
    for (int i = 0; !err->status && i < l->count; i++)
        if (!textfile_quote(l->entries[i].path, quoted, sizeof quoted, err))
            fprintf(to, "%s %s %s\n", l->entries[i].hash, l->entries[i].maker, quoted);
    return err->status;
}

enum status ledger_write(const struct ledger *l, const char *path, struct err *err)
{
    char hash[HASH_TEXT];
    struct memory_text m = {0};
    struct outfile f = {0};
    if (memory_text_open(&m, "a ledger", err)) return err->status;
    print_entries(l, m.to, err);
    if (!err->status && !memory_text_close(&m, "a ledger", err) && !outfile_open(&f, path, err)) {
        hash_bytes(hash, m.text, m.size);
        fwrite(m.text, 1, m.size, f.fp);
        fprintf(f.fp, "end %s\n", hash);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    memory_text_release(&m);
    return err->status;
}

void ledger_release(struct ledger *l)
{
    for (int i = 0; i < l->count; i++) free(l->entries[i].path);
    free(l->entries);
    *l = (struct ledger){0};
}
