/* sequences.c - random scripts and random sequences of edits give the solids that they describe.
 *
 * Each sequence draws a base script (a house of rooms, an L, a room with a cut corner, single walls, two houses back to
 * back), adds random statements to it, then applies random edits. A rejected statement must be rejected with file and
 * line, and is left out. After each accepted one: the model is closed, 2-manifold and free of self-intersections; along
 * random lines it has matter where the solids do; if everything is along the axes, its volume is that of
 * script_model.h; faces have the ids of the base by name; a point of the surface that was on the base's surface keeps
 * its face name unless the named thing was touched, or the log records a merge; texture.txt reads back, covers every
 * face, and points show what the statements about textures say (script_textures.h), or their own place if nothing
 * changed them; clutter is cleared where the script says so; the edit as two scripts, one on the other, gives the same.
 *
 * `make sequences` draws 10 000. In the environment, SEQUENCES=N sets their number, and SEQUENCE=N runs and prints
 * sequence N alone. */
#include "tests/unit/build_model/random_textures.h"
#include "tests/unit/build_model/sequence_textures.h"

#include "stages/build_model/plan/edit_chain.h"
#include "stages/build_model/plan/plan_internal.h"

enum { DEFAULT_SEQUENCES = 300, FURNISHINGS = 6, EDITS = 8, LINES = 10 };
/* In many sequences each of the statements that random_script.h makes is accepted in some edit. */
enum { MANY_SEQUENCES = 2000, MADE_VERBS = 32 };

static int accepted, rejected, exact_models, points, textures, by_verb[64];

/* Counts the accepted statement. */
static void count_verb(const char *line)
{
    const size_t length = strcspn(line, " \n");
    for (int v = 0; v < verb_count; v++)
        by_verb[v] += strlen(verbs[v].word) == length && !strncmp(verbs[v].word, line, length);
}

static void check_identity(const struct model *base, const struct model *m, const struct touched *touched,
                           const struct ray *rays, const char *text, const char *edit)
{
    static struct hit old[MAX_HITS], new[MAX_HITS];
    const struct solid_mesh *b = &base->mesh, *e = &m->mesh;
    const int max_id = b->names[b->name_count - 1].id;
    for (int i = 0; i < e->name_count; i++) {
        int k = 0;
        while (k < b->name_count && strcmp(b->names[k].name, e->names[i].name)) k++;
        if (k < b->name_count ? e->names[i].id == b->names[k].id : e->names[i].id > max_id) continue;
        explain(text, edit);
        fail_msg("%s has the id %d", e->names[i].name, e->names[i].id);
    }
    for (int r = 0; r < LINES; r++) {
        const int count = hit_mesh(b, &rays[r], old), edited = hit_mesh(e, &rays[r], new);
        for (int i = 0, k = 0; i < count; i++) {
            while (k < edited && new[k].t < old[i].t - 1e-9) k++;
            if (k == edited || new[k].t > old[i].t + 1e-9 || new[k].way != old[i].way ||
                strcmp(new[k].body, old[i].body))
                continue;
            points++;
            if (!strcmp(new[k].name, old[i].name) || may_differ(touched, base, old[i].name, m, new[k].name)) continue;
            explain(text, edit);
            fail_msg("a point of %s is now on %s", old[i].name, new[k].name);
        }
    }
}

static void check_model(const struct model *m, struct expected *expected, const struct ray *rays, const char *text,
                        const char *edit)
{
    static struct hit mesh[MAX_HITS], solids[MAX_HITS];
    for (int i = 0; i < m->mesh.name_count; i++) {
        const char *end = strrchr(m->mesh.names[i].name, '/');
        if (strcmp(end, "/cut")) continue;
        explain(text, edit);
        fail_msg("a cut between a wall's pieces is on the surface: %s", m->mesh.names[i].name);
    }
    for (int r = 0; r < LINES; r++) {
        int count;
        if (!hit_solids(&m->list, &rays[r], solids, &count)) continue;
        const int found = hit_mesh(&m->mesh, &rays[r], mesh);
        for (int b = 0; b < m->mesh.body_count; b++) {
            const double off = line_difference(mesh, found, solids, count, m->mesh.bodies[b].name);
            if (off < 1e-3) continue;
            explain(text, edit);
            fail_msg("along a line, body %s differs from its solids over a length of %g", m->mesh.bodies[b].name, off);
        }
    }
    if (!expected->exact) return;
    double solid, panes, found[2] = {0, 0};
    expected_volumes(expected, &solid, &panes);
    exact_models++;
    for (int b = 0; b < m->mesh.body_count; b++)
        found[!!strcmp(m->mesh.bodies[b].name, "walls")] += solid_mesh_volume(&m->mesh, b);
    /* surfaces are rounded to the lattice, by half a step at most; positions within a step of each other are equal */
    const double tolerance = 1e-8 * (1 + solid) + (with_crumbs() ? 1.5e-6 * m->report.area : 0);
    if (fabs(found[0] - solid) < tolerance && fabs(found[1] - panes) < tolerance) return;
    explain(text, edit);
    for (int i = 0, shown = 0; i < 1000000 && shown < 3; i++) { /* where */
        const double p[3] = {random_unit() * 14 - 4, random_unit() * 14 - 5, random_unit() * 5 - 1};
        if (expected_has_matter(expected, p) == (inside(&m->list, "walls", p[0], p[1], p[2]) > 0)) continue;
        print_message("at %.3f %.3f %.3f the script has %smatter\n", p[0], p[1], p[2],
                      expected_has_matter(expected, p) ? "" : "no ");
        shown++;
    }
    fail_msg("volume %.12g and panes %.12g, but the script describes %.12g and %.12g", found[0], found[1], solid,
             panes);
}

static void interpret(struct expected *expected, const char *text)
{
    char copy[TEXT], *rest = copy;
    expected_begin(expected);
    snprintf(copy, sizeof copy, "%s", text);
    for (char *line; (line = strtok_r(rest, "\n", &rest));)
        if (strncmp(line, "remodel", 7)) expected_apply(expected, line);
}

static void accept_line(struct expected *expected, const char *line)
{
    accepted++;
    count_verb(line);
    expected_apply(expected, line);
}

static bool is_about_textures(const char *line)
{
    static const char *const begins[] = {"texture ", "copy ", "colour ",   "set colour ", "clear ",        "keep ",
                                         "paint ",   "lamp ", "material ", "object ",     "remove object "};
    for (size_t i = 0; i < sizeof begins / sizeof *begins; i++)
        if (!strncmp(line, begins[i], strlen(begins[i]))) return true;
    return false;
}

/* Draws a statement of an edit; user: a second one, if the first sets a default, which some statement must use. */
static void draw_edit(const struct expected *expected, const struct model *base, char *line, char *user, int *step)
{
    *user = '\0';
    if (one_of(4))
        random_statement(expected, line, ++*step);
    else
        texture_statement(expected, &base->mesh, line);
    if (!strncmp(line, "set ", 4) && !is_about_textures(line)) new_user(expected, user, ++*step);
    if (with_crumbs()) add_crumbs(line);
}

/* The edit as two scripts, the second of which stands on the first, gives the same plan and the same textures. */
static void check_chain(const struct model *base, const struct model *edited, const char *text, const char *edit)
{
    static char lower[TEXT], upper[TEXT];
    const char *cut = strchr(edit, '\n') + 1;
    for (int skip = one_of(EDITS); skip > 0 && *cut; skip--) {
        const bool with_user = !strncmp(cut, "set ", 4) && !is_about_textures(cut);
        for (int i = 0; i < (with_user ? 2 : 1); i++) cut = strchr(cut, '\n') + 1;
    }
    snprintf(lower, sizeof lower, "%.*s", (int)(cut - edit), edit);
    snprintf(upper, sizeof upper, "remodel-script 1\nbase lower\n%s", cut);
    scratch_write("lower.txt", lower);
    struct model chained = {0};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    char *states[2];
    plan_begin(&chained.plan, NULL);
    if (edit_chain_apply_model(&chained.plan, scratch_write("model.txt", text), NULL, &prov, &err) ||
        edit_chain_apply_edit(&chained.plan, scratch_write("upper.txt", upper), NULL, &prov, &err) ||
        texture_rules_make(&chained.map, &edited->mesh, &base->mesh, &chained.plan, &err)) {
        explain(text, upper);
        fail_msg("an edit on an edit was refused: %s", err.text);
    }
    assert_string_equal(chained.map.base, "lower");
    free(chained.plan.base); /* the only difference */
    chained.plan.base = NULL;
    if (plan_state(&states[0], &chained.plan, &err) || plan_state(&states[1], &edited->plan, &err)) {
        fail_msg("%s", err.text);
    }
    assert_string_equal(states[0], states[1]);
    assert_true(same_map(&chained.map, &edited->map));
    count_verb("base");
    for (int i = 0; i < 2; i++) free(states[i]);
    provenance_release(&prov);
    drop_model(&chained);
}

static void one_sequence(void)
{
    static char base[TEXT], edit[TEXT], tried[TEXT];
    static struct expected expected, before, unedited;
    struct touched touched = {.count = 0};
    struct model m, edited;
    struct ray rays[LINES];
    char line[LINE], user[LINE];
    int step = 0, lines = 1;

    drawn = 0;
    do add_base(base);
    while (!make_model(&m, NULL, base, NULL, 0)); /* rejected if walls are thicker than rooms */
    drop_model(&m);
    interpret(&expected, base);
    for (int i = 0; i < FURNISHINGS; i++) {
        random_statement(&expected, line, ++step);
        if (with_crumbs()) add_crumbs(line);
        strcpy(tried, base);
        append(tried, "%s", line);
        if (!make_model(&m, NULL, tried, NULL, 0)) continue;
        drop_model(&m);
        strcpy(base, tried);
        expected_apply(&expected, line);
    }
    assert_true(make_model(&m, NULL, base, NULL, 0));
    if (!m.mesh.face_count) {
        drop_model(&m);
        return;
    }
    for (int r = 0; r < LINES; r++) rays[r] = random_ray(&m.mesh);
    check_model(&m, &expected, rays, base, NULL);
    strcpy(edit, "remodel-script 1\n");
    unedited = expected;
    expected.unedited = &unedited;
    for (int i = 0; i < EDITS; i++) {
        draw_edit(&expected, &m, line, user, &step);
        strcpy(tried, edit);
        append(tried, "%s%s", line, user);
        if (!make_model(&edited, &m, base, tried, *user ? 0 : lines + 1)) {
            rejected++;
            continue;
        }
        strcpy(edit, tried);
        lines += *user ? 2 : 1;
        before = expected;
        accept_line(&expected, line);
        if (*user) accept_line(&expected, user);
        if (!is_about_textures(line)) {
            touch_line(&touched, &before, line);
            touch_line(&touched, &expected, line);
            touch_line(&touched, &expected, user);
        }
        check_model(&edited, &expected, rays, base, edit);
        check_identity(&m, &edited, &touched, rays, base, edit);
        check_textures(&m, &edited, &expected, &touched, rays, LINES, &textures, base, edit);
        if (one_of(EDITS) == 0) check_chain(&m, &edited, base, edit);
        if (i == EDITS - 1) assert_triangles_closed(&edited.mesh);
        drop_model(&edited);
    }
    drop_model(&m);
    if (getenv("SEQUENCE")) explain(base, edit);
}

static void random_sequences_of_edits_give_the_described_solids(void **state)
{
    const char *wanted = getenv("SEQUENCES"), *one = getenv("SEQUENCE");
    const int count = wanted ? atoi(wanted) : DEFAULT_SEQUENCES;
    (void)state;
    numbers = rng_make(11, "build_model", "sequences");
    for (int i = 0; i < count && !one; i++) {
        sequence = (uint64_t)i;
        one_sequence();
    }
    if (one) {
        sequence = (uint64_t)atoll(one);
        one_sequence();
        return;
    }
    print_message("%d sequences: %d edits accepted, %d rejected; %d volumes, %d points, %d textures compared\n", count,
                  accepted, rejected, exact_models, points, textures);
    int made = 0;
    assert_true(verb_count <= (int)(sizeof by_verb / sizeof *by_verb));
    for (int v = 0; v < verb_count; v++) {
        print_message("%s %d%s", verbs[v].word, by_verb[v], v + 1 < verb_count ? ", " : " accepted in edits\n");
        made += by_verb[v] > 0;
    }
    assert_true(made >= MADE_VERBS || count < MANY_SEQUENCES);
    assert_true(accepted >= 3 * count / 2 && rejected >= count && exact_models >= 2 * count && points >= 10 * count &&
                textures >= 10 * count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_sequences_of_edits_give_the_described_solids)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
