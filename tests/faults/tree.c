/* tree.c - see tree.h. */
#include "tests/faults/tree.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct tree *filling;
static size_t skipped;

static int add(const char *path, const struct stat *info, int kind, struct FTW *at)
{
    struct tree *t = filling;

    (void)at;
    if (kind != FTW_F) return 0; /* folders and symbolic links do not matter */
    if (t->count == t->room) {
        t->room = t->room ? 2 * t->room : 1024;
        t->files = realloc(t->files, t->room * sizeof *t->files);
        if (!t->files) abort();
    }
    t->files[t->count++] = (struct tree_file){
        .path = strdup(path + skipped),
        .inode = info->st_ino,
        .size = info->st_size,
        .changed = info->st_mtim.tv_sec * 1000000000LL + info->st_mtim.tv_nsec,
    };
    return 0;
}

static int by_path(const void *a, const void *b)
{
    return strcmp(((const struct tree_file *)a)->path, ((const struct tree_file *)b)->path);
}

bool tree_read(struct tree *tree, const char *folder)
{
    *tree = (struct tree){0};
    filling = tree;
    skipped = strlen(folder) + 1;
    if (nftw(folder, add, 32, FTW_PHYS)) return false;
    if (tree->count) qsort(tree->files, tree->count, sizeof *tree->files, by_path);
    return true;
}

void tree_release(struct tree *tree)
{
    for (size_t i = 0; i < tree->count; i++) {
        free(tree->files[i].path);
        free(tree->files[i].bytes);
    }
    free(tree->files);
    *tree = (struct tree){0};
}

struct tree_file *tree_find(const struct tree *tree, const char *path)
{
    const struct tree_file key = {.path = (char *)path};

    return tree->count ? bsearch(&key, tree->files, tree->count, sizeof key, by_path) : NULL;
}

bool tree_same(const struct tree_file *a, const struct tree_file *b)
{
    return a->inode == b->inode && a->size == b->size && a->changed == b->changed;
}

unsigned long tree_hash_of(const char *folder, const char *path)
{
    size_t size = 0;
    char *bytes = tree_bytes(folder, path, &size);
    unsigned long hash = 14695981039346656037UL;

    for (size_t i = 0; bytes && i < size; i++) hash = (hash ^ (unsigned char)bytes[i]) * 1099511628211UL;
    if (!bytes) hash = 0;
    free(bytes);
    return hash;
}

void tree_hash(struct tree *tree, const char *folder)
{
    for (size_t i = 0; i < tree->count; i++) tree->files[i].hash = tree_hash_of(folder, tree->files[i].path);
}

char *tree_bytes(const char *folder, const char *path, size_t *size)
{
    char name[8192];
    struct stat info;
    char *bytes = NULL;

    snprintf(name, sizeof name, "%s/%s", folder, path);
    FILE *f = fopen(name, "rb");
    if (!f) return NULL;
    if (!fstat(fileno(f), &info) && (bytes = malloc((size_t)info.st_size + 1)))
        *size = fread(bytes, 1, (size_t)info.st_size, f);
    fclose(f);
    return bytes;
}

bool tree_write(const char *folder, const char *path, const void *bytes, size_t size)
{
    char name[8192];

    snprintf(name, sizeof name, "%s/%s", folder, path);
    FILE *f = fopen(name, "wb");
    if (!f) return false;
    const bool good = fwrite(bytes, 1, size, f) == size;
    return !fclose(f) && good;
}

void tree_remove(const char *folder, const char *path)
{
    char name[8192];

    snprintf(name, sizeof name, "%s/%s", folder, path);
    unlink(name);
    for (char *slash; (slash = strrchr(name, '/')) && slash > name + strlen(folder);) {
        *slash = '\0';
        if (rmdir(name)) return;
    }
}
