/* rules.c - irradiance of given points and of views, on request.
 *
 * Points are GATHER_POINTS, or those of a truth, once evaluate has brought them to the frame of the views. */
#include "common/graph/scene_rules.h"

static void say_light(struct graph *g, const struct scene_facts *f)
{
    const char *lights = scene_lights(g, f), *materials = scene_materials(g, f);
    rule_takes(g, "--model", PATH(g, MODEL));
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_vita(g);
    rule_takes_things(g, f);
    rule_takes(g, "--outdoors", PATH(g, OUTDOORS));
    rule_takes(g, "--lights", lights);
    rule_takes(g, "--materials", materials);
    if (materials) rule_needs_cameras(g);
    if (materials) rule_needs(g, PATH(g, LENSES));
    rule_option(g, "--views", FOLDER(g, CAMERAS));
    if (lights && rule_needs_references(g, f)) rule_option(g, "--references", FOLDER(g, LRI, .photo = ""));
}

RULES(gather_irradiance)
{
    const char *points = graph_own(g, "stamp/irradiance_points.txt");
    struct name_list views = {0}, records = {0};
    graph_step(g, "irradiance", STEP_ONE, "vita outdoors things");
    graph_goal(g, "irradiance", NULL);
    if (f->has_model && path_is_file(points)) { /* look.sh makes it */
        graph_goal(g, "irradiance", PATH(g, IRRADIANCE));
        graph_rule(g, "points");
        rule_makes(g, PATH(g, IRRADIANCE));
        rule_takes(g, "--points", points);
        say_light(g, f);
        rule_option(g, "--out", FOLDER(g, IRRADIANCE));
    }
    name_list_add_words(&views, scene_setting("GATHER_VIEWS"), graph_err(g));
    for (int i = 0; f->has_model && i < views.count; i++) {
        const char *path = PATH(g, IRRADIANCE_VIEW, .gathered = graph_text(g, "irradiance/%s", views.names[i]));
        graph_goal(g, "irradiance", path);
        graph_rule(g, "%s", views.names[i]);
        rule_makes(g, path);
        rule_needs_cameras(g);
        say_light(g, f);
        rule_option(g, "--view", views.names[i]);
        if (scene_materials(g, f)) rule_option(g, "--specular", "");
        rule_option(g, "--out", FOLDER(g, IRRADIANCE));
    }
    /* shown as they are: the page never gathers what a run did not ask for */
    const char *folders[] = {FOLDER(g, IRRADIANCE), graph_own(g, "relight/irradiance")};
    for (int k = 0; k < 2; k++) {
        name_list_add_files(&records, folders[k], "", ".light.txt", graph_err(g));
        for (int i = 0; i < records.count; i++)
            graph_list(g, GRAPH_ALWAYS_SHOWN, graph_text(g, "%s/%s.light.txt", folders[k], records.names[i]));
        name_list_release(&records);
    }
    name_list_release(&views);
}
