/* rules.c - what lies outside of the model. Reference images are used if they are there: no scene must have any. */
#include "common/graph/scene_rules.h"

RULES(bake_outdoors)
{
    struct name_list images = {0};
    graph_step(g, "outdoors", STEP_ONE, "fill things");
    graph_goal(g, "outdoors", NULL);
    if (!f->has_model) return;
    graph_goal(g, "outdoors", PATH(g, OUTDOORS));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, OUTDOORS));
    rule_makes(g, PATH(g, SKY));
    rule_takes_seen_model(g);
    rule_needs(g, PATH(g, ATLAS, .atlas = FILL_ATLAS));
    rule_option(g, "--vita", FOLDER(g, ATLAS, .atlas = FILL_ATLAS));
    rule_takes_things(g, f);
    rule_needs_references(g, f);
    for (int i = 0; i < f->references.count; i++) {
        const char *image = PATH(g, LRI, .photo = f->references.names[i]);
        if (!path_is_file(image)) continue;
        rule_option(g, "--reference", image);
        name_list_add_words(&images, image, graph_err(g));
    }
    /* an image that went is a change whatever the times of the others */
    rule_needs(g, graph_stamp_list(g, "outdoors.txt", &images));
    rule_option(g, "--sky", PATH(g, SKY));
    rule_option(g, "--out", PATH(g, OUTDOORS));
    name_list_release(&images);
}
