/* rules.c - the exposure is chosen in a step of its own, and written only if it is new: pictures depend on its text and
 * not on all views. Hence the stamp, and the exposure as a file that no rule makes. */
#include "common/graph/scene_rules.h"

RULES(choose_exposure)
{
    const char *done = graph_own(g, "stamp/exposure.txt");
    graph_step(g, "exposure", STEP_ONE, "views");
    graph_goal(g, "exposure", NULL);
    if (!f->has_model) return;
    graph_goal(g, "exposure", done);
    graph_rule(g, "all");
    rule_makes(g, done);
    rule_takes_cameras(g);
    rule_needs_set(g, "views");
    if (!path_is_file(PATH(g, EXPOSURE))) rule_needs_force(g);
    rule_option(g, "--out", PATH(g, EXPOSURE));
    rule_then(g, graph_text(g, "mkdir -p %s && echo done >%s", graph_own(g, "stamp"), done));
    graph_source(g, PATH(g, EXPOSURE));
}
