/* frame_name.c - see frame_name.h. */
#include "common/capture/frame_name.h"

#include <stdio.h>
#include <string.h>

enum { DIGITS = 6 };

char *frame_name_make(const char *clip, int number)
{
    char *name = NULL;
    return asprintf(&name, "%s_f%0*d.png", clip, DIGITS, number) < 0 ? NULL : name;
}

size_t frame_name_clip(const char *name)
{
    const char *at = strrchr(name, '_');
    if (!at || at == name || at[1] != 'f') return 0;
    const size_t digits = strspn(at + 2, "0123456789");
    const char *end = at + 2 + digits;
    return digits >= DIGITS && (!*end || !strcmp(end, ".png")) ? (size_t)(at - name) : 0;
}
