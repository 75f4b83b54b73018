/* check_scene.c - compares the files of a scene with its ledger.
 *
 * An input of a product is named by its path in the scene ("views/IMG_1.exr"): the files whose paths end so are those
 * it may be, and one of them must have its hash. Of a photo the name alone counts. An input that the ledger does not
 * know, such as a weather file somewhere, cannot be looked up; these are counted.
 *
 * Hashes find what happens by chance or by mistake. They are not made to withstand somebody who wants to deceive. */
#include "stages/verify/check_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/base/sort.h"
#include "stages/verify/ledger_file.h"
#include "stages/verify/product_inputs.h"

enum state { SAME, CHANGED, GONE, UNREADABLE };

struct checked {
    const struct ledger_entry *entry;
    enum state state;
    char hash[HASH_TEXT]; /* of its bytes now */
    const char *tail;     /* the file's name, the end of the path */
    struct product_inputs inputs;
    struct err err;
};

struct check {
    struct checked *files; /* by name */
    int count;
    struct progress progress;
};

static void look_at(void *ctx, size_t begin, size_t end, int thread)
{
    struct check *c = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct checked *f = &c->files[i];
        struct file_bytes file = {0};
        f->state = GONE;
        if (path_is_file(f->entry->path)) {
            f->state = UNREADABLE;
            if (!file_bytes_read(&file, f->entry->path, &f->err)) {
                hash_bytes(f->hash, file.bytes, file.size);
                f->state = strcmp(f->hash, f->entry->hash) ? CHANGED : SAME;
                if (!ledger_is_given(f->entry)) product_inputs_read(&f->inputs, file.bytes, file.size, &f->err);
            }
        }
        file_bytes_release(&file);
        progress_add(&c->progress, 1);
    }
}

static int by_name(const void *a, const void *b)
{
    const struct checked *f = a, *g = b;
    const int order = strcmp(f->tail, g->tail);
    return order ? order : strcmp(f->entry->path, g->entry->path);
}

static bool is_below(const void *item, const void *name)
{
    return strcmp(((const struct checked *)item)->tail, name) < 0;
}

static bool ends_with(const char *path, const char *name)
{
    const size_t n = strlen(path), m = strlen(name);
    return n >= m && !strcmp(path + n - m, name) && (n == m || path[n - m - 1] == '/');
}

enum link { HOLDS, BROKEN, UNKNOWN };

/* Whether a file has, or by the ledger had, what an input names. A file that was changed since is named on its own. */
static enum link follow(const struct check *c, const struct product_input *input)
{
    const char *name = path_file_name(input->name);
    char hash[HASH_TEXT];
    bool known = false;
    size_t i = sort_place(c->files, (size_t)c->count, sizeof *c->files, is_below, name);
    for (; i < (size_t)c->count && !strcmp(c->files[i].tail, name); i++) {
        const struct ledger_entry *e = c->files[i].entry;
        if (strcmp(e->maker, LEDGER_PHOTO) != 0 && !ends_with(e->path, input->name)) continue;
        if (!strcmp(e->hash, input->hash) || !strcmp(c->files[i].hash, input->hash)) return HOLDS;
        known = true;
    }
    /* a program is recorded by its name and version */
    hash_bytes(hash, input->name, strlen(input->name));
    return !strcmp(hash, input->hash) ? HOLDS : known ? BROKEN : UNKNOWN;
}

static bool report_state(const struct checked *f)
{
    const char *path = f->entry->path, *maker = f->entry->maker;
    if (f->err.status)
        printf("%s\n", f->err.text);
    else if (f->state == SAME)
        return false;
    else if (!strcmp(maker, LEDGER_PHOTO))
        printf("%s: %s since import_photos read it. Put the photo back, or run make, which reads it anew.\n", path,
               f->state == GONE ? "gone" : "changed");
    else if (!strcmp(maker, LEDGER_SCENE))
        printf("%s: %s since the last run. Run make, so that the products follow.\n", path,
               f->state == GONE ? "gone" : "changed");
    else if (f->state == GONE)
        printf("%s: gone since %s made it. Run make, which makes it again if it is wanted.\n", path, maker);
    else
        printf("%s: changed since %s made it. Delete it and run make.\n", path, maker);
    return true;
}

struct numbers {
    int products, given, inputs, unknown, faults;
};

static void report(const struct check *c, struct numbers *n)
{
    for (int i = 0; i < c->count; i++) {
        const struct checked *f = &c->files[i];
        *(ledger_is_given(f->entry) ? &n->given : &n->products) += 1;
        n->faults += report_state(f);
        for (int k = 0; k < f->inputs.count; k++) {
            const enum link link = follow(c, &f->inputs.items[k]);
            n->inputs += link != UNKNOWN;
            n->unknown += link == UNKNOWN;
            if (link != BROKEN) continue;
            printf("%s: %s made it of %s as it no longer is. Run make, which makes it again.\n", f->entry->path,
                   f->entry->maker, f->inputs.items[k].name);
            n->faults++;
        }
    }
}

static bool is_in(const char *path, const char *folder)
{
    const size_t n = strlen(folder);
    return !strncmp(path, folder, n) && path[n] == '/';
}

enum status scene_check(const char *shared, const char *own, struct err *err)
{
    struct ledger ledger = {0};
    struct check c = {0};
    struct numbers n = {0};
    char path[FILE_PATH];

    if (file_path(path, shared, "log/ledger.txt", "", err)) return err->status;
    if (!path_is_file(path))
        return err_set(err, ST_IO,
                       "%s does not exist: no run of this version has made anything of the scene. Run make first.",
                       path);
    if (!ledger_read(&ledger, path, err) && !(c.files = calloc((size_t)ledger.count + 1, sizeof *c.files)))
        err_nomem(err, "the files of a scene", (size_t)ledger.count * sizeof *c.files);
    for (int i = 0; !err->status && i < ledger.count; i++) {
        const struct ledger_entry *e = &ledger.entries[i];
        if (ledger_is_given(e) || is_in(e->path, shared) || is_in(e->path, own))
            c.files[c.count++] = (struct checked){.entry = e, .tail = path_file_name(e->path)};
    }
    if (!err->status) {
        qsort(c.files, (size_t)c.count, sizeof *c.files, by_name);
        progress_start(&c.progress, "checking files", c.count, "files");
        parallel_for((size_t)c.count, 1, look_at, &c);
        progress_end(&c.progress);
        report(&c, &n);
        printf("%s: %d products, %d files that people gave, %d links between them: ", own, n.products, n.given,
               n.inputs);
        if (n.faults)
            printf("%d faults", n.faults);
        else
            printf("all as they were made");
        if (n.unknown) printf("; %d inputs lie outside the scene", n.unknown);
        printf("\n");
        if (n.faults) err_set(err, ST_DATA, "%s: %d faults; they are listed above.", own, n.faults);
    }
    for (int i = 0; i < c.count; i++) product_inputs_release(&c.files[i].inputs);
    free(c.files);
    ledger_release(&ledger);
    return err->status;
}
