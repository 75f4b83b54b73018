/* plan_lights.c - statements about lamps and about synthetic objects. What they say is kept by name: the last statement
 * about a lamp or an object counts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/light/object_list.h"
#include "stages/build_model/plan/plan_internal.h"
#include "stages/build_model/script/script_words.h"

void plan_lights_release(struct plan *plan)
{
    for (int i = 0; i < plan->lamp_count; i++) {
        free(plan->lamps[i].name);
        free(plan->lamps[i].file);
    }
    for (int i = 0; i < plan->object_count; i++) {
        free(plan->objects[i].name);
        free(plan->objects[i].path);
        free(plan->objects[i].file);
    }
    free(plan->lamps);
    free(plan->objects);
}

static enum status read_three(struct script_reader *r, const char *what, double to[3])
{
    for (int k = 0; k < 3; k++)
        if (script_read_number(r, what, &to[k])) return r->err->status;
    return ST_OK;
}

static bool is_web_file(const char *word) { return strlen(word) <= 255 && scan_is_file_name(word, ".ies"); }

/* FILE.ies at X Y Z, and options. */
static enum status read_planned(struct script_reader *r, struct statement *s)
{
    struct script_lamp *l = &s->lamp;
    bool had[3] = {false, false, false};
    char *word;
    *l = (struct script_lamp){{0, 0, 0}, {0, 0, -1}, 0, {1, 1, 1}};
    if (!scan_is_name(s->name))
        return textfile_error(&r->t, r->err, s->name,
                              "a name of letters, digits, _ and -, which does not begin with -");
    if (textfile_word(&r->t, "an IES file, FILE.ies", &word, r->err)) return r->err->status;
    if (!is_web_file(word))
        return textfile_error(&r->t, r->err, word,
                              "an IES file in the scene's folder, FILE.ies, of letters, digits and _-.@+");
    s->mesh = script_keep_word(r, word);
    if (script_expect(r, "at") || read_three(r, "a coordinate", l->at)) return r->err->status;
    while (textfile_more(&r->t)) {
        static const char *const options[] = {"aim", "turn", "colour"};
        int k = 0;
        if (textfile_word(&r->t, "an option", &word, r->err)) return r->err->status;
        while (k < 3 && strcmp(word, options[k]) != 0) k++;
        if (k == 3 || had[k])
            return textfile_error(&r->t, r->err, word, "aim DX DY DZ, turn DEGREES or colour R G B, each once");
        had[k] = true;
        if (k == 1 ? script_read_number(r, "an angle in degrees", &l->turn)
                   : read_three(r, k ? "a share of the light's colour" : "a direction", k ? l->colour : l->aim))
            return r->err->status;
    }
    if (!(fabs(l->aim[0]) + fabs(l->aim[1]) + fabs(l->aim[2]) > 0))
        return textfile_error(&r->t, r->err, "aim 0 0 0", "a direction, such as 0 0 -1 for straight down");
    for (int c = 0; c < 3; c++)
        if (!(l->colour[c] >= 0)) return textfile_wrong_number(&r->t, l->colour[c], "a colour of 0 or more", r->err);
    if (!(l->colour[0] + l->colour[1] + l->colour[2] > 0))
        return textfile_error(&r->t, r->err, "the colour 0 0 0", "a number above 0 in it");
    return ST_OK;
}

/* Lamps have the names of lights.txt: any word. */
enum status plan_read_lamp(struct script_reader *r, struct statement *s)
{
    enum { MAX_LAMP_NAME = 255 };
    char *word;
    if (textfile_word(&r->t, "the name of a lamp", &word, r->err)) return r->err->status;
    if (!word[0] || strlen(word) > MAX_LAMP_NAME || strchr(word, '\r'))
        return textfile_error(&r->t, r->err, word, "the name of a lamp of lights.txt");
    s->name = script_keep_word(r, word);
    s->value_count = 3;
    if (!textfile_more(&r->t)) return script_usage_error(r, NULL);
    if (textfile_word(&r->t, "off, scale or ies", &word, r->err)) return r->err->status;
    if (!strcmp(word, "off")) return ST_OK;
    if (!strcmp(word, "ies")) return read_planned(r, s);
    if (strcmp(word, "scale")) return script_usage_error(r, word);
    for (int c = 0; c < 3; c++) {
        if (script_read_number(r, "a factor of 0 or more", &s->values[c])) return r->err->status;
        if (s->values[c] < 0) return textfile_wrong_number(&r->t, s->values[c], "a factor of 0 or more", r->err);
    }
    return ST_OK;
}

/* A planned lamp is on where it is put; one that is there moves. */
static enum status place_lamp(struct plan_context *c, struct plan_lamp *l)
{
    const double *at = c->s->lamp.at;
    for (int k = 0; k < 3; k++)
        if (!(fabs(at[k]) <= MAX_SIZE))
            return plan_statement_error(c, "the lamp %s is at %.9g %.9g %.9g, wanted it within %g of the origin.",
                                        c->s->name, at[0], at[1], at[2], MAX_SIZE);
    free(l->file);
    l->file = strdup(c->s->mesh);
    if (!l->file) return err_nomem(c->err, "a lamp", strlen(c->s->mesh) + 1);
    l->line = c->s->line;
    l->placed = c->s->lamp;
    for (int k = 0; k < 3; k++) l->scale[k] = 1;
    return ST_OK;
}

/* off, scale, ies */
enum status plan_apply_lamp(struct plan_context *c)
{
    struct plan *p = c->plan;
    int i = 0;
    while (i < p->lamp_count && strcmp(p->lamps[i].name, c->s->name)) i++;
    if (i == p->lamp_count) {
        if (array_append(&p->lamps, (size_t)i, sizeof *p->lamps, "lamps", c->err)) return c->err->status;
        p->lamps[i] = (struct plan_lamp){.name = strdup(c->s->name)};
        if (!p->lamps[i].name) return err_nomem(c->err, "a lamp", strlen(c->s->name) + 1);
        p->lamp_count++;
    }
    if (c->s->mesh) {
        if (!p->lamps[i].file && p->lamps[i].line)
            return plan_statement_error(c,
                                        "the lamp %s is one of lights.txt, which a statement above changes; give the "
                                        "planned lamp another name.",
                                        c->s->name);
        return place_lamp(c, &p->lamps[i]);
    }
    if (!p->lamps[i].file) p->lamps[i].line = c->s->line;
    memcpy(p->lamps[i].scale, c->s->values, sizeof p->lamps[i].scale);
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- objects */

/* One factor, or one for each axis. */
static enum status read_scale(struct script_reader *r, double scale[3])
{
    for (int k = 0; k < 3; k++) {
        const char *next = script_next_word(r);
        if (k == 1 && (!*next || !strchr("+-.0123456789", *next))) {
            scale[1] = scale[2] = scale[0];
            return ST_OK;
        }
        if (script_read_number(r, "a scale", &scale[k])) return r->err->status;
        if (!(scale[k] >= 1e-6)) return textfile_wrong_number(&r->t, scale[k], "a scale from 1e-6 to 1e6", r->err);
    }
    return ST_OK;
}

static enum status read_mesh_file(struct script_reader *r, const char **file)
{
    char *word;
    if (textfile_word(&r->t, "a mesh, FILE.obj", &word, r->err)) return r->err->status;
    if (!object_file_is_valid(word))
        return textfile_error(&r->t, r->err, word,
                              "a mesh in the scene's folder, FILE.obj or FOLDER/FILE.obj, of letters, digits, _, - and "
                              ".");
    *file = script_keep_word(r, word);
    return ST_OK;
}

enum status plan_read_object(struct script_reader *r, struct statement *s)
{
    struct script_object *o = &s->object;
    bool turned = false, scaled = false;
    for (int k = 0; k < 3; k++) o->scale[k] = 1;
    if (script_read_name(r, "a name", &s->name) || read_mesh_file(r, &s->mesh) || script_expect(r, "at") ||
        script_read_number(r, "X", &o->at[0]) || script_read_number(r, "Y", &o->at[1]) ||
        script_read_number(r, "Z", &o->at[2]))
        return r->err->status;
    while (script_next_is(r, "turn") || script_next_is(r, "scale")) {
        const bool turn = script_next_is(r, "turn");
        bool *had = turn ? &turned : &scaled;
        if (script_expect(r, turn ? "turn" : "scale")) return r->err->status;
        if (*had) return textfile_error(&r->t, r->err, turn ? "turn" : "scale", "each option once");
        *had = true;
        if (turn ? script_read_number(r, "an angle in degrees", &o->turn) : read_scale(r, o->scale))
            return r->err->status;
    }
    if (!textfile_more(&r->t)) return script_usage_error(r, NULL);
    if (script_next_is(r, "matt") || script_next_is(r, "phong") || script_next_is(r, "ward"))
        return gloss_read_brdf(&o->brdf, &r->t, r->err);
    char *word;
    return textfile_word(&r->t, "a material", &word, r->err) ? r->err->status : script_usage_error(r, word);
}

/* The object of a name, removed or not; NULL: there was never one. */
static struct plan_object *find_object(const struct plan *p, const char *name)
{
    for (int i = 0; i < p->object_count; i++)
        if (!strcmp(p->objects[i].name, name)) return &p->objects[i];
    return NULL;
}

static enum status check_size(struct plan_context *c)
{
    for (int k = 0; k < 3; k++)
        if (!(fabs(c->s->object.at[k]) <= MAX_SIZE))
            return plan_statement_error(c, "the object %s is at %.9g %.9g %.9g, wanted it within %g of the origin.",
                                        c->s->name, c->s->object.at[0], c->s->object.at[1], c->s->object.at[2],
                                        MAX_SIZE);
    return ST_OK;
}

enum status plan_apply_object(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_object *o = find_object(p, s->name);
    if (check_size(c)) return c->err->status;
    if (!o) {
        if (array_append(&p->objects, (size_t)p->object_count, sizeof *p->objects, "objects", c->err))
            return c->err->status;
        o = &p->objects[p->object_count++];
        *o = (struct plan_object){.name = strdup(s->name)};
    }
    free(o->path);
    free(o->file);
    o->path = strdup(c->path);
    o->file = strdup(s->mesh);
    o->line = s->line;
    o->removed = false;
    o->placed = s->object;
    return o->name && o->path && o->file ? ST_OK : err_nomem(c->err, "an object", strlen(c->path) + strlen(s->mesh));
}

static const char *nth_object(const void *ctx, int i)
{
    const struct plan *p = ctx;
    return i < p->object_count ? p->objects[i].name : NULL;
}

enum status plan_remove_object(struct plan_context *c)
{
    struct plan_object *o = find_object(c->plan, c->s->name);
    if (!o) {
        const char *near = scan_nearest(c->s->name, nth_object, c->plan);
        if (near) return plan_statement_error(c, "no object is named %s; did you mean %s?", c->s->name, near);
        return plan_statement_error(
            c, "no object is named %s; objects.txt or the edit that this one stands on must place it.", c->s->name);
    }
    if (o->removed) return plan_statement_error(c, "the object %s was removed already.", c->s->name);
    o->removed = true;
    return ST_OK;
}
