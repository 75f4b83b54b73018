/* rules.c - the absolute scale of a scene's light. */
#include "common/graph/scene_rules.h"

/* What the irradiance at measured places is gathered from. */
static void say_light(struct graph *g, const struct scene_facts *f)
{
    const char *lights = scene_lights(g, f);
    rule_takes(g, "--model", PATH(g, MODEL));
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_vita(g);
    rule_takes_things(g, f);
    rule_takes(g, "--outdoors", PATH(g, OUTDOORS));
    rule_takes(g, "--lights", lights);
    if (lights && rule_needs_references(g, f)) rule_option(g, "--references", FOLDER(g, LRI, .photo = ""));
}

RULES(calibrate_light)
{
    const char *marks = graph_scene_file(g, "lux.txt");
    graph_step(g, "luminance", STEP_ONE, marks && f->has_model ? "vita outdoors things" : "views");
    graph_goal(g, "luminance", PATH(g, LUX_SCALE));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, LUX_SCALE));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    for (int i = 0; i < f->photos.count; i++) rule_needs(g, PATH(g, PHOTO, .photo = f->photos.names[i]));
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    /* a file of measurements that came or went is a change whatever its time */
    rule_needs(g, graph_stamp(g, "lux.txt", marks ? marks : "none"));
    if (marks) {
        rule_takes(g, "--marks", marks);
        rule_needs_set(g, "views");
        if (f->has_model) say_light(g, f);
    }
    rule_option(g, "--out", PATH(g, LUX_SCALE));
}
