/* rules.c - merged exposures of each view, which all qualities share, and lighting reference images on request. */
#include <string.h>

#include "common/graph/scene_rules.h"

/* Where the poses of reference images come from: frames of LRI_SFM, or corners marked in the images. */
enum place { PLACE_NONE, PLACE_PHOTOS, PLACE_SCENE, PLACE_MODEL, PLACE_CORNERS };

static enum place place_of_references(void)
{
    if (scene_setting_is("LRI_FRAME", "corners")) return PLACE_CORNERS;
    if (!*scene_setting("LRI_SFM")) return PLACE_NONE;
    return scene_setting_is("LRI_FRAME", "scene")   ? PLACE_SCENE
           : scene_setting_is("LRI_FRAME", "model") ? PLACE_MODEL
                                                    : PLACE_PHOTOS;
}

static const char *step_before(enum place place)
{
    switch (place) {
    case PLACE_CORNERS:
        return "model";
    case PLACE_MODEL:
        return "axes";
    case PLACE_PHOTOS:
        return "sfm";
    case PLACE_SCENE:
    case PLACE_NONE:
        break;
    }
    return "";
}

static void say_place(struct graph *g, const struct scene_facts *f, enum place place)
{
    const char *marks = graph_text(g, "%s/lri.txt", f->folder);
    if (place == PLACE_PHOTOS) {
        rule_takes_cameras(g);
        rule_needs(g, PATH(g, LENSES));
        rule_option(g, "--scene-records", FOLDER(g, PHOTO_LIST));
    } else if (place == PLACE_CORNERS) {
        rule_takes(g, "--marks", marks);
        rule_takes(g, "--plan", PATH(g, PLAN));
        rule_needs_cameras(g);
        for (int i = 0; i < f->views.count; i++) rule_needs(g, PATH(g, VIEW, .view = f->views.names[i]));
        rule_option(g, "--outdoors", FOLDER(g, CAMERAS));
    }
    if (place != PLACE_MODEL && place != PLACE_CORNERS) return;
    rule_takes(g, "--axes", PATH(g, AXES));
}

static void merge_rule(struct graph *g, const char *photo)
{
    graph_piece(g, "%s", photo);
    rule_shared(g);
    rule_makes(g, PATH(g, HDR, .photo = photo));
    rule_makes(g, PATH(g, HDR_PICTURE, .photo = photo));
    rule_needs(g, PATH(g, PHOTO, .photo = photo));
    rule_needs_response(g);
    rule_option(g, "--id", photo);
    rule_originals(g, "--photos");
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--response", scene_response(g));
    rule_option(g, "--out", FOLDER(g, RESPONSE));
    graph_goal(g, "hdr", PATH(g, HDR, .photo = photo));
    graph_goal(g, "hdr", PATH(g, HDR_PICTURE, .photo = photo));
}

static void reference_rule(struct graph *g, const struct scene_facts *f, const char *image)
{
    graph_piece(g, "lri.%s", image);
    rule_shared(g);
    rule_makes(g, PATH(g, LRI, .photo = image));
    rule_makes(g, PATH(g, LRI_PICTURE, .photo = image));
    rule_needs(g, PATH(g, PHOTO, .records = "lri/photos", .photo = image));
    const char *given = graph_scene_file(g, "response.txt");
    if (f->bracketed)
        rule_needs_response(g);
    else
        rule_needs(g, given);
    rule_needs(g, graph_shared(g, "stamp/lri.txt"));
    rule_option(g, "--id", image);
    rule_variable(g, "--photos", "LRI");
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST, .records = "lri/photos"));
    rule_option(g, "--response", f->bracketed ? scene_response(g) : given);
    rule_variable(g, "--model", "LRI_SFM");
    say_place(g, f, place_of_references());
    rule_option(g, "--out", graph_shared(g, "lri"));
    graph_goal(g, "lri", PATH(g, LRI, .photo = image));
    graph_goal(g, "lri", PATH(g, LRI_PICTURE, .photo = image));
}

RULES(hdr_merge)
{
    graph_step(g, "hdr", STEP_FARM, "");
    graph_step(g, "lri", STEP_FARM, step_before(place_of_references()));
    graph_goal(g, "hdr", NULL);
    graph_goal(g, "lri", NULL);
    for (int i = 0; f->bracketed && i < f->photos.count; i++) merge_rule(g, f->photos.names[i]);
    for (int i = 0; i < f->references.count; i++) reference_rule(g, f, f->references.names[i]);
}
