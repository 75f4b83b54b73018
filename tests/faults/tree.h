/* tree.h - the files of a folder as they were, so that a later look finds what was made, changed or lost. */
#ifndef REMODEL_FAULT_TREE_H
#define REMODEL_FAULT_TREE_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

struct tree_file {
    char *path; /* below the folder */
    ino_t inode;
    off_t size;
    long long changed;  /* nanoseconds */
    char *bytes;        /* NULL unless they were read */
    unsigned long hash; /* of them; 0 unless it was computed */
};

struct tree {
    struct tree_file *files; /* by path */
    size_t count, room;
};

bool tree_read(struct tree *tree, const char *folder);
void tree_release(struct tree *tree);
struct tree_file *tree_find(const struct tree *tree, const char *path);
bool tree_same(const struct tree_file *a, const struct tree_file *b); /* not touched in between */

/* Computes the hashes of all files. */
void tree_hash(struct tree *tree, const char *folder);
unsigned long tree_hash_of(const char *folder, const char *path); /* 0: it cannot be read */

/* The whole file; the caller frees it. NULL: it cannot be read. */
char *tree_bytes(const char *folder, const char *path, size_t *size);
bool tree_write(const char *folder, const char *path, const void *bytes, size_t size);
void tree_remove(const char *folder, const char *path); /* and folders that are empty then */

#endif
