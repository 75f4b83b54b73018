/* textured.h - makes edited models with the rules of their textures from scripts in a test's source. */
#ifndef REMODEL_TESTS_TEXTURED_H
#define REMODEL_TESTS_TEXTURED_H

#include "stages/build_model/solid/unite.h"
#include "stages/build_model/texture/texture_rules.h"
#include "tests/unit/build_model/scripted.h"

struct made { /* an edit of a script, with its rules */
    struct plan base_plan, plan;
    struct solid_list solids[2];
    struct solid_mesh base, edited;
    struct texture_map map;
};

/* Rules that are refused are an error of the last step. */
static inline enum status try_make(struct made *m, const char *text, const char *edit, struct err *refusal)
{
    struct err err = ERR_INIT;
    char whole[4096];
    *m = (struct made){0};
    snprintf(whole, sizeof whole, "remodel-script 1\n%s", edit);
    build(&m->base_plan, &m->solids[0], text, NULL);
    build(&m->plan, &m->solids[1], text, whole);
    assert_ok(unite_solids(&m->base, &m->solids[0], NULL, &err), err);
    assert_ok(unite_solids(&m->edited, &m->solids[1], NULL, &err), err);
    assert_ok(solid_mesh_carry_ids(&m->edited, &m->base, &err), err);
    return texture_rules_make(&m->map, &m->edited, &m->base, &m->plan, refusal);
}

static inline void make(struct made *m, const char *text, const char *edit)
{
    struct err err = ERR_INIT;
    assert_ok(try_make(m, text, edit, &err), err);
}

static inline void release(struct made *m)
{
    texture_map_release(&m->map);
    solid_mesh_release(&m->base);
    solid_mesh_release(&m->edited);
    drop(&m->base_plan, &m->solids[0]);
    drop(&m->plan, &m->solids[1]);
}

static inline const struct texture_face *face_of(const struct made *m, const char *name, struct vec3 p)
{
    for (int i = 0; i < m->map.face_count; i++)
        if (!strcmp(m->map.faces[i].name, name)) return texture_map_find(&m->map, m->map.faces[i].id, p);
    fail_msg("there is no face %s", name);
    return NULL;
}

/* That the unedited model refuses each statement after a room. */
static inline void only_for_edits(const char *room, const char *const *statements, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char whole[1024];
        snprintf(whole, sizeof whole, "%s%s\n", room, statements[i]);
        refused(whole, NULL, "is for edits: the unedited model shows the photographs");
    }
}

#endif
