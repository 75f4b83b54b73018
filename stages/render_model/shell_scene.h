/* shell_scene.h - the scene of shell.h: a model, its texture map, and the atlases in memory. */
#ifndef REMODEL_RENDER_SHELL_SCENE_H
#define REMODEL_RENDER_SHELL_SCENE_H

#include "stages/render_model/shade.h"
#include "stages/render_model/shell.h"

/* A rule of the texture map, or that a face shows itself. */
struct shell_rule {
    struct texture_rule rule; /* its lists belong to the map */
    bool tried;               /* TEXTURE_COLOUR: whether `colour` was looked for, */
    bool known;               /* and found */
    float colour[3];          /* radiance */
};

struct shell_face {
    int first, count; /* its rules */
};

struct shell_scene {
    struct solid_mesh mesh;
    struct texture_map map;
    struct provenance inputs; /* the model and the map, if they were read from files */
    struct shell_face *faces; /* of the mesh */
    struct shell_rule *rules;
    uint32_t *ids; /* [1 + faces], [0] is 0 */
    int rule_count;
    struct visible_model model;
    struct visible seen;
    struct page_cache *pages;
    struct provenance *prov;
    int samples;
    /* of a picture */
    struct shade_step *steps; /* [1 + faces] */
    struct shade_tile *tiles;
    size_t tile_room, done_room;
    int tile_count;
    _Atomic unsigned char *open; /* [1 + faces] */
    unsigned char *done;
    struct model_picture sample; /* one of several in a pixel */
};

/* Makes a scene of a mesh and a map, which it takes over, also on failure; both are empty afterwards. memory: MiB. */
enum status shell_make(struct shell_scene **scene, struct solid_mesh *mesh, struct texture_map *map, const char *vdta,
                       const char *vita, int memory, struct err *err);

/* The atlases of a picture. */
struct shell_atlases {
    struct texture_set *pair[2], *vita; /* NULL: none */
};
/* Sets the steps of all open faces in pass `pass`, from 0, and reads the pages that they need. *any: some face has
 * one. */
enum status shell_steps_make(struct shell_scene *s, int pass, const struct view *camera,
                             const struct shell_atlases *atlases, bool outdoors, bool *any, struct err *err);

#endif
