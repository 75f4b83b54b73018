/* rules.c - the videos of a run's films, and of the same moves in 2D. Tours and morphs have theirs in the rules of
 * their stages. */
#include <string.h>

#include "common/film/film_signal.h"
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

/* The film of two eyes, or of one (eyes NULL), in a format. */
static void kind_rule(struct graph *g, const char *effect, const char *eyes, const char *format)
{
    const bool master = !strcmp(film_format_find(format)->ending, "mov"), plain = !strcmp(format, "h264");
    const char *film = graph_text(g, "parallax/%s", effect);
    const char *kind = !eyes ? format : plain ? eyes : graph_text(g, "%s-%s", eyes, format);
    const char *video =
        master ? PATH(g, VIDEO_MASTER, .film = film, .name = kind) : PATH(g, VIDEO_KIND, .film = film, .name = kind);
    const char *pair = eyes && !strcmp(eyes, "vr180") ? graph_text(g, "%s/vr180", film) : film;
    const char *left = eyes ? graph_text(g, "%s/left", pair) : film, *right = graph_text(g, "%s/right", pair);
    struct name_list frames = {0};
    name_list_read(&frames, PATH(g, FRAMES_MK, .film = film), "FRAMES", graph_err(g));
    graph_rule(g, "%s-%s", effect, kind);
    rule_makes(g, video);
    for (int i = 0; i < frames.count; i++) {
        rule_needs(g, PATH(g, FRAME, .film = left, .frame = frames.names[i]));
        if (eyes) rule_needs(g, PATH(g, FRAME, .film = right, .frame = frames.names[i]));
    }
    rule_needs_path(g, left);
    rule_option(g, "--path", graph_own(g, left));
    rule_option(g, "--frames", FOLDER(g, FRAME, .film = left, .frame = ""));
    if (eyes) rule_option(g, "--right", FOLDER(g, FRAME, .film = right, .frame = ""));
    if (eyes) rule_option(g, "--eyes", eyes);
    rule_option(g, "--film", format);
    rule_option(g, "--out", video);
    name_list_release(&frames);
    graph_goal(g, "video", video);
    graph_list(g, GRAPH_SHOWN, video);
}

/* All kinds of a film but the usual one. */
static void kind_rules(struct graph *g, const struct scene_facts *f, const char *effect)
{
    for (int e = -1; e < f->eyes.count; e++)
        for (int k = -1; k < f->formats.count; k++) {
            const char *format = k < 0 ? "h264" : f->formats.names[k];
            if (k < 0 ? e < 0 : !strcmp(format, "h264")) continue;
            kind_rule(g, effect, e < 0 ? NULL : f->eyes.names[e], format);
        }
}

static bool formats_are_known(struct graph *g, const struct scene_facts *f)
{
    for (int i = 0; i < f->formats.count; i++)
        if (!film_format_find(f->formats.names[i])) {
            graph_refuse(g, "FILM=%s: wanted words among %s.", scene_setting("FILM"), film_format_names());
            return false;
        }
    return true;
}

RULES(encode_video)
{
    graph_step(g, "video", STEP_ONE, f->is_pair ? "morph" : "frames");
    const bool known = formats_are_known(g, f);
    graph_asked(g, "parallax", "video");
    graph_goal(g, "video", f->is_pair ? PATH(g, VIDEO, .film = "parallax/morph") : NULL);
    for (int e = 0; e < f->films.count; e++) {
        const char *effect = f->films.names[e], *film = graph_text(g, "parallax/%s", effect);
        const char *video = PATH(g, VIDEO, .film = film);
        video_rule(g, effect, film, video, false);
        video_rule(g, graph_text(g, "%s-pan_scan", effect), film, PATH(g, PAN_SCAN_VIDEO, .film = film), true);
        if (!f->is_pair) graph_goal(g, "video", video);
        if (!f->is_pair && known) kind_rules(g, f, effect);
        graph_list(g, GRAPH_SHOWN, video);
    }
}
