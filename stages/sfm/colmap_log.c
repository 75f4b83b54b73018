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

void colmap_log_last_line(char *text, size_t size, const char *log)
{
    struct textfile t = {0};
    struct err ignored = ERR_INIT;
    *text = '\0';
    if (textfile_open(&t, log, &ignored)) return;
    while (textfile_next_raw(&t)) {
        const char *p = t.cursor + strspn(t.cursor, " \t");
        if (isalpha((unsigned char)*p)) snprintf(text, size, "%s", p);
    }
    textfile_release(&t);
}
