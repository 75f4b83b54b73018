/* provenance.c - records and prints what a product was made from. */
#include "common/base/provenance.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/memory_text.h"
#include "common/base/textfile.h"

enum { QUOTED_SIZE = 2048 };

bool provenance_has(const struct provenance *prov, const char *name)
{
    for (int i = 0; i < prov->count; i++)
        if (!strcmp(prov->inputs[i].name, name)) return true;
    return false;
}

enum status provenance_add_hash(struct provenance *prov, const char *name, const char *hash, struct err *err)
{
    struct provenance_input input = {0};
    char quoted[QUOTED_SIZE];

    if (provenance_has(prov, name)) return ST_OK;
    /* refuse names that cannot be printed now, not when the product is written */
    if (textfile_quote(name, quoted, sizeof quoted, err) ||
        array_append(&prov->inputs, (size_t)prov->count, sizeof input, "inputs", err))
        return err->status;
    memcpy(input.hash, hash, HASH_TEXT);
    if (!(input.name = strdup(name))) return err_nomem(err, "the name of an input", strlen(name) + 1);
    prov->inputs[prov->count++] = input;
    return ST_OK;
}

enum status provenance_add_file(struct provenance *prov, const char *name, const char *path, struct err *err)
{
    char hash[HASH_TEXT];

    if (provenance_has(prov, name)) return ST_OK;
    return hash_file(hash, path, err) || provenance_add_hash(prov, name, hash, err) ? err->status : ST_OK;
}

enum status provenance_add_all(struct provenance *prov, const struct provenance *inputs, struct err *err)
{
    for (int i = 0; !err->status && i < inputs->count; i++)
        provenance_add_hash(prov, inputs->inputs[i].name, inputs->inputs[i].hash, err);
    return err->status;
}

enum status provenance_read(struct provenance *prov, const char *name, struct file_bytes *file, const char *path,
                            struct err *err)
{
    char hash[HASH_TEXT];

    if (file_bytes_read(file, path, err) || !prov || provenance_has(prov, name)) return err->status;
    hash_bytes(hash, file->bytes, file->size);
    if (provenance_add_hash(prov, name, hash, err)) file_bytes_release(file);
    return err->status;
}

enum status provenance_open(struct provenance *prov, const char *name, struct textfile *t, const char *path,
                            struct err *err)
{
    struct file_bytes file = {0};

    *t = (struct textfile){0};
    return provenance_read(prov, name, &file, path, err) || textfile_take(t, &file, path, err) ? err->status : ST_OK;
}

static void print_inputs(const struct provenance *prov, const char *prefix, FILE *to)
{
    char quoted[QUOTED_SIZE];

    for (int i = 0; i < prov->count; i++)
        if (!textfile_quote(prov->inputs[i].name, quoted, sizeof quoted, NULL))
            fprintf(to, "%s%s %s\n", prefix, quoted, prov->inputs[i].hash);
}

enum status provenance_add_in(struct provenance *prov, const char *as, const char *folder, const char *file,
                              const char *suffix, char path[FILE_PATH], struct err *err)
{
    char name[FILE_PATH], own[FILE_PATH];
    if (!path) path = own;
    if (file_path(path, folder, file, suffix, err) || file_path(name, as, file, suffix, err)) return err->status;
    return provenance_add_file(prov, name, path, err);
}

void provenance_print(const struct provenance *prov, FILE *to)
{
    fprintf(to, "# remodel %s %s\n", prov->stage, prov->version);
    for (const char *p = prov->params; p && *p;) {
        const size_t n = strcspn(p, "\n");
        if (*p != '[') fprintf(to, "# %.*s\n", (int)n, p);
        p += n + (p[n] == '\n');
    }
    print_inputs(prov, "# input ", to);
}

char *provenance_inputs_text(const struct provenance *prov)
{
    struct memory_text m = {0};
    struct err err = ERR_INIT;

    if (memory_text_open(&m, "a list of inputs", &err)) return NULL;
    print_inputs(prov, "", m.to);
    return memory_text_close(&m, "a list of inputs", &err) ? NULL : m.text;
}

void provenance_keep(struct provenance *prov, int count)
{
    while (prov->count > count) free(prov->inputs[--prov->count].name);
}

void provenance_release(struct provenance *prov)
{
    if (!prov) return;
    provenance_keep(prov, 0);
    free(prov->inputs);
    free(prov->params);
    *prov = (struct provenance){0};
}
