/* rules.c - what EFFECT=auto and EFFECT=all stand for. */
#include <string.h>

#include "common/graph/scene_rules.h"

RULES(choose_effects)
{
    const char *effect = scene_setting("EFFECT");
    if (effect[strspn(effect, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_+ -")])
        graph_refuse(g, "EFFECT=%s: effects are named with letters, digits, _, - and +.", effect);
    graph_step(g, "choice", STEP_ONE, "depth film_views");
    graph_goal(g, "choice", NULL);
    if (!*f->choose) return;
    const char *choice = PATH(g, EFFECT_CHOICE, .name = f->choose);
    graph_goal(g, "choice", choice);
    graph_rule(g, "%s", f->choose);
    rule_makes(g, choice);
    rule_takes(g, "--subjects", PATH(g, SUBJECTS));
    rule_option(g, "--effect", f->choose);
    rule_option(g, "--out", choice);
}
