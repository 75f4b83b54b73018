/* rules.c - the videos of a run's films, and of the same moves in 2D. Tours and morphs have theirs in the rules of
 * their stages. */
#include "common/graph/scene_rules.h"

static void video_rule(struct graph *g, const char *item, const char *film, const char *video, bool flat)
{
    struct name_list frames = {0};
    name_list_read(&frames, PATH(g, FRAMES_MK, .film = film), "FRAMES", graph_err(g));
    graph_rule(g, "%s", item);
    rule_makes(g, video);
    for (int i = 0; i < frames.count; i++)
        rule_needs(g, flat ? PATH(g, PAN_SCAN_FRAME, .film = film, .frame = frames.names[i])
                           : PATH(g, FRAME, .film = film, .frame = frames.names[i]));
    rule_needs_path(g, film);
    rule_option(g, "--path", graph_own(g, film));
    rule_option(g, "--frames",
                flat ? FOLDER(g, PAN_SCAN_FRAME, .film = film, .frame = "")
                     : FOLDER(g, FRAME, .film = film, .frame = ""));
    rule_option(g, "--out", video);
    name_list_release(&frames);
}

RULES(encode_video)
{
    graph_step(g, "video", STEP_ONE, f->is_pair ? "morph" : "frames");
    graph_asked(g, "parallax", "video");
    graph_goal(g, "video", f->is_pair ? PATH(g, VIDEO, .film = "parallax/morph") : NULL);
    for (int e = 0; e < f->films.count; e++) {
        const char *effect = f->films.names[e], *film = graph_text(g, "parallax/%s", effect);
        const char *video = PATH(g, VIDEO, .film = film);
        video_rule(g, effect, film, video, false);
        video_rule(g, graph_text(g, "%s-pan_scan", effect), film, PATH(g, PAN_SCAN_VIDEO, .film = film), true);
        if (!f->is_pair) graph_goal(g, "video", video);
        graph_list(g, GRAPH_SHOWN, video);
    }
}
