/* texel_facts.h - what the truth says about each texel of an atlas tile. */
#ifndef REMODEL_TEXEL_FACTS_H
#define REMODEL_TEXEL_FACTS_H

#include "common/texture/atlas.h"
#include "stages/evaluate/scene/model_frame.h"
#include "stages/evaluate/texture/shell_points.h"
#include "stages/evaluate/texture/texture_error.h"

struct photo_view { /* a view of the products whose photo is a shell view */
    const struct view *view;
    int shell;      /* index of that shell view */
    uint8_t *known; /* owned; a pixel each: 0 outside the photograph, or clipped; NULL: no pixel is */
};

struct texel_truth {                 /* everything is borrowed */
    const struct model_frame *frame; /* to the truth's world */
    const struct shell_points *shell;
    const struct photo_view *views;
    int view_count;
    double scale, white; /* true radiance of a texel's 1; of white */
    /* of the atlas: */
    const struct atlas *atlas;
    const int *source_shell;       /* the shell view of each source's photo; -1: none */
    const bool *source_own;        /* whether it is a view of the viewpoint's own */
    int own;                       /* the shell view of the viewpoint; -1: none */
    const struct image *own_photo; /* its true radiance with furniture, of own's size; data NULL: none */
};

/* facts: width * height of the tile. page: the tile's. The face lies in the plane normal . p = offset of the model's
 * frame. */
void texel_facts_of_tile(struct texel_facts *facts, const struct texel_truth *truth, const struct atlas_page *page,
                         const struct atlas_tile *tile, struct vec3 normal, double offset);

#endif
