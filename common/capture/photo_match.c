/* photo_match.c - finds the photograph that an image of a model is. */
#include "common/capture/photo_match.h"

#include <stdbool.h>
#include <string.h>

/* Length of a file's name without its extension. */
static size_t stem_of(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && dot > name ? (size_t)(dot - name) : strlen(name);
}

/* The only photo whose file is called so, up to extensions; -1: none, or several. */
static int similar_file(const struct photo_list *photos, const char *base)
{
    const size_t stem = stem_of(base);
    int at = -1;
    for (int i = 0; i < photos->count; i++) {
        const char *file = photos->photos[i].file;
        const size_t own = stem_of(file);
        const bool whole = own == strlen(base) && !strncmp(file, base, own); /* a name without extension */
        if (!whole && (own != stem || strncmp(file, base, own))) continue;
        if (at >= 0) return -1;
        at = i;
    }
    return at;
}

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
    return at < 0 && *base ? similar_file(photos, base) : at;
}
