/* walk_scene.h - what a walk shows: the rooms before and after each edit, and the cameras of the photographs. */
#ifndef REMODEL_WALK_SCENE_H
#define REMODEL_WALK_SCENE_H

#include "common/base/cli.h"
#include "common/capture/camera_path.h"
#include "common/light/model_rays.h"
#include "common/light/object_list.h"
#include "common/model/scene_inputs.h"
#include "common/relight/placed_things.h"
#include "common/texture/atlas.h"
#include "common/texture/viewpoint_pairs.h"
#include "stages/walk/walk_params.h"

struct walk_files {
    const char *name;             /* of the scene */
    const char *model, *remodel;  /* folders: of the unedited model; of the edits */
    const char *relight;          /* folder of relit atlases and pictures; NULL: none */
    const char *axes, *views;     /* file; folder */
    const char *vdta, *vita;      /* folders */
    const char *ids, *depth;      /* folders; NULL: without clutter */
    const char *things;           /* folder; NULL: none are known */
    const char *outdoors;         /* file; NULL: none */
    const char *exposure;         /* file; NULL: 1 */
    const char *scripts, *meshes; /* folders of edits/E.txt and of objects' meshes; NULL: neither is shown */
    const char *page, *out;       /* folder of the page's parts; folder to write to */
    struct cli_list edits;
};

struct walk_model {
    const char *edit; /* NULL: unedited */
    char *about;      /* the comment at the head of the edit's script; NULL: none; owned */
    struct model_rays rays;
    struct texture_map map;
    struct model_plan plan;
    struct placed_things things;
    struct object_list objects;
    struct obj_mesh *meshes; /* of the objects; owned */
    struct camera_path tour; /* empty: there is none */
    struct viewpoint_pairs pairs;
    bool relit; /* there is an atlas in the new light */
    struct atlas relit_atlas;
};

/* A photograph; its views follow each other. */
struct walk_viewpoint {
    const char *photo; /* owned by the lens list */
    int first, count;  /* its views */
    struct atlas atlas;
};

struct walk_scene {
    const struct walk_files *files;
    const struct walk_params *params;
    struct scene_inputs in;        /* axes, lenses, views in the scene's frame */
    struct view *cameras;          /* the views in the model's frame; owned */
    struct walk_viewpoint *places; /* owned */
    int place_count;
    struct walk_model *models; /* the unedited one first; owned */
    int model_count;
    struct atlas vita;
    double exposure;
};

/* Reads all but pixels. The caller releases the scene in each case. */
enum status walk_scene_read(struct walk_scene *s, const struct walk_files *files, const struct walk_params *params,
                            struct provenance *prov, struct err *err);
void walk_scene_release(struct walk_scene *s);

#endif
