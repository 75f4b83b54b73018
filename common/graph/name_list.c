/* name_list.c - see name_list.h. */
#include "common/graph/name_list.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"

#define BLANKS " \t\r\n"

enum status name_list_add(struct name_list *list, const char *name, size_t length, struct err *err)
{
    if (array_reserve(&list->names, &list->capacity, (size_t)list->count + 1, sizeof *list->names, "names", err))
        return err->status;
    char *copy = strndup(name, length);
    if (!copy) return err_nomem(err, "a name", length);
    list->names[list->count++] = copy;
    return ST_OK;
}

enum status name_list_add_words(struct name_list *list, const char *words, struct err *err)
{
    while (words && !err->status && *(words += strspn(words, BLANKS))) {
        const size_t n = strcspn(words, BLANKS);
        name_list_add(list, words, n, err);
        words += n;
    }
    return err->status;
}

enum status name_list_read(struct name_list *list, const char *path, const char *variable, struct err *err)
{
    FILE *f = fopen(path, "r");
    if (!f) return errno == ENOENT ? ST_OK : err_errno(err, "open", path);
    const size_t n = strlen(variable);
    char *line = NULL;
    size_t size = 0;
    while (!err->status && getline(&line, &size, f) > 0)
        if (!strncmp(line, variable, n) && !strncmp(line + n, " :=", 3)) name_list_add_words(list, line + n + 3, err);
    if (!err->status && ferror(f)) err_errno(err, "read", path);
    free(line);
    fclose(f);
    return err->status;
}

enum status name_list_add_files(struct name_list *list, const char *folder, const char *before, const char *after,
                                struct err *err)
{
    DIR *dir = opendir(folder);
    if (!dir) return errno == ENOENT || errno == ENOTDIR ? ST_OK : err_errno(err, "open", folder);
    const size_t head = strlen(before), tail = strlen(after);
    struct name_list found = {0};
    errno = 0;
    for (const struct dirent *entry; !err->status && (entry = readdir(dir)); errno = 0) {
        const char *name = entry->d_name;
        const size_t n = strlen(name);
        if (n > head + tail && !strncmp(name, before, head) && scan_is_file_name(name, after))
            name_list_add(&found, name + head, n - head - tail, err);
    }
    if (!err->status && errno) err_errno(err, "list", folder);
    closedir(dir);
    name_list_sort(&found);
    for (int i = 0; !err->status && i < found.count; i++)
        name_list_add(list, found.names[i], strlen(found.names[i]), err);
    name_list_release(&found);
    return err->status;
}

bool name_list_has(const struct name_list *list, const char *name)
{
    for (int i = 0; i < list->count; i++)
        if (!strcmp(list->names[i], name)) return true;
    return false;
}

static int by_bytes(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

void name_list_sort(struct name_list *list)
{
    int kept = 0;
    if (list->count) qsort(list->names, (size_t)list->count, sizeof *list->names, by_bytes);
    for (int i = 0; i < list->count; i++) {
        if (kept && !strcmp(list->names[kept - 1], list->names[i]))
            free(list->names[i]);
        else
            list->names[kept++] = list->names[i];
    }
    list->count = kept;
}

void name_list_release(struct name_list *list)
{
    for (int i = 0; i < list->count; i++) free(list->names[i]);
    free(list->names);
    *list = (struct name_list){0};
}
