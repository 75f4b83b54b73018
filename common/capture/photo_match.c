/* photo_match.c - finds the photograph that an image of a model is. */
#include "common/capture/photo_match.h"

#include <string.h>

int photo_list_match(const struct photo_list *photos, const char *name)
{
    int at = photo_list_find_file(photos, name);
    const char *base = name;
    for (const char *p = name; *p; p++)
        if (*p == '/' || *p == '\\') base = p + 1;
    if (at < 0) at = photo_list_find_file(photos, base);
    const char *dot = strrchr(base, '.');
    size_t stem = dot ? (size_t)(dot - base) : strlen(base);
    for (int i = 0; at < 0 && i < photos->count; i++)
        if (!strncmp(photos->photos[i].id, base, stem) && !photos->photos[i].id[stem]) at = i;
    for (int i = 0; at < 0 && i < photos->count; i++) {
        const struct photo_record *p = &photos->photos[i];
        if (p->bracket_count && !strcmp(p->brackets[p->middle].file, base)) at = i;
    }
    return at;
}
