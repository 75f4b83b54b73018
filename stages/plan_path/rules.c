/* rules.c - the films of a run: planned moves, and films of keys, whose moves are planned first.
 *
 * The rules of sample_validity are said here, since which moves need valid viewpoints is known only from the films. The
 * image effects of a move share its viewpoints; establishing moves show no subject. */
#include <string.h>

#include "common/base/textfile.h"
#include "common/film/taxonomy.h"
#include "common/graph/scene_rules.h"

static const char *keyframes_of(struct graph *g, const char *film)
{
    return graph_scene_file(g, graph_text(g, "keyframes/%s.txt", film));
}

static const char *film_folder(struct graph *g, const char *film) { return graph_text(g, "parallax/%s", film); }

static const char *move_of(struct graph *g, const char *effect)
{
    return graph_text(g, "%.*s", (int)strcspn(effect, "+"), effect);
}

static const char *subjects_of(struct graph *g, const char *effect)
{
    struct film_effect e;
    struct err unknown = ERR_INIT; /* the stage reports it */
    return !film_effect_parse(&e, effect, &unknown) && !film_move_subjects(e.move) ? NULL : PATH(g, SUBJECTS);
}

/* Adds the planned moves that a film of keys chains: its lines "move EFFECT ...". */
static void read_chained(struct graph *g, struct name_list *moves, const char *keyframes)
{
    struct textfile t = {0};
    struct err unread = ERR_INIT; /* the stage reports it */
    char *word;
    if (textfile_open(&t, keyframes, &unread)) return;
    while (!unread.status && textfile_next(&t))
        if (!textfile_word(&t, "a word", &word, &unread) && !strcmp(word, "move") &&
            !textfile_word(&t, "an effect", &word, &unread) &&
            !word[strspn(word, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_+-")])
            name_list_add(moves, word, strlen(word), graph_err(g));
    textfile_release(&t);
    name_list_sort(moves);
}

static void validity_rule(struct graph *g, const char *move)
{
    const char *subjects = subjects_of(g, move);
    graph_rule(g, "%s", move);
    rule_by(g, "sample_validity");
    rule_makes(g, PATH(g, VALIDITY, .move = move));
    rule_makes(g, PATH(g, VALIDITY_PICTURE, .move = move));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_takes_depth(g);
    rule_takes(g, "--subjects", subjects);
    rule_takes(g, "--film-views", PATH(g, FILM_VIEWS));
    rule_after(g, graph_own(g, "stamp/film_views.txt"));
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--effect", move);
    rule_option(g, "--out", FOLDER(g, VALIDITY, .move = move));
}

static void makes_film(struct graph *g, const char *film, bool is_goal)
{
    static const enum product_id files[] = {PRODUCT_PATH,        PRODUCT_PATH_CAMERAS, PRODUCT_PATH_IMAGES,
                                            PRODUCT_PATH_POINTS, PRODUCT_EFFECTS,      PRODUCT_TRANSFORMS,
                                            PRODUCT_BLENDER,     PRODUCT_FRAMES_MK};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        const char *path = graph_path(g, files[i], &(struct product_key){.film = film_folder(g, film)});
        rule_makes(g, path);
        if (is_goal) graph_goal(g, "path", path);
    }
}

static void move_rule(struct graph *g, const struct scene_facts *f, const char *effect)
{
    const char *move = move_of(g, effect), *subjects = subjects_of(g, effect),
               *validity = PATH(g, VALIDITY, .move = move);
    graph_rule(g, "%s", effect);
    makes_film(g, effect, name_list_has(&f->films, effect));
    rule_takes_cameras(g);
    rule_takes(g, "--validity", validity);
    rule_needs(g, PATH(g, VALIDITY_PICTURE, .move = move));
    rule_takes_depth(g);
    rule_takes(g, "--subjects", subjects);
    rule_takes(g, "--film-views", PATH(g, FILM_VIEWS));
    rule_after(g, graph_own(g, "stamp/film_views.txt"));
    rule_option(g, "--effect", effect);
    rule_option(g, "--out", graph_own(g, film_folder(g, effect)));
}

static void keyed_film_rule(struct graph *g, const char *film, const struct name_list *chained)
{
    const char *keyframes = keyframes_of(g, film);
    graph_rule(g, "%s", film);
    makes_film(g, film, true);
    rule_takes(g, "--keyframes", keyframes);
    for (int i = 0; i < chained->count; i++) {
        if (keyframes_of(g, chained->names[i]))
            graph_refuse(g, "%s chains %s, a film of keys: only planned moves can be chained.", keyframes,
                         chained->names[i]);
        rule_needs(g, PATH(g, PATH, .film = film_folder(g, chained->names[i])));
        rule_needs(g, PATH(g, EFFECTS, .film = film_folder(g, chained->names[i])));
    }
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--moves", graph_own(g, "parallax"));
    rule_option(g, "--effect", film);
    rule_option(g, "--out", graph_own(g, film_folder(g, film)));
}

static void given_film_rule(struct graph *g, const char *film)
{
    graph_rule(g, "%s", film);
    makes_film(g, film, true);
    rule_takes_cameras(g);
    rule_needs(g, graph_own(g, "stamp/cameras.txt")); /* as render_model/look.sh found them */
    rule_variable(g, "--cameras", "CAMERAS");
    rule_option(g, "--effect", film);
    rule_option(g, "--out", graph_own(g, film_folder(g, film)));
}

RULES(plan_path)
{
    struct name_list planned = {0}, moves = {0};
    graph_step(g, "path", STEP_ONE, *f->choose ? "depth film_views choice" : "depth film_views");
    graph_goal(g, "path", NULL);
    for (int i = 0; i < f->films.count; i++) {
        const char *film = f->films.names[i], *keyframes = keyframes_of(g, film);
        graph_list(g, GRAPH_SHOWN, PATH(g, PATH, .film = film_folder(g, film)));
        if (scene_film_is_given(film)) {
            given_film_rule(g, film);
            continue;
        }
        if (!keyframes) {
            name_list_add_words(&planned, film, graph_err(g));
            graph_goal(g, "path", PATH(g, VALIDITY, .move = move_of(g, film)));
            continue;
        }
        struct name_list chained = {0};
        read_chained(g, &chained, keyframes);
        keyed_film_rule(g, film, &chained);
        for (int k = 0; k < chained.count; k++) name_list_add_words(&planned, chained.names[k], graph_err(g));
        name_list_release(&chained);
    }
    name_list_sort(&planned);
    for (int i = 0; i < planned.count; i++) name_list_add_words(&moves, move_of(g, planned.names[i]), graph_err(g));
    name_list_sort(&moves);
    for (int i = 0; i < moves.count; i++) validity_rule(g, moves.names[i]);
    for (int i = 0; i < planned.count; i++) move_rule(g, f, planned.names[i]);
    name_list_release(&planned);
    name_list_release(&moves);
}
