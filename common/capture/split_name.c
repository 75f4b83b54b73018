/* split_name.c - see split_name.h. */
#include "common/capture/split_name.h"

#include <stdio.h>
#include <string.h>

enum status split_size_parse(struct split_size *size, const char *text, struct err *err)
{
    const bool digits = strspn(text, "0123456789x") == strlen(text) && text[0] != '0' && !strstr(text, "x0");
    int end = 0;
    *size = (struct split_size){0, 0};
    if (!digits || strlen(text) > 5 || sscanf(text, "%dx%d%n", &size->columns, &size->rows, &end) != 2 || text[end] ||
        size->columns > MAX_SPLIT || size->rows > MAX_SPLIT)
        return err_set(
            err, ST_USAGE,
            "--split %.40s: wanted COLUMNSxROWS, like 3x2: the number of pictures in a photo, 1 to %d per side.", text,
            MAX_SPLIT);
    if (size->columns * size->rows == 1)
        return err_set(err, ST_USAGE, "--split 1x1 cuts nothing; omit it, or give the number of pictures in a photo.");
    return ST_OK;
}

char *split_name_make(const char *photo_id, int column, int row)
{
    char *name = NULL;
    return asprintf(&name, "%s_c%dr%d.png", photo_id, column, row) < 0 ? NULL : name;
}

/* Reads a number without leading zeros that is at most `max`, and moves *at behind it. */
static bool read_number(const char **at, int max, int *value)
{
    const size_t digits = strspn(*at, "0123456789");
    if (!digits || digits > 2 || **at == '0' || sscanf(*at, "%2d", value) != 1) return false;
    *at += digits;
    return *value <= max;
}

bool split_name_read(struct split_name *name, const char *text, struct split_size size)
{
    const char *at = strrchr(text, '_');
    if (!at) return false;
    name->photo_length = (size_t)(at - text);
    return *++at == 'c' && (at++, read_number(&at, size.columns, &name->column)) && *at == 'r' &&
           (at++, read_number(&at, size.rows, &name->row)) && (!*at || (*at == '.' && !strchr(at, '/')));
}
