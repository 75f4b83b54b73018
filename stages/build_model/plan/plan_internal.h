/* plan_internal.h - what the files that make a plan share; everything else includes plan.h. What each statement does is
 * declared by its row (verbs.h). */
#ifndef REMODEL_BUILD_MODEL_PLAN_INTERNAL_H
#define REMODEL_BUILD_MODEL_PLAN_INTERNAL_H

#include "stages/build_model/place/place_line.h"
#include "stages/build_model/plan/plan.h"
#include "stages/build_model/script/verbs.h"

#define LENGTH_EPS    1e-6   /* lengths are equal within this, model units */
#define PARALLEL_SINE 0.0872 /* of 5 degrees: walls closer to parallel cannot be joined */
#define MIN_SIZE      0.001  /* of anything in a plan, model units */
#define MAX_SIZE      1000.0

enum plan_default {
    DEFAULT_THICKNESS,
    DEFAULT_SLAB,
    DEFAULT_GLASS,
    DEFAULT_LEAF,
    DEFAULT_FLOOR,
    DEFAULT_CEILING,
    DEFAULTS
};

struct plan_context { /* of the statement that is being applied */
    struct plan *plan;
    const char *path;
    const struct statement *s;
    const struct placer *placer;
    struct err *err;
    bool edit;          /* the statement is one of an edit */
    unsigned used, set; /* bits of the defaults that the statement used, and set */
};

/* plan_context.c */

/* Sets ST_DATA with the statement's file and line before the text. */
enum status plan_statement_error(struct plan_context *c, const char *fmt, ...) PRINTF_LIKE(2, 3);

/* ST_DATA: `what`, a statement, is for edits alone. */
enum status plan_statement_for_edits(struct plan_context *c, const char *what);

/* plan_names.c */

/* Looks up a name. ST_DATA: it is unknown, removed, or its kind is not in `kinds` (bits of enum name_kind); `wanted`
 * is the message's words for those kinds. */
enum status plan_find_named(struct plan_context *c, const char *name, unsigned kinds, const char *wanted,
                            enum name_kind *kind, int *at);
enum status plan_find_solid(struct plan_context *c, const char *name, enum name_kind *kind, int *at);
enum status plan_find_wall(struct plan_context *c, const char *name, int *wall);
enum status plan_find_room(struct plan_context *c, const char *name, int *room);

/* Whether the name is that of a thing; *at: its index. */
bool plan_is_thing(const struct plan *plan, const char *name, int *at);

/* *copy: the name, for the caller to own. ST_DATA: it was used before. */
enum status plan_copy_new_name(struct plan_context *c, const char *name, char **copy);

/* Enters the name, which the plan's item must keep alive, into the plan's hash table. */
enum status plan_add_name(struct plan *plan, const char *name, enum name_kind kind, int at, struct err *err);

/* plan_statements.c */

/* Where set stores a default; *name: its word. */
double *plan_default_value(struct plan *plan, enum plan_default which, const char **name);
/* The default value, which the statement uses. */
double plan_use_default(struct plan_context *c, enum plan_default which);
/* The option's value, or the default's. */
double plan_option_or_default(struct plan_context *c, enum option option, enum plan_default which);
enum status plan_check_length(struct plan_context *c, const char *what, double value);

/* plan_walls.c */

/* The line of a wall by the statement's two pixels where it meets the floor or the ceiling, at height z; its start is
 * at the left for the camera. along: its direction, NULL: the nearest axis; is_free: that of the pixels. Logs how far
 * it is off. ST_DATA: too far. */
enum status plan_place_line(struct plan_context *c, const char *wall, double z, const double along[2], bool is_free,
                            struct placed_line *line);

/* plan_openings.c */

/* The statement's rectangle on a wall as S and z, ascending. */
enum status plan_place_on_wall(struct plan_context *c, int wall, double s[2], double z[2]);
/* Doors and passages drawn in a photograph begin at the floor, whichever pixel was clicked. */
void plan_set_foot_on_floor(const struct plan_context *c, const struct plan_wall *w, enum opening_kind kind,
                            double z[2]);
/* A box's footprint. at: height of the corners that a photograph shows. */
enum status plan_place_footprint(struct plan_context *c, double at, double low[2], double high[2]);
/* The footprint of an opening in a room's ceiling or floor. */
enum status plan_place_in_room(struct plan_context *c, const struct plan_room *r, enum opening_kind kind, double low[2],
                               double high[2]);
/* *thickness: the default one of a leaf or glass; 0 if nothing or a wall fills the opening. ST_DATA: it is unknown. */
enum status plan_fill_thickness(struct plan_context *c, enum filling fill, double *thickness);

/* plan_textures.c */
void plan_wishes_release(struct plan *plan);

/* plan_things.c */

/* What move, copy, clear and keep mean for a thing. */
enum status plan_read_thing_copy(struct script_reader *r, struct statement *s);
enum status plan_apply_thing_move(struct plan_context *c, int thing);
enum status plan_apply_thing_copy(struct plan_context *c);
enum status plan_apply_thing_clear(struct plan_context *c, int thing, bool keep);
void plan_things_release(struct plan *plan);

/* plan_lights.c */

enum status plan_remove_object(struct plan_context *c);
void plan_lights_release(struct plan *plan);

/* plan_state.c */

/* *state: a text that differs whenever anything differs in the plan that a statement can change, except the defaults;
 * the caller frees it. ST_NOMEM. */
enum status plan_state(char **state, const struct plan *plan, struct err *err);

/* plan_geometry.c */

/* S of the point's projection onto the wall's line. */
double plan_wall_s(const struct plan_wall *w, const double p[2]);

/* Both in faces lie on one line and face the same way. */
bool plan_walls_on_one_line(const struct plan_wall *a, const struct plan_wall *b);

/* The near or far face of `other`, seen by wall w whose end `end` runs up to it; n points onwards, away from w. */
struct plan_line plan_face_ahead(const struct plan_wall *w, int end, const struct plan_wall *other, bool far,
                                 int *side);

/* The min and max S at which a line crosses the wall's two faces. */
void plan_cut_range(const struct plan_wall *w, struct plan_line across, double range[2]);

/* plan_checks.c */

/* Derives the rooms' edges and checks the whole plan. line: of the statement of an edit, to blame for any error; 0:
 * errors name the line that made the faulty item. */
enum status plan_check(struct plan *plan, const char *path, int line, struct err *err);

#endif
