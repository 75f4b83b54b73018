/* rules.c - frames of films in chunks, a process each; of a chunk only the frames that are missing or stale are
 * rendered. A film of keys or of given cameras may go anywhere, so it is rendered from all views and has no layers but
 * its own. */
#include "common/graph/scene_rules.h"

/* below: the folder of an eye below that of the film, or "". */
static void frames_rule(struct graph *g, const char *effect, const char *below, const struct name_list *frames,
                        int first, int count)
{
    const char *of_effect = graph_text(g, "parallax/%s", effect), *film = graph_text(g, "%s%s", of_effect, below);
    const char *effects = PATH(g, EFFECTS, .film = of_effect);
    const bool is_free = scene_film_is_free(g, effect);
    const char *layers = is_free ? NULL : graph_scene_file(g, "effects.txt");
    graph_piece(g, "%s%s-%s", effect, scene_item(g, below), frames->names[first]);
    for (int i = first; i < first + count; i++) {
        const char *frame = PATH(g, FRAME, .film = film, .frame = frames->names[i]);
        rule_makes(g, frame);
        graph_goal(g, "frames", frame);
    }
    rule_needs_path(g, film);
    rule_takes(g, "--effects", effects);
    rule_takes(g, "--effects", layers);
    rule_takes_cameras(g);
    rule_takes_depth(g);
    if (!is_free) rule_needs(g, PATH(g, FILM_VIEWS));
    if (!is_free) rule_after(g, graph_own(g, "stamp/film_views.txt"));
    rule_option(g, "--path", graph_own(g, film));
    if (!is_free) rule_option(g, "--film-views", PATH(g, FILM_VIEWS));
    if (scene_is_half_sphere(below)) rule_option(g, "--picture", "half_sphere");
    rule_option(g, "--out", FOLDER(g, FRAME, .film = film, .frame = ""));
    rule_stale(g, STALE_FRAMES);
}

/* The cameras of held-out photos, rendered from the other views. */
static void heldout_rule(struct graph *g, const struct name_list *held, int first, int count)
{
    graph_piece(g, "heldout-%s", held->names[first]);
    for (int i = first; i < first + count; i++) {
        const char *frame = PATH(g, HELD_FRAME, .view = held->names[i]);
        rule_makes(g, frame);
        graph_goal(g, "heldout", frame);
        graph_list(g, GRAPH_MEASURED, frame);
    }
    rule_needs_held_cameras(g);
    rule_takes_cameras(g);
    rule_takes_depth(g);
    rule_option(g, "--cameras", FOLDER(g, CAMERAS, .views = HELD_VIEWS));
    rule_option(g, "--out", FOLDER(g, HELD_FRAME, .view = ""));
    for (int i = first; i < first + count; i++) rule_option(g, "--camera", held->names[i]);
}

RULES(render_views)
{
    graph_step(g, "frames", STEP_WIDE, "path eyes");
    graph_goal(g, "frames", NULL);
    graph_goal(g, "heldout", NULL);
    for (int e = 0; e < f->films.count; e++) {
        struct name_list frames = {0};
        const char *film = graph_text(g, "parallax/%s", f->films.names[e]);
        name_list_read(&frames, PATH(g, FRAMES_MK, .film = film), "FRAMES", graph_err(g));
        for (int k = -1; k < f->eye_folders.count; k++)
            for (int i = 0; i < frames.count; i += f->frames_per_job)
                frames_rule(g, f->films.names[e], k < 0 ? "" : f->eye_folders.names[k], &frames, i,
                            scene_chunk_size(f, &frames, i));
        name_list_release(&frames);
    }
    for (int i = 0; f->compares_held && i < f->held.count; i += f->frames_per_job)
        heldout_rule(g, &f->held, i, scene_chunk_size(f, &f->held, i));
}
