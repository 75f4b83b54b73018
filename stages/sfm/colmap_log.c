/* colmap_log.c - reading COLMAP's logs. */
#include "stages/sfm/colmap_log.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/textfile.h"

/* The line is "Loading images... 11 in 0.000s (connected 9)". */
int colmap_log_connected(const char *log)
{
    struct textfile t = {0};
    struct err ignored = ERR_INIT;
    int found = -1;
    if (textfile_open(&t, log, &ignored)) return -1;
    while (textfile_next_raw(&t)) {
        const char *at = strstr(t.cursor, "Loading images"), *connected = at ? strstr(at, "(connected ") : NULL;
        if (connected) found = (int)strtol(connected + strlen("(connected "), NULL, 10);
    }
    textfile_release(&t);
    return found;
}

/* The words of a line. Newer versions, and failed checks, begin a line with severity, date, time, thread and place:
 * "I20251114 16:04:38.468699 1930356 mapper.cc:976] words". */
static const char *words_of(const char *line)
{
    const char *digits = line + 1, *end;
    if (!*line || !strchr("IWEF", *line)) return line;
    const size_t count = strspn(digits, "0123456789");
    if ((count != 4 && count != 8) || digits[count] != ' ') return line;
    end = strstr(digits, "] ");
    return end ? end + 2 : line;
}

void colmap_log_last_line(char *text, size_t size, const char *log)
{
    struct textfile t = {0};
    struct err ignored = ERR_INIT;
    *text = '\0';
    if (textfile_open(&t, log, &ignored)) return;
    while (textfile_next_raw(&t)) {
        const char *p = words_of(t.cursor);
        p += strspn(p, " \t");
        if (isalpha((unsigned char)*p)) snprintf(text, size, "%s", p);
    }
    textfile_release(&t);
}
