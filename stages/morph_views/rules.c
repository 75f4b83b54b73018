/* rules.c - the film from one photo to another. Two photos have a morph and nothing else, unless a move was named;
 * camera poses are used where there are any. */
#include <string.h>

#include "common/graph/scene_rules.h"

static const char film[] = "parallax/morph";

/* The two photos of MORPH, or those of a scene of two. */
static void find_photos(struct graph *g, struct name_list *photos, const struct scene_facts *f)
{
    const char *morph = scene_setting("MORPH");
    name_list_add_words(photos, morph, graph_err(g));
    const bool is_plain = !morph[strspn(morph, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_- ")];
    if (*morph && (photos->count != 2 || !is_plain))
        graph_refuse(g, "MORPH=%s: wanted the ids of two photos, as in MORPH=\"a b\".", morph);
    else if (*morph && !strcmp(photos->names[0], photos->names[1]))
        graph_refuse(g, "MORPH=%s: wanted two photos, found one twice.", morph);
    if (!photos->count && f->photos.count == 2)
        for (int i = 0; i < 2; i++) name_list_add_words(photos, f->photos.names[i], graph_err(g));
}

static const enum product_id files[] = {PRODUCT_PATH,        PRODUCT_PATH_CAMERAS, PRODUCT_PATH_IMAGES,
                                        PRODUCT_PATH_POINTS, PRODUCT_MORPH_FIRST,  PRODUCT_MORPH_SECOND};
enum { FILES = sizeof files / sizeof *files };

static const char *file_of(struct graph *g, int i)
{
    return graph_path(g, files[i], &(struct product_key){.film = film});
}

static void path_rule(struct graph *g, const struct scene_facts *f, const struct name_list *photos, const char *stamp)
{
    const bool posed = path_is_file(PATH(g, VIEWS_MK));
    graph_rule(g, "path");
    for (int i = 0; i < FILES; i++) rule_makes(g, file_of(g, i));
    rule_makes(g, PATH(g, FRAMES_MK, .film = film));
    for (int i = 0; i < 2; i++) rule_needs(g, scene_photo_source(g, f, photos->names[i]));
    if (posed) rule_needs_cameras(g);
    if (posed) rule_needs(g, PATH(g, LENSES));
    rule_needs(g, stamp);
    rule_photos(g, f, "--photos");
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--first", photos->names[0]);
    rule_option(g, "--second", photos->names[1]);
    if (posed) rule_option(g, "--views", FOLDER(g, CAMERAS));
    rule_option(g, "--out", graph_own(g, film));
}

static void frames_rule(struct graph *g, const struct name_list *frames, int first, int count)
{
    graph_piece(g, "%s", frames->names[first]);
    for (int i = first; i < first + count; i++) {
        const char *frame = PATH(g, FRAME, .film = film, .frame = frames->names[i]);
        rule_makes(g, frame);
        graph_goal(g, "morph-frames", frame);
    }
    for (int i = 0; i < FILES; i++) rule_needs(g, file_of(g, i));
    rule_option(g, "--morph", graph_own(g, film));
    rule_option(g, "--out", FOLDER(g, FRAME, .film = film, .frame = ""));
    rule_stale(g, STALE_FRAMES);
}

RULES(morph_views)
{
    struct name_list photos = {0}, frames = {0};
    const char *video = PATH(g, VIDEO, .film = film);
    find_photos(g, &photos, f);
    graph_step(g, "morph", STEP_ONE, f->is_pair && *scene_setting("SFM") ? "hdr sfm" : "hdr");
    graph_goal(g, "morph-path", PATH(g, FRAMES_MK, .film = film));
    graph_goal(g, "morph-frames", NULL);
    graph_goal(g, "morph", video);
    graph_list_if(g, GRAPH_SHOWN, video, false);
    const char *stamp = photos.count ? graph_stamp_list(g, "morph.txt", &photos) : graph_stamp(g, "morph.txt", NULL);
    if (photos.count == 2) {
        path_rule(g, f, &photos, stamp);
        name_list_read(&frames, PATH(g, FRAMES_MK, .film = film), "MORPH_FRAMES", graph_err(g));
        for (int i = 0; i < frames.count; i += f->frames_per_job)
            frames_rule(g, &frames, i, scene_chunk_size(f, &frames, i));
        graph_rule(g, "morph");
        rule_encodes(g, film, &frames, film);
        for (int i = 0; i < FILES; i++) rule_needs(g, file_of(g, i));
    }
    name_list_release(&photos);
    name_list_release(&frames);
}
