/* rules.c - the move in 2D, on request. Which view it shows depends on the path. */
#include "common/graph/scene_rules.h"

static void frames_rule(struct graph *g, const char *effect, const struct name_list *frames, int first, int count)
{
    const char *film = graph_text(g, "parallax/%s", effect);
    graph_piece(g, "%s-%s", effect, frames->names[first]);
    for (int i = first; i < first + count; i++) {
        const char *frame = PATH(g, PAN_SCAN_FRAME, .film = film, .frame = frames->names[i]);
        rule_makes(g, frame);
        graph_goal(g, "pan_frames", frame);
    }
    rule_needs_path(g, film);
    rule_takes_cameras(g);
    rule_needs_set(g, "views");
    rule_takes_depth(g);
    rule_option(g, "--path", graph_own(g, film));
    rule_option(g, "--out", FOLDER(g, PAN_SCAN_FRAME, .film = film, .frame = ""));
    rule_stale(g, STALE_FRAMES);
}

RULES(pan_scan)
{
    graph_step(g, "pan_scan", STEP_WIDE, "path");
    graph_goal(g, "pan_frames", NULL);
    graph_goal(g, "pan_scan", NULL);
    for (int e = 0; e < f->films.count; e++) {
        const char *film = graph_text(g, "parallax/%s", f->films.names[e]);
        const char *video = PATH(g, PAN_SCAN_VIDEO, .film = film);
        struct name_list frames = {0};
        name_list_read(&frames, PATH(g, FRAMES_MK, .film = film), "FRAMES", graph_err(g));
        for (int i = 0; i < frames.count; i += f->frames_per_job)
            frames_rule(g, f->films.names[e], &frames, i, scene_chunk_size(f, &frames, i));
        graph_goal(g, "pan_scan", video);
        graph_list_if(g, GRAPH_SHOWN, video, false);
        name_list_release(&frames);
    }
}
