/* rules.c - the eyes of a run's films: a pair for flat pictures, another for half-spheres. */
#include <string.h>

#include "common/graph/scene_rules.h"

static void eyes_rule(struct graph *g, const char *effect, bool half_sphere)
{
    static const enum product_id files[] = {PRODUCT_PATH, PRODUCT_PATH_CAMERAS, PRODUCT_PATH_IMAGES,
                                            PRODUCT_PATH_POINTS};
    const bool is_free = scene_film_is_free(g, effect);
    const char *film = graph_text(g, "parallax/%s", effect);
    const char *pair = half_sphere ? graph_text(g, "%s/vr180", film) : film, *plan = PATH(g, EYES, .film = pair);
    graph_rule(g, "%s%s", effect, half_sphere ? "-vr180" : "");
    for (int side = 0; side < 2; side++)
        for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
            const char *eye = graph_text(g, "%s/%s", pair, side ? "right" : "left");
            rule_makes(g, graph_path(g, files[i], &(struct product_key){.film = eye}));
        }
    rule_makes(g, plan);
    graph_goal(g, "eyes", plan);
    rule_needs_path(g, film);
    rule_takes_cameras(g);
    rule_takes_depth(g);
    if (!is_free) rule_takes(g, "--film-views", PATH(g, FILM_VIEWS));
    if (!is_free) rule_after(g, graph_own(g, "stamp/film_views.txt"));
    rule_option(g, "--path", graph_own(g, film));
    if (half_sphere) rule_option(g, "--picture", "half_sphere");
    rule_option(g, "--out", graph_own(g, pair));
}

RULES(plan_eyes)
{
    static const char *const words[] = {"side_by_side", "top_bottom", "anaglyph", "vr180"};
    graph_step(g, "eyes", STEP_ONE, "path");
    graph_goal(g, "eyes", NULL);
    for (int i = 0; i < f->eyes.count; i++) {
        bool known = false;
        for (size_t k = 0; k < sizeof words / sizeof *words; k++) known = known || !strcmp(f->eyes.names[i], words[k]);
        if (!known)
            graph_refuse(g, "EYES=%s: wanted words among side_by_side, top_bottom, anaglyph and vr180.",
                         scene_setting("EYES"));
    }
    for (int i = 0; i < f->films.count; i++)
        for (int k = 0; k < f->eye_folders.count; k += 2)
            eyes_rule(g, f->films.names[i], scene_is_half_sphere(f->eye_folders.names[k]));
}
