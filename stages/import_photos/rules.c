/* rules.c - the records of photos are made in every run, before the graph is read (look.sh): only SPLIT is checked. */
#include <string.h>

#include "common/graph/scene_rules.h"

/* Two numbers of one or two digits, as in 3x2. */
static bool is_grid(const char *split)
{
    const size_t columns = strspn(split, "0123456789"),
                 rows = strspn(split + columns + (split[columns] == 'x'), "0123456789");
    return columns && columns < 3 && *split != '0' && split[columns] == 'x' && rows && rows < 3 &&
           split[columns + 1] != '0' && !split[columns + 1 + rows];
}

RULES(import_photos)
{
    (void)f;
    const char *split = scene_setting("SPLIT");
    if (!*split) return;
    if (!is_grid(split))
        graph_refuse(g, "SPLIT=%s: wanted COLUMNSxROWS, such as 3x2: how many pictures a photo holds.", split);
    else if (!strcmp(split, "1x1"))
        graph_refuse(g, "SPLIT=1x1 leaves each photo as it is; leave SPLIT out.");
}
