/* scripted.h - makes plans and solids from scripts in a test's source. */
#ifndef REMODEL_TESTS_SCRIPTED_H
#define REMODEL_TESTS_SCRIPTED_H

#include "stages/build_model/layout/layout.h"
#include "tests/unit/scratch.h"

/* A room of 4 x 3 whose faces are at x 0 and 4, y 0 and 3; walls 0.2 thick, 2.5 high. */
#define ROOM                                                                              \
    "remodel-script 1\nset thickness 0.2\nset ceiling 2.5\n"                              \
    "wall south from 4 0 to 0 0\nwall west from 0 0 to 0 3\nwall north from 0 3 to 4 3\n" \
    "wall east from 4 3 to 4 0\njoin south west north east south\nroom hall south west north east\n"

/* The same with a wall between two rooms. */
#define TWO                                                                                                      \
    ROOM "wall middle from 2 1 to 2 2 thickness 0.1\nextend middle start to south\nextend middle end to north\n" \
         "remove hall\nroom left south west north middle\nroom right middle north east south\n"

static inline enum status scripted(struct plan *plan, const char *text, const char *edit, struct err *err)
{
    struct script script = {0};
    plan_begin(plan, NULL);
    enum status st = script_read(&script, scratch_write("model.txt", text), err);
    if (!st) st = plan_apply(plan, &script, false, NULL, err);
    script_release(&script);
    if (!st && edit) st = script_read(&script, scratch_write("edit.txt", edit), err);
    if (!st && edit) st = plan_apply(plan, &script, true, NULL, err);
    script_release(&script);
    return st;
}

/* The solids of a script with an edit (or NULL). */
static inline void build(struct plan *plan, struct solid_list *list, const char *text, const char *edit)
{
    struct err err = ERR_INIT;
    assert_ok(scripted(plan, text, edit, &err), err);
    assert_ok(layout_solids(list, plan, &err), err);
}

static inline void drop(struct plan *plan, struct solid_list *list)
{
    solid_list_release(list);
    plan_release(plan);
}

/* The number of a body's solids that contain a point. */
static inline int inside(const struct solid_list *list, const char *body, double x, double y, double z)
{
    int n = 0;
    for (int i = 0; i < list->count; i++) {
        const struct solid *s = &list->solids[i];
        bool in = !strcmp(s->body, body);
        for (int k = 0; k < s->count && in; k++)
            in = vec3_dot(s->half_spaces[k].normal, vec3_make(x, y, z)) < s->half_spaces[k].offset;
        n += in;
    }
    return n;
}

/* The face on which a point lies: just behind the point there is matter, just in front there is none. The name is that
 * of the first solid bounded there; "" for none. */
static inline const char *face_at(const struct solid_list *list, double x, double y, double z)
{
    for (int i = 0; i < list->count; i++) {
        const struct solid *s = &list->solids[i];
        for (int k = 0; k < s->count; k++) {
            const struct half_space *h = &s->half_spaces[k];
            const double length = vec3_length(h->normal);
            if (fabs(vec3_dot(h->normal, vec3_make(x, y, z)) - h->offset) > 1e-6 * length) continue;
            bool in = true;
            for (int j = 0; j < s->count && in; j++)
                in = j == k || vec3_dot(s->half_spaces[j].normal, vec3_make(x, y, z)) < s->half_spaces[j].offset - 1e-9;
            const double e = 1e-4 / length;
            if (in && !inside(list, s->body, x + e * h->normal.x, y + e * h->normal.y, z + e * h->normal.z))
                return h->name;
        }
    }
    return "";
}

static inline void refused(const char *text, const char *edit, const char *words)
{
    struct plan plan;
    struct err err = ERR_INIT;
    assert_int_not_equal(scripted(&plan, text, edit, &err), ST_OK);
    assert_err(err, ST_DATA, words);
    plan_release(&plan);
}

#endif
