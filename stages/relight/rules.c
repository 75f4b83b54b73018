/* rules.c - pictures under the light that an edit makes: render_model draws them unlit, with all radiance, then relight
 * brings them to the new light. Films go the same way, frame by frame, in the light of the relit atlas. */
#include <stdlib.h>
#include <string.h>

#include "common/graph/scene_rules.h"

enum { SPREAD = 4 }; /* photos to relight where RELIT_VIEWS names none */

/* Whether RELIT_VIEWS names the view or its photo. */
static bool is_wanted(const struct name_list *wanted, const char *photo, const char *view)
{
    return name_list_has(wanted, photo) || name_list_has(wanted, view);
}

/* The photos, or views of them, to relight: those of RELIT_VIEWS, all, or four spread over the list. */
static void find_wanted(struct graph *g, struct name_list *wanted, const struct scene_facts *f)
{
    const struct view_groups *all = &f->viewpoints;
    const char *views = scene_setting("RELIT_VIEWS");
    struct name_list named = {0};
    name_list_add_words(&named, views, graph_err(g));
    if (!named.count) {
        const int n = all->count < SPREAD ? all->count : SPREAD;
        for (int i = 0; i < n; i++) name_list_add_words(wanted, all->photos[i * all->count / n].photo, graph_err(g));
    } else if (name_list_has(&named, "all")) {
        for (int i = 0; i < all->count; i++) name_list_add_words(wanted, all->photos[i].photo, graph_err(g));
    } else {
        name_list_add_words(wanted, views, graph_err(g));
    }
    for (int i = 0; all->count && i < named.count; i++)
        if (strcmp(named.names[i], "all") && !name_list_has(&f->views, named.names[i]) &&
            !name_list_has(&all->names, named.names[i]))
            graph_refuse(g, "RELIT_VIEWS=%s: found %s, wanted photos or views of this scene; %s lists the views.",
                         views, named.names[i], PATH(g, VIEWS_MK));
    name_list_release(&named);
}

static void say_light(struct graph *g, const struct scene_facts *f, const char *edit)
{
    rule_needs(g, PATH(g, ATLAS, .atlas = graph_text(g, "relight/%s/vita", edit)));
    rule_needs_light_change(g, f, edit);
    rule_light_change(g, f, edit);
    rule_option(g, "--relit", graph_text(g, "%s/relight/%s", f->own, edit));
    rule_option(g, "--materials", scene_materials(g, f));
    rule_option(g, "--views", FOLDER(g, CAMERAS));
}

static void unlit_rule(struct graph *g, const char *edit, const struct photo_views *p)
{
    graph_piece(g, "unlit-%s-%s", edit, p->photo);
    rule_by(g, "render_model");
    rule_option(g, "--set", "radiance=all");
    rule_draws_photo(g, edit, graph_text(g, "relight/%s/unlit", edit), p, "unlit");
}

static void relit_rule(struct graph *g, const struct scene_facts *f, const char *edit, const struct photo_views *p)
{
    const char *unlit = graph_text(g, "relight/%s/unlit", edit), *relit = graph_text(g, "relight/%s", edit);
    graph_piece(g, "%s-%s", edit, p->photo);
    for (int i = 0; i < p->count; i++) {
        const char *record = PATH(g, RELIT_RECORD, .relit = relit, .name = p->views[i]);
        rule_makes(g, record);
        rule_needs(g, PATH(g, PICTURE_RECORD, .pictures = unlit, .name = p->views[i]));
        graph_goal(g, "relight", record);
        /* measured where they are shown: plain make shows what there is, and with the product makes it */
        graph_list_if(g, GRAPH_ALWAYS_SHOWN, record, scene_asks_for(f, "relight"));
        if (*scene_setting("TRUTH")) graph_list_if(g, GRAPH_MEASURED, record, scene_asks_for(f, "relight"));
        graph_list_if(g, GRAPH_REMODEL_SHOWN, record, false);
    }
    say_light(g, f, edit);
    rule_needs(g, scene_materials(g, f));
    rule_option(g, "--ids", FOLDER(g, FACE_INDEX));
    rule_option(g, "--depth", FOLDER(g, DEPTH, .depth = MODEL_DEPTH, .view = ""));
    rule_option(g, "--pictures", graph_own(g, unlit));
    for (int i = 0; i < p->count; i++) rule_option(g, "--picture", p->views[i]);
    rule_option(g, "--out", graph_own(g, relit));
}

/* Given cameras: render_model draws them as `make remodel` does. */
static void cameras_rule(struct graph *g, const struct scene_facts *f, const char *edit)
{
    const char *drawn = graph_text(g, "remodel/%s/cameras", edit), *relit = graph_text(g, "relight/%s/cameras", edit);
    graph_piece(g, "cameras-%s", edit);
    rule_makes(g, PATH(g, RELIT_LIST, .relit = relit));
    rule_needs(g, PATH(g, PICTURE_LIST, .pictures = drawn));
    say_light(g, f, edit);
    rule_needs(g, scene_materials(g, f));
    rule_option(g, "--pictures", graph_own(g, drawn));
    rule_option(g, "--list", "");
    rule_option(g, "--out", graph_own(g, relit));
    graph_goal(g, "unlit", PATH(g, PICTURE_LIST, .pictures = drawn));
    graph_goal(g, "relight", PATH(g, RELIT_LIST, .relit = relit));
}

static void picture_rules(struct graph *g, const struct scene_facts *f, const char *edit,
                          const struct name_list *wanted)
{
    for (int i = 0; i < f->viewpoints.count; i++) {
        const struct photo_views *all = &f->viewpoints.photos[i];
        const char **views = calloc((size_t)all->count, sizeof *views);
        struct photo_views p = {.photo = all->photo, .views = views};
        if (!views) err_nomem(graph_err(g), "views", (size_t)all->count * sizeof *views);
        for (int k = 0; views && k < all->count; k++)
            if (is_wanted(wanted, all->photo, all->views[k])) views[p.count++] = all->views[k];
        if (p.count) graph_goal(g, "relit-vdta", PATH(g, ATLAS, .atlas = graph_text(g, "vdta/%s", p.photo)));
        if (p.count) unlit_rule(g, edit, &p);
        if (p.count) relit_rule(g, f, edit, &p);
        free(views);
    }
}

static void unlit_frames_rule(struct graph *g, const char *edit, const struct name_list *frames, int first, int count)
{
    const char *walk = graph_text(g, "remodel/%s/tour", edit), *unlit = graph_text(g, "relight/%s/tour/unlit", edit);
    graph_piece(g, "relit-unlit-%s-%s", edit, frames->names[first]);
    rule_by(g, "render_model");
    for (int i = first; i < first + count; i++) {
        const char *frame = PATH(g, PICTURE, .pictures = unlit, .name = frames->names[i]);
        rule_makes(g, frame);
        graph_goal(g, "relit-tour-unlit", frame);
    }
    rule_needs_tour(g, walk);
    rule_draws_model(g, graph_text(g, "remodel/%s", edit));
    rule_needs_set(g, "vdta");
    rule_needs_set(g, "ids");
    rule_needs_set(g, "depth");
    rule_option(g, "--path", graph_own(g, walk));
    rule_option(g, "--set", "radiance=all");
    rule_option(g, "--out", graph_own(g, unlit));
    rule_stale(g, STALE_FRAMES);
}

static void relit_frames_rule(struct graph *g, const struct scene_facts *f, const char *edit,
                              const struct name_list *frames, int first, int count)
{
    const char *film = graph_text(g, "relight/%s/tour", edit), *unlit = graph_text(g, "relight/%s/tour/unlit", edit);
    graph_piece(g, "tour-%s-%s", edit, frames->names[first]);
    for (int i = first; i < first + count; i++) {
        const char *frame = PATH(g, FRAME, .film = film, .frame = frames->names[i]);
        rule_makes(g, frame);
        rule_needs(g, PATH(g, PICTURE, .pictures = unlit, .name = frames->names[i]));
        graph_goal(g, "relit-tour-frames", frame);
    }
    say_light(g, f, edit);
    rule_option(g, "--set", "light=atlas");
    rule_option(g, "--frames", "");
    rule_option(g, "--pictures", graph_own(g, unlit));
    for (int i = first; i < first + count; i++) rule_option(g, "--picture", frames->names[i]);
    rule_option(g, "--out", FOLDER(g, FRAME, .film = film, .frame = ""));
}

static void tour_rules(struct graph *g, const struct scene_facts *f, const char *edit)
{
    const char *walk = graph_text(g, "remodel/%s/tour", edit), *film = graph_text(g, "relight/%s/tour", edit);
    const char *video = PATH(g, VIDEO, .film = film);
    struct name_list frames = {0};
    scene_tour_frames_read(g, &frames, walk);
    for (int i = 0; i < frames.count; i += f->frames_per_job) {
        const int count = scene_chunk_size(f, &frames, i);
        unlit_frames_rule(g, edit, &frames, i, count);
        relit_frames_rule(g, f, edit, &frames, i, count);
    }
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, video, false);
    if (*scene_setting("TRUTH")) graph_list_if(g, GRAPH_MEASURED, video, false);
    if (frames.count) {
        graph_goal(g, "relit-tour", video);
        graph_rule(g, "relit-%s", edit);
        rule_encodes(g, film, &frames, walk);
        rule_needs_tour(g, walk);
    }
    name_list_release(&frames);
}

RULES(relight)
{
    static const char *const goals[] = {"unlit", "relight", "relit-tour", "relit-tour-unlit", "relit-tour-frames"};
    struct name_list wanted = {0};
    graph_step(g, "unlit", STEP_FARM, "");
    graph_step(g, "relight", STEP_FARM,
               *scene_setting("CAMERAS") ? "textures outdoors exposure things relit-vita unlit"
                                         : "relit-vdta vita outdoors exposure things relit-vita unlit");
    graph_step(g, "relit-tour-unlit", STEP_FARM, "textures outdoors exposure tour-path things");
    graph_step(g, "relit-tour-frames", STEP_FARM, "relit-vita relit-tour-unlit");
    graph_step(g, "relit-tour", STEP_ONE, "relit-tour-frames");
    graph_asked(g, "relight", "relight");
    for (size_t i = 0; i < sizeof goals / sizeof *goals; i++) graph_goal(g, goals[i], NULL);
    if (f->has_model) find_wanted(g, &wanted, f);
    for (int e = 0; f->has_model && e < f->drawn_edits.count; e++) {
        const char *edit = f->drawn_edits.names[e];
        if (*scene_setting("CAMERAS"))
            cameras_rule(g, f, edit);
        else
            picture_rules(g, f, edit, &wanted);
        tour_rules(g, f, edit);
    }
    name_list_release(&wanted);
}
