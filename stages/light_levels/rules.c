/* rules.c - light levels of the room as it is, and with EDIT after an edit. */
#include <string.h>

#include "common/graph/scene_rules.h"

enum { SPREAD = 4 }; /* photos to draw over where LUX_PHOTOS names none */

static void say_room(struct graph *g, const struct scene_facts *f, const char *model)
{
    const char *lights = scene_lights(g, f);
    rule_takes(g, "--model", PATH(g, MODEL));
    rule_takes(g, "--plan", PATH(g, PLAN, .model = model));
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_vita(g);
    rule_takes_things(g, f);
    rule_takes(g, "--outdoors", PATH(g, OUTDOORS));
    rule_takes(g, "--sky", PATH(g, SKY));
    rule_takes(g, "--lights", lights);
    if (lights) rule_takes(g, "--fit", PATH(g, LIGHT_FIT));
    if (lights && rule_needs_references(g, f)) rule_option(g, "--references", FOLDER(g, LRI, .photo = ""));
}

/* Files that people may write, and take away again. */
static void say_scripts(struct graph *g, const struct scene_facts *f)
{
    static const char *const names[] = {"places", "states"};
    const char *scale = scene_lux_scale(g, f);
    for (int i = 0; i < 2; i++) {
        const char *path = graph_scene_file(g, graph_text(g, "%s.txt", names[i]));
        if (path) rule_takes(g, graph_text(g, "--%s", names[i]), path);
        rule_needs(g, graph_stamp(g, graph_text(g, "%s.txt", names[i]), path ? path : "none"));
    }
    if (scale) rule_takes(g, "--scale", scale);
    rule_needs(g, graph_stamp(g, "lux_scale.txt", scale ? scale : "none"));
    rule_needs_webs(g, f); /* that states.txt may name */
    rule_needs(g, graph_stamp(g, "weather.txt", scene_setting("WEATHER")));
    rule_needs(g, graph_stamp(g, "lux_day.txt", scene_setting("DAY")));
    if (*scene_setting("DAY")) rule_variable(g, "--day", "DAY");
    if (*scene_setting("WEATHER")) rule_variable(g, "--weather", "WEATHER");
}

/* Photos to draw over: those of LUX_PHOTOS, all, or four spread over the list. Pictures of an edit stand for them where
 * `make remodel` has drawn any; edit NULL: the unedited room. */
static void say_photos(struct graph *g, const struct scene_facts *f, const char *edit)
{
    const struct view_groups *all = &f->viewpoints;
    const int spread = all->count < SPREAD ? all->count : SPREAD;
    const char *pictures = edit ? graph_text(g, "remodel/%s/pictures", edit) : NULL;
    struct name_list named = {0};
    const char *lit = edit ? graph_text(g, "relight/%s", edit) : NULL;
    bool drawn = false, relit = false;
    name_list_add_words(&named, scene_setting("LUX_PHOTOS"), graph_err(g));
    for (int i = 0; all->count && i < named.count; i++)
        if (strcmp(named.names[i], "all") != 0 && strcmp(named.names[i], "none") != 0 &&
            !name_list_has(&all->names, named.names[i]))
            graph_refuse(g, "LUX_PHOTOS=%s: found %s, wanted photos of this scene, all or none.",
                         scene_setting("LUX_PHOTOS"), named.names[i]);
    rule_needs(g, graph_stamp(g, "lux_photos.txt", scene_setting("LUX_PHOTOS")));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs_set(g, "views");
    for (int i = 0, next = 0; i < all->count; i++) {
        const struct photo_views *p = &all->photos[i];
        const bool is_spread = next < spread && i == next * all->count / spread;
        next += is_spread;
        if (!(named.count ? name_list_has(&named, "all") || name_list_has(&named, p->photo) : is_spread)) continue;
        rule_option(g, "--photo", p->photo);
        for (int k = 0; edit && k < p->count; k++) {
            if (path_is_file(PATH(g, RELIT, .relit = lit, .name = p->views[k]))) {
                rule_needs(g, PATH(g, RELIT_RECORD, .relit = lit, .name = p->views[k]));
                relit = true;
            }
            if (!path_is_file(PATH(g, PICTURE_JPEG, .pictures = pictures, .name = p->views[k]))) continue;
            rule_needs(g, PATH(g, PICTURE_RECORD, .pictures = pictures, .name = p->views[k]));
            drawn = true;
        }
    }
    if (drawn) rule_option(g, "--pictures", graph_own(g, pictures));
    if (relit) rule_option(g, "--relit", graph_own(g, lit));
    name_list_release(&named);
}

/* Photos in other light, which are held out. */
static void say_other_light(struct graph *g, const struct scene_facts *f)
{
    if (!f->other_light.count) return;
    rule_needs_held_cameras(g);
    rule_needs_set(g, "held_views");
    rule_option(g, "--held-views", FOLDER(g, CAMERAS, .views = HELD_VIEWS));
}

static void edit_rule(struct graph *g, const struct scene_facts *f, const char *edit)
{
    const char *edited = graph_text(g, "remodel/%s", edit), *lux = graph_text(g, "lux/%s", edit);
    const char *sheet = PATH(g, LIGHT_SHEET, .lux = lux);
    graph_goal(g, "lux", sheet);
    graph_rule(g, "%s", edit);
    rule_makes(g, sheet);
    say_room(g, f, edited);
    rule_takes(g, "--edited", PATH(g, MODEL, .model = edited));
    rule_takes(g, "--map", PATH(g, TEXTURE_MAP, .model = edited));
    rule_takes(g, "--objects", PATH(g, OBJECTS, .model = edited));
    rule_option(g, "--scene", f->folder);
    say_scripts(g, f);
    say_photos(g, f, edit);
    rule_takes(g, "--before", PATH(g, LIGHT_SHEET));
    rule_option(g, "--factors", PATH(g, LIGHT_FACTORS)); /* which was written before the sheet */
    rule_option(g, "--out", FOLDER(g, LIGHT_SHEET, .lux = lux));
}

RULES(light_levels)
{
    graph_step(g, "lux", STEP_ONE, "vita outdoors things");
    graph_goal(g, "lux", NULL);
    if (!f->has_model) return;
    graph_goal(g, "lux", PATH(g, LIGHT_SHEET));
    graph_rule(g, "room");
    rule_makes(g, PATH(g, LIGHT_SHEET));
    say_room(g, f, "model");
    say_scripts(g, f);
    say_other_light(g, f);
    say_photos(g, f, NULL);
    rule_option(g, "--out", FOLDER(g, LIGHT_SHEET));
    for (int i = 0; *scene_setting("EDIT") && i < f->drawn_edits.count; i++) edit_rule(g, f, f->drawn_edits.names[i]);
}
