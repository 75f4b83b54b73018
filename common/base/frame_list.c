/* frame_list.c - parses lists of frame numbers. */
#include "common/base/frame_list.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Reads a number from 1 to max at *text and moves *text past it; 0 if there is none. */
static int frame_number(const char **text, int max)
{
    long n = 0;
    char *end = NULL;
    if (isdigit((unsigned char)**text)) n = strtol(*text, &end, 10);
    if (n < 1 || n > max) return 0;
    *text = end;
    return (int)n;
}

enum status frame_list_read(bool *wanted, int frame_count, const char *list, struct err *err)
{
    const char *at = list;

    memset(wanted, 0, (size_t)frame_count * sizeof *wanted);
    for (;;) {
        const int first = frame_number(&at, frame_count);
        int last = first;
        if (first && *at == ':') {
            at++;
            last = frame_number(&at, frame_count);
        }
        if (!first || last < first || (*at && *at != ','))
            return err_set(err, ST_USAGE,
                           "--frames %s: wanted frame numbers and ranges from 1 to %d, like 1:30 or 1:30,45.", list,
                           frame_count);
        for (int i = first; i <= last; i++) wanted[i - 1] = true;
        if (!*at++) return ST_OK;
    }
}
