/* rules.c - the atlas of all faces under the light that an edit makes. */
#include "common/graph/scene_rules.h"

RULES(update_vita)
{
    graph_step(g, "relit-vita", STEP_ONE, "vita outdoors things");
    graph_goal(g, "relit-vita", NULL);
    for (int i = 0; f->has_model && i < f->drawn_edits.count; i++) {
        const char *edit = f->drawn_edits.names[i];
        const char *atlas = PATH(g, ATLAS, .atlas = graph_text(g, "relight/%s/vita", edit));
        graph_goal(g, "relit-vita", atlas);
        graph_rule(g, "%s", edit);
        rule_makes(g, atlas);
        rule_makes(g, PATH(g, OBJECT_LIGHT, .edit = edit));
        rule_needs_light_change(g, f, edit);
        rule_light_change(g, f, edit);
        rule_option(g, "--out", FOLDER(g, OBJECT_LIGHT, .edit = edit));
    }
}
