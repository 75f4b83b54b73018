/* rules.c - the curve is found before the merges are planned (stages/hdr_merge/run.sh), and written only if it is new,
 * so that merges need its text and not the photos: hence the stamp, and the curve as a file that no rule makes. */
#include "common/graph/scene_rules.h"

RULES(fit_response)
{
    const char *stamp = graph_shared(g, "stamp/response.txt");
    graph_goal(g, "response", NULL);
    if (!f->bracketed || graph_scene_file(g, "response.txt")) return;
    graph_goal(g, "response", stamp);
    graph_rule(g, "all");
    rule_shared(g);
    rule_makes(g, stamp);
    for (int i = 0; i < f->photos.count; i++) rule_needs(g, PATH(g, PHOTO, .photo = f->photos.names[i]));
    rule_needs(g, PATH(g, PHOTO_LIST));
    rule_originals(g, "--photos");
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--out", PATH(g, RESPONSE));
    rule_then(g, graph_text(g, "mkdir -p %s && echo done >%s", graph_shared(g, "stamp"), stamp));
    graph_source(g, PATH(g, RESPONSE));
}
