/* drawn_room.h - what pictures of a model are drawn from: the model, its textures, the views and their clutter. */
#ifndef REMODEL_DRAWN_ROOM_H
#define REMODEL_DRAWN_ROOM_H

#include "common/light/model_rays.h"
#include "common/model/scene_inputs.h"
#include "common/relight/placed_things.h"
#include "stages/render_model/clutter.h"
#include "stages/render_model/render_params.h"
#include "stages/render_model/shell.h"

/* A photograph; its views have one centre. */
struct viewpoint {
    const char *photo;  /* owned by the lens list */
    struct vec3 centre; /* model frame */
    int first, count;   /* its views */
};

struct room_files {
    const char *model, *base, *map; /* model.txt; the unedited one and texture.txt of an edited model, or NULL */
    const char *axes, *views, *vdta, *vita;
    const char *ids, *depth; /* folders; NULL: without clutter */
    const char *things;      /* folder; NULL: none are known */
    const char *outdoors;    /* file; NULL: none */
    const char *exposure;    /* file; NULL: 1 */
};

struct room {
    struct room_files files;
    const struct render_model_params *params;
    struct scene_inputs in;       /* axes, lenses, views in the scene's frame */
    struct view *cameras;         /* the views in the model's frame; owned */
    struct viewpoint *viewpoints; /* in order of photo; owned */
    int viewpoint_count;
    struct model_rays model, base; /* with panes; base is empty without an edit */
    struct shell_scene *shell;
    struct clutter_scene *clutter; /* NULL: none is drawn */
    struct placed_things things;
    float *front;      /* of the picture that was drawn last: depth of what is seen, model units; owned */
    size_t front_size; /* pixels that it has room for */
    struct outdoors outdoors;
    double exposure; /* of all pictures: what the parameters say, else the file */
};

/* The caller closes the room in each case. */
enum status room_open(struct room *room, const struct room_files *files, const struct render_model_params *params,
                      struct provenance *prov, struct err *err);
void room_close(struct room *room);

/* Viewpoints whose textures a picture takes, and the share of the second; -1: none. */
struct texture_pair {
    int viewpoint[2];
    double t;
};

/* Draws the shell and the clutter over it. camera: model frame. own: the original view that it is; -1: none. gone: of
 * each pixel: no clutter is drawn there; may be NULL. Things that the edit puts elsewhere are drawn too, unless the
 * camera is a view's: there the photo's own pixels come first. */
enum status room_draw(struct model_picture *picture, struct room *room, const struct view *camera,
                      const struct texture_pair *pair, int own, const uint8_t *gone, struct provenance *prov,
                      struct err *err);

/* Draws the things that the edit puts elsewhere over a picture that room_draw() drew from the same camera. same: as
 * shown of clutter_draw_thing(). */
enum status room_draw_things(struct model_picture *picture, struct room *room, const struct view *camera, uint8_t *same,
                             struct provenance *prov, struct err *err);

/* Draws the things that stay where they are, but not at the pixels that have `stays` 1: those that an edit uncovers to
 * a view, which other views show. front: as room_draw() left it. */
enum status room_draw_uncovered(struct model_picture *picture, struct room *room, const struct view *camera,
                                const uint8_t *stays, struct provenance *prov, struct err *err);

int room_viewpoint_of(const struct room *room, int view); /* the viewpoint that a view belongs to */
/* The viewpoint of a photo's id; -1: there is none. */
int room_find_viewpoint(const struct room *room, const char *photo);

#endif
