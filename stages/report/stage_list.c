/* stage_list.c - see stage_list.h. */
#include "stages/report/stage_list.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

static enum status add_name(struct stage_list *list, const char *name, size_t size, struct err *err)
{
    static const char ALLOWED[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    if (size >= STAGE_NAME || strspn(name, ALLOWED) < size)
        return err_set(err, ST_USAGE, "--stages: found \"%.*s\", wanted a name of at most %d letters, digits, _ and -.",
                       (int)size, name, STAGE_NAME - 1);
    if (array_append(&list->names, (size_t)list->count, sizeof *list->names, "names of stages", err))
        return err->status;
    char *copy = list->names[list->count];
    memcpy(copy, name, size);
    copy[size] = '\0';
    if (stage_list_has(list, copy)) return err_set(err, ST_USAGE, "--stages: found %s twice, wanted it once.", copy);
    list->count++;
    return ST_OK;
}

enum status stage_list_parse(struct stage_list *list, const char *text, struct err *err)
{
    for (const char *at = text + strspn(text, " "); *at && !err->status; at += strspn(at, " ")) {
        const size_t size = strcspn(at, " ");
        add_name(list, at, size, err);
        at += size;
    }
    if (!err->status && !list->count)
        err_set(err, ST_USAGE, "--stages: found no name, wanted the names of all stages.");
    if (err->status) stage_list_release(list);
    return err->status;
}

bool stage_list_has(const struct stage_list *list, const char *name)
{
    for (int i = 0; i < list->count; i++)
        if (!strcmp(list->names[i], name)) return true;
    return false;
}

void stage_list_release(struct stage_list *list)
{
    free(list->names);
    *list = (struct stage_list){0};
}
