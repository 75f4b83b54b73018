/* edited_atlas.h - the VITA of an edited model: tiles of the unedited one where faces keep their texels in place, new
 * ones where the texture map moves, copies or colours them. */
#ifndef REMODEL_EDITED_ATLAS_H
#define REMODEL_EDITED_ATLAS_H

#include "common/relight/light_change.h"
#include "stages/update_vita/face_nets.h"

/* {0} is the empty state; everything is owned. */
struct edited_atlas {
    struct atlas_page *pages;   /* of the new tiles */
    int first_page, page_count; /* they follow those of the unedited VITA */
    bool *coloured;             /* of each texel of the new pages, page after page: an albedo */
    size_t *first;              /* of each new page, its first texel in `coloured` */
};

/* Lays out the new tiles, fills them by the texture map, and puts them into c->after.atlas: colours as albedos, all
 * else as radiance before the edit. folder: of the unedited VITA. The caller releases a in each case. */
enum status edited_atlas_make(struct edited_atlas *a, struct light_change *c, const char *folder, struct err *err);
void edited_atlas_release(struct edited_atlas *a);

/* Writes the atlas to OUT: texels times the values of the samples around them (light_rounds.h). */
enum status edited_atlas_write(const struct edited_atlas *a, const struct light_change *c, const struct face_nets *nets,
                               const struct rgb *values, const char *folder, const char *out,
                               const struct provenance *prov, struct err *err);

#endif
