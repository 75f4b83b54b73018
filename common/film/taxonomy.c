/* taxonomy.c - effects: names, legality, choice. shot.c has the rules of each move's cameras. */
#include "common/film/taxonomy.h"

#include <stdio.h>
#include <string.h>

#include "common/base/rng.h"
#include "common/base/scan.h"

static const struct {
    const char *name;
    int subjects;
} moves[MOVE_COUNT] = {
    [MOVE_ESTABLISHING_DOLLY] = {"establishing_dolly", 0},
    [MOVE_ESTABLISHING_DOLLY_OUT] = {"establishing_dolly_out", 0},
    [MOVE_DOLLY_IN] = {"dolly_in", 1},
    [MOVE_DOLLY_OUT] = {"dolly_out", 1},
    [MOVE_DOLLY_ZOOM] = {"dolly_zoom", 1},
    [MOVE_DOLLY_ZOOM_IN] = {"dolly_zoom_in", 1},
    [MOVE_DOLLY] = {"dolly", 2},
};
static const char *const focuses[FOCUS_COUNT] = {"", "narrow_dof", "widen_dof", "pull_focus"};
static const char *const tones[TONE_COUNT] = {"", "saturate", "desaturate", "brighten", "dim"};

struct scene_subjects film_scene_subjects(const struct subject_list *list)
{
    struct scene_subjects s = {list->count, 1};
    if (list->count < 2) return s;
    /* both depths in the first subject's view, since the second subject may come from another photo */
    const struct subject *first = &list->subjects[0];
    const struct vec3 right = vec3_sub(first->corner[1], first->corner[0]);
    const struct vec3 down = vec3_sub(first->corner[3], first->corner[0]);
    const struct vec3 forward = vec3_normalize(vec3_cross(right, down));
    const struct vec3 between = vec3_sub(subject_center(&list->subjects[1]), subject_center(first));
    const double a = first->depth, b = a + vec3_dot(forward, between);
    if (b > 0) s.depth_ratio = fmax(a, b) / fmin(a, b);
    return s;
}

int film_move_subjects(enum camera_move move) { return moves[move].subjects; }

void film_effect_name(const struct film_effect *e, char name[EFFECT_NAME_SIZE])
{
    snprintf(name, EFFECT_NAME_SIZE, "%s%s%s%s%s", moves[e->move].name, e->focus ? "+" : "", focuses[e->focus],
             e->tone ? "+" : "", tones[e->tone]);
}

static const char *next_move(const void *ctx, int i)
{
    (void)ctx;
    return i < MOVE_COUNT ? moves[i].name : NULL;
}

static const char *next_image_effect(const void *ctx, int i)
{
    (void)ctx;
    return i < FOCUS_COUNT - 1 ? focuses[i + 1] : i < FOCUS_COUNT + TONE_COUNT - 2 ? tones[i - FOCUS_COUNT + 2] : NULL;
}

static enum status unknown(const char *what, const char *word, const char *whole,
                           const char *(*next)(const void *, int), struct err *err)
{
    char quoted[SCAN_QUOTED], list[512] = "";
    const char *nearest = scan_nearest(word, next, NULL), *known;
    for (int i = 0; (known = next(NULL, i)); i++)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", i ? ", " : "", known);
    if (nearest)
        return err_set(err, ST_USAGE, "%s is not a known %s; did you mean %s? Known: %s.", scan_quote(quoted, word),
                       what, nearest, list);
    return err_set(err, ST_USAGE, "%s is not a known %s (in \"%.80s\"). Known: %s.", scan_quote(quoted, word), what,
                   whole, list);
}

enum status film_effect_parse(struct film_effect *e, const char *name, struct err *err)
{
    char word[EFFECT_NAME_SIZE];
    const char *at = name;
    bool known = false;

    *e = (struct film_effect){0};
    for (int part = 0; part == 0 || *at == '+'; part++) {
        if (part) at++;
        const size_t length = strcspn(at, "+");
        snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), at);
        at += length;
        known = false;
        for (int i = 0; !part && i < MOVE_COUNT && !known; i++)
            if ((known = !strcmp(word, moves[i].name))) e->move = (enum camera_move)i;
        if (!part && !known) return unknown("move", word, name, next_move, err);
        for (int i = 1; part && i < FOCUS_COUNT && !known && !e->focus && !e->tone; i++)
            if ((known = !strcmp(word, focuses[i]))) e->focus = (enum focus_effect)i;
        for (int i = 1; part && i < TONE_COUNT && !known && !e->tone; i++)
            if ((known = !strcmp(word, tones[i]))) e->tone = (enum tone_effect)i;
        if (!known) {
            for (int i = 0; next_image_effect(NULL, i); i++)
                if (!strcmp(word, next_image_effect(NULL, i)))
                    return err_set(
                        err, ST_USAGE,
                        "\"%.80s\": wanted MOVE, MOVE+FOCUS, MOVE+TONE or MOVE+FOCUS+TONE, each part once and "
                        "in this order.",
                        name);
            return unknown("image effect", word, name, next_image_effect, err);
        }
    }
    return ST_OK;
}

enum status film_effect_check(const struct film_effect *e, const struct scene_subjects *scene, struct err *err)
{
    char name[EFFECT_NAME_SIZE];
    const int subjects = film_move_subjects(e->move);
    film_effect_name(e, name);
    if (scene->count < subjects)
        return err_set(err, ST_USAGE,
                       "%s needs %d subject%s, and the scene has %d. Add %s to the scene's subjects.txt, or choose a "
                       "move for %d.",
                       name, subjects, subjects > 1 ? "s" : "", scene->count, subjects > 1 ? "them" : "it",
                       scene->count);
    if (subjects == 0 && (e->focus || e->tone))
        return err_set(err, ST_USAGE, "%s: a move without a subject takes no image effect.", name);
    if (subjects == 1 && e->focus == FOCUS_PULL)
        return err_set(err, ST_USAGE, "%s: pulling focus needs two subjects; only dolly has two.", name);
    if (subjects == 2 && e->tone)
        return err_set(err, ST_USAGE,
                       "%s: saturation and brightness effects suit moves with one subject, not with two.", name);
    if (subjects == 2 && e->focus && scene->depth_ratio < DOF_DEPTH_RATIO)
        return err_set(err, ST_USAGE,
                       "%s: the subjects' depths differ by a factor of %.3g; focus effects need at least %g.", name,
                       scene->depth_ratio, DOF_DEPTH_RATIO);
    return ST_OK;
}

int film_effects_list(struct film_effect list[MAX_FILM_EFFECTS], const struct scene_subjects *scene)
{
    int count = 0;
    for (int m = 0; m < MOVE_COUNT; m++)
        for (int i = 0; i < FOCUS_COUNT + TONE_COUNT - 1; i++) {
            const struct film_effect e = {(enum camera_move)m, i < FOCUS_COUNT ? (enum focus_effect)i : FOCUS_ALL,
                                          i < FOCUS_COUNT ? TONE_NONE : (enum tone_effect)(i - FOCUS_COUNT + 1)};
            struct err none = ERR_INIT;
            if (!film_effect_check(&e, scene, &none)) list[count++] = e;
        }
    return count;
}

struct film_effect film_effect_draw(const struct scene_subjects *scene, uint64_t seed)
{
    struct film_effect list[MAX_FILM_EFFECTS], row[MAX_FILM_EFFECTS];
    const struct rng rng = rng_make(seed, "choose_effects", "");
    const int all = film_effects_list(list, scene), wanted = scene->count < 2 ? scene->count : 2;
    int count = 0;
    for (int i = 0; i < all; i++)
        if (film_move_subjects(list[i].move) == wanted && !list[i].tone) row[count++] = list[i];
    return row[(int)(rng_uniform(&rng, 0, 0) * count)];
}
