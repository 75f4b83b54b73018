/* rules.c - the model and its edits under photographic texture: from the photos' views, from given cameras, as films.
 *
 * The frames of a tour are known when it has been planned; which views and atlases given cameras use, when they have
 * been drawn: so these need all of them. */
#include <string.h>

#include "common/graph/scene_rules.h"

static void picture_rule(struct graph *g, const struct scene_facts *f, const char *edit, const struct photo_views *p)
{
    const char *pictures = graph_text(g, "remodel/%s/pictures", edit);
    graph_piece(g, "%s-%s", edit, p->photo);
    rule_draws_photo(g, edit, pictures, p, "remodel-views");
    for (int i = 0; i < p->count; i++) {
        const char *record = PATH(g, PICTURE_RECORD, .pictures = pictures, .name = p->views[i]);
        graph_set(g, "pictures", record);
        if (!scene_asks_for(f, "remodel")) graph_list_if(g, GRAPH_ALWAYS_SHOWN, record, false);
    }
}

static void cameras_rule(struct graph *g, const char *model)
{
    const char *pictures = graph_text(g, "%s/cameras", model), *list = PATH(g, PICTURE_LIST, .pictures = pictures);
    graph_piece(g, "cameras-%s", scene_model_name(model));
    rule_makes(g, list);
    rule_draws_model(g, model);
    rule_needs_set(g, "vdta");
    rule_needs_set(g, "views");
    rule_needs_set(g, "ids");
    rule_needs_set(g, "depth");
    rule_needs(g, PATH(g, PHOTO_LIST));
    rule_needs(g, graph_own(g, "stamp/cameras.txt"));
    rule_variable(g, "--cameras", "CAMERAS");
    if (scene_setting_is("CAMERAS_FRAME", "truth")) {
        rule_variable(g, "--frame-of", "TRUTH");
        rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    } else if (*scene_setting("CAMERAS_FRAME")) {
        rule_option(g, "--frame", scene_setting("CAMERAS_FRAME"));
    }
    rule_option(g, "--out", graph_own(g, pictures));
    graph_goal(g, "remodel-cameras", list);
}

static void tour_rule(struct graph *g, const char *model, const struct name_list *frames, int first, int count)
{
    const char *tour = graph_text(g, "%s/tour", model);
    graph_piece(g, "tour-%s-%s", scene_model_name(model), frames->names[first]);
    for (int i = first; i < first + count; i++) {
        const char *frame = PATH(g, FRAME, .film = tour, .frame = frames->names[i]);
        rule_makes(g, frame);
        graph_goal(g, "tour-frames", frame);
    }
    rule_needs_tour(g, tour);
    rule_draws_model(g, model);
    rule_needs_set(g, "vdta");
    rule_needs_set(g, "ids");
    rule_needs_set(g, "depth");
    rule_option(g, "--path", graph_own(g, tour));
    rule_option(g, "--out", FOLDER(g, FRAME, .film = tour, .frame = ""));
    rule_stale(g, STALE_FRAMES);
}

static void tour_rules(struct graph *g, const struct scene_facts *f, const char *model)
{
    const char *tour = graph_text(g, "%s/tour", model), *video = PATH(g, VIDEO, .film = tour);
    struct name_list frames = {0};
    scene_tour_frames_read(g, &frames, tour);
    for (int i = 0; i < frames.count; i += f->frames_per_job)
        tour_rule(g, model, &frames, i, scene_chunk_size(f, &frames, i));
    graph_rule(g, "tour-%s", scene_model_name(model));
    rule_encodes(g, tour, &frames, tour);
    rule_needs_tour(g, tour);
    graph_goal(g, "tour", video);
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, video, false);
    name_list_release(&frames);
}

RULES(render_model)
{
    static const char *const goals[] = {"remodel-views", "remodel-cameras", "tour", "tour-frames"};
    graph_step(g, "remodel", STEP_FARM, "textures outdoors exposure things");
    graph_step(g, "tour", STEP_WIDE, "textures outdoors exposure tour-path things");
    graph_asked(g, "remodel", "remodel");
    graph_asked(g, "tour", "tour");
    graph_goal(g, "remodel", *scene_setting("CAMERAS") ? "remodel-cameras" : "remodel-views");
    for (size_t i = 0; i < sizeof goals / sizeof *goals; i++) graph_goal(g, goals[i], NULL);
    if (!f->has_model) return;
    for (int e = 0; e < f->drawn_edits.count; e++)
        for (int i = 0; i < f->viewpoints.count; i++)
            picture_rule(g, f, f->drawn_edits.names[e], &f->viewpoints.photos[i]);
    if (scene_asks_for(f, "remodel") && f->drawn_edits.count && f->views.count)
        graph_list(g, GRAPH_ALWAYS_SHOWN, graph_set_path(g, "pictures"));
    /* given cameras see the unedited model too, for comparison; a walk through it takes long, and is only made where
     * all edits are asked for */
    const bool some = *scene_setting("EDIT") || *scene_setting("DRAW");
    for (int e = -1; e < f->drawn_edits.count; e++) {
        const char *model = scene_model_folder(g, &f->drawn_edits, e);
        cameras_rule(g, model);
        if (e >= 0 || !some) tour_rules(g, f, model);
    }
}
