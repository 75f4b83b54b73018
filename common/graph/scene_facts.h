/* scene_facts.h - what is known of a scene when its graph is printed: its folders, the settings of the run, and the
 * lists that products give, which are empty until these are made. */
#ifndef REMODEL_SCENE_FACTS_H
#define REMODEL_SCENE_FACTS_H

#include <stdbool.h>

#include "common/graph/name_list.h"

/* The folder of held-out views below O; that of the others is "views". */
#define HELD_VIEWS "holdout/views"

/* The rectified views of a photo, in the order of the list of views. */
struct photo_views {
    const char *photo;
    const char *const *views;
    int count;
};

struct view_groups {
    struct photo_views *photos; /* by name; owned */
    int count;
    const char **views;     /* of all photos; owned */
    struct name_list names; /* of the photos */
};

struct scene_facts {
    const char *scene;        /* its name */
    const char *folder;       /* scenes/NAME */
    const char *shared, *own; /* out/NAME; that of this quality and hold-out */
    const char *bin;          /* the folder of the programs */
    char *code;               /* that of their checksums; owned */

    struct name_list products;          /* words of PRODUCTS */
    struct name_list films;             /* effects of this run */
    struct name_list eyes, eye_folders; /* words of EYES; folders of their eyes below a film's: "/left" */
    struct name_list formats;           /* words of FILM: further formats of the films */
    const char *choose; /* "auto" or "all": the films of this run are chosen on the way; "": they are known */

    struct name_list photos;     /* ids */
    bool bracketed;              /* photos are exposures of the same views */
    bool is_pair;                /* two photos, whose film is a morph */
    struct name_list references; /* ids of the lighting reference images */

    struct name_list other_light; /* photos of lines `photo` of states.txt: they are held out */
    bool compares_held;           /* HOLDOUT or HOLDOUT_VIEWS: held-out photos are compared with pictures of them */
    bool holds_out;               /* some photos are held out, for either reason */
    struct name_list views, held; /* rectified views, and those held out */
    struct view_groups viewpoints, held_viewpoints;

    bool has_model;                      /* scenes/NAME/model.txt */
    struct name_list edits, drawn_edits; /* scenes/NAME/edits/EDIT.txt; those to draw and to relight */
    int frames_per_job;
};

/* The value of a variable that people set (REMODEL_VARIABLE in the environment); "" without one. */
const char *scene_setting(const char *variable);
bool scene_setting_is(const char *variable, const char *value);

bool scene_asks_for(const struct scene_facts *f, const char *product); /* PRODUCTS has the word */

/* Reads the lists under the folders. The texts given must outlive the facts, which the caller releases in each case. */
enum status scene_facts_read(struct scene_facts *f, const char *scene_folder, const char *shared, const char *own,
                             const char *bin, struct err *err);
void scene_facts_release(struct scene_facts *f);

#endif
