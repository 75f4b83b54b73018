/* sequence_identity.h - whether the faces of an edited model keep the names and ids of the unedited one; for
 * sequences.c.
 */
#ifndef REMODEL_TESTS_SEQUENCE_IDENTITY_H
#define REMODEL_TESTS_SEQUENCE_IDENTITY_H

#include "tests/unit/build_model/sequence_model.h"

enum { MAX_TOUCHED = 512 };

struct touched {
    char names[MAX_TOUCHED][NAME_SIZE];
    int count;
    char beside[MAX_TOUCHED][NAME_SIZE]; /* rooms and walls at a touched wall, whose common border may have moved */
    int beside_count;
};

static inline void keep_name(char names[MAX_TOUCHED][NAME_SIZE], int *count, const char *name)
{
    assert_true(*count < MAX_TOUCHED);
    snprintf(names[(*count)++], NAME_SIZE, "%s", name);
}

static inline void touch_wall(struct touched *touched, const struct expected *t, int wall)
{
    for (int i = 0; i < t->hole_count; i++)
        if (t->holes[i].wall == wall) keep_name(touched->names, &touched->count, t->holes[i].name);
    for (int i = 0; i < t->room_count; i++)
        for (int k = 0; k < t->rooms[i].wall_count; k++)
            if (t->rooms[i].walls[k] == wall) keep_name(touched->beside, &touched->beside_count, t->rooms[i].name);
    for (int i = 0; i < t->wall_count; i++)
        for (int e = 0; e < 2; e++)
            if (t->walls[i].ends[e].kind != MODEL_FREE && t->walls[i].ends[e].other == wall)
                keep_name(touched->beside, &touched->beside_count, t->walls[i].name);
}

/* Records all names in the line, the openings of its walls, which move with them, and the things beside these. */
static inline void touch_line(struct touched *touched, const struct expected *t, const char *line)
{
    char text[LINE], *rest = text;
    snprintf(text, sizeof text, "%s", line);
    for (char *word; (word = strtok_r(rest, " \n", &rest));) {
        const int wall = expected_wall(t, word);
        if (wall < 0 && expected_hole(t, word) < 0 && expected_box(t, word) < 0 && expected_room(t, word) < 0 &&
            expected_slot(t, word) < 0)
            continue;
        keep_name(touched->names, &touched->count, word);
        if (wall >= 0) touch_wall(touched, t, wall);
    }
}

static inline bool is_among(const char (*names)[NAME_SIZE], int count, const char *face)
{
    const char *from = strchr(face, '/') + 1;
    const size_t length = strcspn(from, "/");
    for (int i = 0; i < count; i++)
        if (strlen(names[i]) == length && !strncmp(names[i], from, length)) return true;
    return false;
}

static inline bool merges(const struct unite_log *log, const char *name, const char *into)
{
    bool found = !strcmp(name, into);
    for (int i = 0; i < log->count && !found; i++)
        found = log->notes[i].event == UNITE_MERGED && !strcmp(log->notes[i].name, name) &&
                !strcmp(log->notes[i].into, into);
    return found;
}

/* Whether a surface may be named `a` in model m and `b` in model n. */
static inline bool same_surface(const struct model *m, const char *a, const struct model *n, const char *b)
{
    if (merges(&m->log, b, a) || merges(&n->log, a, b)) return true;
    for (int i = 0; i < m->log.count; i++)
        if (m->log.notes[i].event == UNITE_MERGED && !strcmp(m->log.notes[i].into, a) &&
            merges(&n->log, m->log.notes[i].name, b))
            return true;
    return false;
}

/* Whether the face's name, or one merged into it, belongs to something beside a touched wall. */
static inline bool is_beside(const struct touched *t, const struct unite_log *log, const char *face)
{
    bool found = is_among(t->beside, t->beside_count, face);
    for (int i = 0; i < log->count && !found; i++)
        found = merges(log, log->notes[i].name, face) && is_among(t->beside, t->beside_count, log->notes[i].name);
    return found;
}

static inline bool may_differ(const struct touched *t, const struct model *m, const char *a, const struct model *n,
                              const char *b)
{
    return is_among(t->names, t->count, a) || is_among(t->names, t->count, b) || same_surface(m, a, n, b) ||
           (is_beside(t, &m->log, a) && is_beside(t, &n->log, b));
}

#endif
