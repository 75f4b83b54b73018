/* texture_pictures.h - the model as a view shows it with the texture of an atlas, and where its texels come from.
 *
 * A sight is filled page by page, so that one page of the atlas is in memory at a time. */
#ifndef REMODEL_TEXTURE_PICTURES_H
#define REMODEL_TEXTURE_PICTURES_H

#include "common/capture/camera_set.h"
#include "common/model/model_axes.h"
#include "common/texture/atlas.h"
#include "stages/report/page_pictures.h"

enum { SIGHT_SIDE = 3 }; /* samples of a pixel: SIGHT_SIDE x SIGHT_SIDE */

struct sight_sample {
    int tile;   /* of the atlas; -1: no tile shows the point; -2: the view shows no face */
    float x, y; /* on the tile's page */
    float rgb[3];
    uint32_t source; /* ATLAS_NONE: no texel, or its page has not been added */
};

struct sight {
    int width, height;            /* upright */
    struct sight_sample *samples; /* SIGHT_SIDE^2 a pixel; owned */
};

/* Finds the texels that a view shows. ids: the view's O/ids/VIEW.exr. height: of the upright picture at most, px.
 * ST_IO, ST_DATA: the ids cannot be read, or have another size than the view. */
enum status texture_sight_make(struct sight *s, const struct atlas *a, const struct view *view,
                               const struct model_axes *axes, const char *ids, int orientation, int height,
                               struct err *err);
void texture_sight_add_page(struct sight *s, const struct atlas *a, const struct atlas_page *page, int number);
void texture_sight_release(struct sight *s);

/* Scene-linear colours as sRGB, 1 is white; hatched where most samples of a pixel have no texel. */
enum status picture_from_sight(struct picture *p, const struct sight *s, struct err *err);

/* What a source (of ATLAS_VIEWS + source_count) is, for the picture of sources. */
struct source_colour {
    bool original;
    unsigned char rgb[3]; /* of a source that is not original */
};

/* Original texels grey, warped ones in the colour of their view, synthesised ones hatched, default ones magenta, none
 * black; all but the last three lighter where the texture is light. colours: one for each of the atlas's sources.
 * counts[source]: pixels whose middle sample has this source are added; ATLAS_NONE: the view shows a face there. */
enum status picture_from_sources(struct picture *p, const struct sight *s, const struct source_colour *colours,
                                 long long *counts, struct err *err);

/* A page; hatched where there is no texel. */
enum status picture_from_atlas_page(struct picture *p, const struct atlas_page *page, int height, struct err *err);

#endif
