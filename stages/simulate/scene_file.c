/* scene_file.c - see scene_file.h. Each kind of line has its own function. */
#include "stages/simulate/scene_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "stages/simulate/description.h"
#include "stages/simulate/mesh_file.h"

#define MIN_METRES    1e-6
#define MAX_RADIANCE  1e9
#define MAX_LINES     100000
#define PERPENDICULAR 1e-6 /* largest cosine that counts as a right angle */

struct reader {
    struct scene *scene;
    struct textfile file;
    const char *folder;
    struct provenance *prov;
};

/* ------------------------------------------------------------------------------------------------------------ words */

/* Two numbers, the second larger than the first. */
static enum status read_range(struct reader *r, const char *what, double *from, double *to, struct err *err)
{
    enum status st = description_number(&r->file, what, -MAX_METRES, MAX_METRES, from, err);
    if (!st) st = description_number(&r->file, what, *from + MIN_METRES, MAX_METRES, to, err);
    return st;
}

static enum status read_colour(struct reader *r, const char *what, double max, struct rgb *c, struct err *err)
{
    enum status st = description_number(&r->file, what, 0, max, &c->r, err);
    if (!st) st = description_number(&r->file, what, 0, max, &c->g, err);
    if (!st) st = description_number(&r->file, what, 0, max, &c->b, err);
    return st;
}

static enum status read_seed(struct reader *r, uint32_t *value, struct err *err)
{
    int64_t n = 0;
    enum status st = textfile_int(&r->file, "a seed", 0, UINT32_MAX, &n, err);
    *value = (uint32_t)n;
    return st;
}

/* One of `words`; *index is its position among them. */
static enum status read_choice(struct reader *r, const char *const *words, int count, const char *what, int *index,
                               struct err *err)
{
    char *word = NULL, choices[300] = "";
    enum status st = textfile_word(&r->file, what, &word, err);
    if (st) return st;
    for (int i = 0; i < count; i++) {
        if (!strcmp(word, words[i])) {
            *index = i;
            return ST_OK;
        }
        const size_t used = strlen(choices);
        snprintf(choices + used, sizeof choices - used, "%s%s", i ? ", " : "", words[i]);
    }
    return textfile_error(&r->file, err, word, "%s: one of %s", what, choices);
}

static enum status name_taken(struct reader *r, const char *name, const char *what, struct err *err)
{
    return textfile_error(&r->file, err, name, "a name that no other %s of the scene has", what);
}

static enum status name_unknown(struct reader *r, const char *found, const char *what,
                                const char *(*next)(const void *ctx, int i), struct err *err)
{
    const char *near = scan_nearest(found, next, r->scene);
    if (near) return textfile_error(&r->file, err, found, "the name of a %s above; did you mean %s", what, near);
    return textfile_error(&r->file, err, found, "the name of a %s above", what);
}

static const char *next_texture(const void *ctx, int i)
{
    const struct scene *s = ctx;
    return i < s->texture_count ? s->textures[i].name : NULL;
}

static const char *next_material(const void *ctx, int i)
{
    const struct scene *s = ctx;
    return i < s->material_count ? s->materials[i].name : NULL;
}

static const char *next_item(const void *ctx, int i)
{
    const struct scene *s = ctx;
    return i < s->item_count ? s->items[i].name : NULL;
}

static int find_name(const struct scene *s, const char *name, const char *(*next)(const void *ctx, int i))
{
    const char *other;
    for (int i = 0; (other = next(s, i)); i++)
        if (!strcmp(name, other)) return i;
    return -1;
}

static enum status read_known_name(struct reader *r, const char *what, const char *(*next)(const void *ctx, int i),
                                   int *index, struct err *err)
{
    char *word = NULL, wanted[80];
    snprintf(wanted, sizeof wanted, "the name of a %s", what);
    enum status st = textfile_word(&r->file, wanted, &word, err);
    if (!st && (*index = find_name(r->scene, word, next)) < 0) st = name_unknown(r, word, what, next, err);
    return st;
}

/* ---------------------------------------------------------------------------------------------- textures, materials */

static const char *const texture_words[TEXTURE_KINDS] = {"rgb",     "checker", "wood", "brick",
                                                         "plaster", "print",   "books"};

static enum status read_size(struct reader *r, const char *what, double *value, struct err *err)
{
    return description_number(&r->file, what, 1e-4, 1e4, value, err);
}

static enum status read_texture(struct reader *r, struct err *err)
{
    struct scene *s = r->scene;
    struct scene_texture made = {0};
    struct texture *t = &made.texture;
    int kind = 0;
    enum status st = description_name(&r->file, &made.name, err);
    if (!st && find_name(s, made.name, next_texture) >= 0) st = name_taken(r, made.name, "texture", err);
    if (!st) st = read_choice(r, texture_words, TEXTURE_KINDS, "a kind of texture", &kind, err);
    if (!st) {
        t->kind = (enum texture_kind)kind;
        const bool two = t->kind == TEXTURE_CHECKER || t->kind == TEXTURE_WOOD || t->kind == TEXTURE_BRICK;
        const bool generated = t->kind == TEXTURE_PRINT || t->kind == TEXTURE_BOOKS;
        if (t->kind == TEXTURE_CHECKER) st = read_size(r, "the size of a square", &t->size[0], err);
        if (t->kind == TEXTURE_WOOD || t->kind == TEXTURE_PLASTER) st = read_size(r, "a scale", &t->size[0], err);
        if (t->kind == TEXTURE_PLASTER)
            st = st ? st : description_number(&r->file, "an amount", 0, 1, &t->size[1], err);
        if (t->kind == TEXTURE_BRICK) {
            st = read_size(r, "the width of a brick", &t->size[0], err);
            if (!st) st = read_size(r, "the height of a brick", &t->size[1], err);
            if (!st)
                st = description_number(&r->file, "the width of the mortar", 0, fmin(t->size[0], t->size[1]),
                                        &t->size[2], err);
        }
        if (!st && t->kind != TEXTURE_RGB && t->kind != TEXTURE_CHECKER) st = read_seed(r, &t->seed, err);
        if (generated) {
            if (!st) st = read_size(r, "a width", &t->size[0], err);
            if (!st) st = read_size(r, "a height", &t->size[1], err);
        } else {
            if (!st) st = read_colour(r, "a colour from 0 to 1", 1, &t->colour[0], err);
            if (!st && two) st = read_colour(r, "the second colour, from 0 to 1", 1, &t->colour[1], err);
        }
    }
    if (!st) st = textfile_end(&r->file, err);
    if (!st) st = description_append(&r->file, &s->textures, s->texture_count, MAX_LINES, sizeof made, err);
    if (!st) {
        s->textures[s->texture_count++] = made;
    } else {
        free(made.name);
    }
    return st;
}

static enum status read_material(struct reader *r, struct err *err)
{
    static const char *const words[] = {"lambert", "phong", "ward"};
    struct scene *s = r->scene;
    struct scene_material made = {0};
    int kind = 0;
    enum status st = description_name(&r->file, &made.name, err);
    if (!st && find_name(s, made.name, next_material) >= 0) st = name_taken(r, made.name, "material", err);
    if (!st) st = read_choice(r, words, 3, "a kind of material", &kind, err);
    if (!st) st = read_known_name(r, "texture", next_texture, &made.texture, err);
    made.kind = (enum brdf_kind)kind;
    if (!st && made.kind != BRDF_LAMBERT) {
        st = description_number(&r->file, "a strength of the gloss", 0, 1e6, &made.ks, err);
        if (!st && made.kind == BRDF_PHONG) st = description_number(&r->file, "an exponent", 1, 1e6, &made.shape, err);
        if (!st && made.kind == BRDF_WARD) st = description_number(&r->file, "a roughness", 0.01, 1, &made.shape, err);
    }
    if (!st) {
        const double albedo = texture_bound(&s->textures[made.texture].texture);
        made.gloss = brdf_gloss_albedo(made.kind, made.ks, made.shape);
        if (albedo + made.gloss > 1 + 1e-9) {
            char found[100];
            snprintf(found, sizeof found, "albedo up to %.3g and gloss of %.3g", albedo, made.gloss);
            st = textfile_error(&r->file, err, found, "no more than 1 together");
        }
    }
    if (!st) st = textfile_end(&r->file, err);
    if (!st) st = description_append(&r->file, &s->materials, s->material_count, MAX_LINES, sizeof made, err);
    if (!st) {
        s->materials[s->material_count++] = made;
    } else {
        free(made.name);
    }
    return st;
}

static enum status read_glow(struct reader *r, struct err *err)
{
    int material = 0;
    struct rgb glow;
    enum status st = read_known_name(r, "material", next_material, &material, err);
    if (!st) st = read_colour(r, "a radiance", MAX_RADIANCE, &glow, err);
    if (!st) st = textfile_end(&r->file, err);
    if (!st) r->scene->materials[material].glow = glow;
    return st;
}

/* ------------------------------------------------------------------------------------------------------------ items */

static enum status material_of(struct reader *r, int *material, struct err *err)
{
    return read_known_name(r, "material", next_material, material, err);
}

static enum status read_wall(struct reader *r, struct scene_item *it, struct err *err)
{
    enum status st = description_number(&r->file, "x of the wall's start", -MAX_METRES, MAX_METRES, &it->x0, err);
    if (!st) st = description_number(&r->file, "y of the wall's start", -MAX_METRES, MAX_METRES, &it->y0, err);
    if (!st) st = description_number(&r->file, "x of the wall's end", -MAX_METRES, MAX_METRES, &it->x1, err);
    if (!st) st = description_number(&r->file, "y of the wall's end", -MAX_METRES, MAX_METRES, &it->y1, err);
    if (!st && hypot(it->x1 - it->x0, it->y1 - it->y0) < MIN_METRES)
        st = textfile_error(&r->file, err, "equal start and end points", "a wall with a length");
    if (!st) st = read_range(r, "the wall's height: Z0, then a larger Z1", &it->z0, &it->z1, err);
    if (!st) st = description_number(&r->file, "a thickness", MIN_METRES, 100, &it->thickness, err);
    if (!st) st = material_of(r, &it->material, err);
    return st;
}

static enum status read_opening(struct reader *r, struct scene_item *it, struct err *err)
{
    const struct scene *s = r->scene;
    int wall = 0;
    enum status st = read_known_name(r, "wall", next_item, &wall, err);
    if (!st && s->items[wall].kind != ITEM_WALL)
        st = textfile_error(&r->file, err, s->items[wall].name, "the name of a wall above");
    if (!st) st = read_range(r, "the range along the wall: S0, then a larger S1", &it->s0, &it->s1, err);
    if (!st) st = read_range(r, "the height: Z0, then a larger Z1", &it->z0, &it->z1, err);
    if (st) return st;
    const struct scene_item *w = &s->items[wall];
    const double length = hypot(w->x1 - w->x0, w->y1 - w->y0);
    it->wall = wall;
    it->material = w->material;
    if (it->s0 < 0 || it->s1 > length + MIN_METRES || it->z0 < w->z0 || it->z1 > w->z1) {
        char found[160];
        snprintf(found, sizeof found, "%g to %g m along, %g to %g m high", it->s0, it->s1, it->z0, it->z1);
        return textfile_error(&r->file, err, found, "an opening inside wall %s: 0 to %g m along, %g to %g m high",
                              w->name, length, w->z0, w->z1);
    }
    for (int i = 0; i < s->item_count; i++) {
        const struct scene_item *o = &s->items[i];
        if ((o->kind != ITEM_OPENING && o->kind != ITEM_WINDOW) || o->wall != wall) continue;
        if (it->s0 < o->s1 && o->s0 < it->s1 && it->z0 < o->z1 && o->z0 < it->z1)
            return textfile_error(&r->file, err, it->name, "an opening that does not overlap %s", o->name);
    }
    return ST_OK;
}

static enum status read_turn(struct reader *r, struct scene_item *it, struct err *err)
{
    return description_number(&r->file, "an angle in degrees", -360, 360, &it->turn, err);
}

static enum status read_box(struct reader *r, struct scene_item *it, struct err *err)
{
    static const char *const words[] = {"turn"};
    struct vec3 a, b;
    int word = 0;
    enum status st = description_point(&r->file, "a corner of the box", &a, err);
    if (!st) st = description_number(&r->file, "X1, larger than X0", a.x + MIN_METRES, MAX_METRES, &b.x, err);
    if (!st) st = description_number(&r->file, "Y1, larger than Y0", a.y + MIN_METRES, MAX_METRES, &b.y, err);
    if (!st) st = description_number(&r->file, "Z1, larger than Z0", a.z + MIN_METRES, MAX_METRES, &b.z, err);
    if (!st) st = material_of(r, &it->material, err);
    if (!st && textfile_more(&r->file)) {
        st = read_choice(r, words, 1, "an option of a box", &word, err);
        if (!st) st = read_turn(r, it, err);
    }
    if (st) return st;
    it->x0 = a.x, it->y0 = a.y, it->z0 = a.z;
    it->x1 = b.x, it->y1 = b.y, it->z1 = b.z;
    return ST_OK;
}

static enum status read_edges(struct reader *r, struct scene_item *it, struct err *err)
{
    enum status st = description_point(&r->file, "a corner", &it->at, err);
    if (!st) st = description_point(&r->file, "the first edge", &it->u, err);
    if (!st) st = description_point(&r->file, "the second edge", &it->v, err);
    if (!st && vec3_length(vec3_cross(it->u, it->v)) < MIN_METRES * MIN_METRES)
        st = textfile_error(&r->file, err, "edges without an area between them", "two edges that span one");
    return st;
}

static enum status read_quad(struct reader *r, struct scene_item *it, struct err *err)
{
    enum status st = read_edges(r, it, err);
    if (!st) st = material_of(r, &it->material, err);
    return st;
}

static enum status read_room(struct reader *r, struct scene_item *it, struct err *err)
{
    enum status st = description_number(&r->file, "X0", -MAX_METRES, MAX_METRES, &it->x0, err);
    if (!st) st = description_number(&r->file, "Y0", -MAX_METRES, MAX_METRES, &it->y0, err);
    if (!st) st = description_number(&r->file, "X1, larger than X0", it->x0 + MIN_METRES, MAX_METRES, &it->x1, err);
    if (!st) st = description_number(&r->file, "Y1, larger than Y0", it->y0 + MIN_METRES, MAX_METRES, &it->y1, err);
    if (!st) st = read_range(r, "the room's height: Z0, then a larger Z1", &it->z0, &it->z1, err);
    if (!st) st = material_of(r, &it->material, err);
    if (!st) st = material_of(r, &it->ceiling, err);
    return st;
}

static enum status read_mesh(struct reader *r, struct scene_item *it, struct err *err)
{
    static const char *const words[] = {"at", "scale", "turn"};
    char *file = NULL, *path = NULL;
    it->scale = 1;
    enum status st = textfile_word(&r->file, "a mesh file, .obj", &file, err);
    if (!st && (strchr(file, '/') || *file == '.'))
        st = textfile_error(&r->file, err, file, "the name of a file beside the scene, without a folder");
    if (!st && asprintf(&path, "%s/%s", r->folder, file) < 0) {
        path = NULL;
        st = err_nomem(err, "a file name", strlen(r->folder) + strlen(file));
    }
    if (!st && (st = mesh_file_read(&it->triangles, &it->triangle_count, path, err)))
        err_context(err, "%s:%d", r->file.path, r->file.line);
    if (!st && r->prov) st = provenance_add_file(r->prov, file, path, err);
    if (!st) st = material_of(r, &it->material, err);
    while (!st && textfile_more(&r->file)) {
        int word = 0;
        st = read_choice(r, words, 3, "an option of a mesh", &word, err);
        if (!st && word == 0) st = description_point(&r->file, "the mesh's position", &it->at, err);
        if (!st && word == 1) st = description_number(&r->file, "a scale", 1e-6, 1e6, &it->scale, err);
        if (!st && word == 2) st = read_turn(r, it, err);
    }
    free(path);
    return st;
}

static enum status read_lamp(struct reader *r, struct scene_item *it, struct err *err)
{
    static const char *const words[] = {"quad", "disk"};
    int kind = 0;
    it->material = -1;
    enum status st = read_choice(r, words, 2, "a kind of lamp", &kind, err);
    if (st) return st;
    it->kind = kind ? ITEM_LAMP_DISK : ITEM_LAMP_QUAD;
    if (it->kind == ITEM_LAMP_QUAD) {
        st = read_edges(r, it, err);
        if (!st && fabs(vec3_dot(vec3_normalize(it->u), vec3_normalize(it->v))) > PERPENDICULAR)
            st = textfile_error(&r->file, err, "slanted edges", "edges at a right angle");
        if (!st) st = read_colour(r, "a radiance", MAX_RADIANCE, &it->radiance, err);
        return st;
    }
    st = description_point(&r->file, "the centre", &it->at, err);
    if (!st) st = description_point(&r->file, "the direction", &it->u, err);
    if (!st && !(vec3_length(it->u) > 0)) st = textfile_error(&r->file, err, "0 0 0", "a direction");
    if (!st) st = description_number(&r->file, "a radius", 1e-4, 1e3, &it->radius, err);
    if (!st) st = read_colour(r, "a radiance", MAX_RADIANCE, &it->radiance, err);
    if (!st) st = description_number(&r->file, "half the angle of the cone, in degrees", 0.5, 90, &it->half_angle, err);
    if (!st && textfile_more(&r->file)) st = description_number(&r->file, "an exponent", 0, 1000, &it->exponent, err);
    return st;
}

typedef enum status item_reader(struct reader *r, struct scene_item *it, struct err *err);

static enum status read_item(struct reader *r, enum item_kind kind, item_reader *read, struct err *err)
{
    struct scene *s = r->scene;
    struct scene_item made = {.kind = kind};
    enum status st = description_name(&r->file, &made.name, err);
    if (!st && find_name(s, made.name, next_item) >= 0)
        st = name_taken(r, made.name, "wall, opening, window, box, quad, mesh, room or lamp", err);
    if (!st) st = read(r, &made, err);
    if (!st) st = textfile_end(&r->file, err);
    if (!st) st = description_append(&r->file, &s->items, s->item_count, MAX_LINES, sizeof made, err);
    if (!st) {
        s->items[s->item_count++] = made;
    } else {
        free(made.name);
        free(made.triangles);
    }
    return st;
}

/* --------------------------------------------------------------------------------------------------------- outdoors */

static enum status read_sun(struct reader *r, struct err *err)
{
    struct sun *sun = &r->scene->sky.sun;
    if (r->scene->sky.has_sun) return textfile_error(&r->file, err, "a second sun", "at most one");
    enum status st = description_number(&r->file, "the sun's azimuth in degrees", -360, 360, &sun->azimuth, err);
    if (!st) st = description_number(&r->file, "the sun's elevation in degrees", -90, 90, &sun->elevation, err);
    if (!st)
        st = description_number(&r->file, "the sun's angular radius in degrees", 0.05, 30, &sun->angular_radius, err);
    if (!st) st = read_colour(r, "a radiance", MAX_RADIANCE, &sun->radiance, err);
    if (!st) st = textfile_end(&r->file, err);
    r->scene->sky.has_sun = !st;
    return st;
}

static enum status read_panorama(struct reader *r, struct err *err)
{
    struct panorama *p = &r->scene->sky.panorama;
    if (r->scene->sky.has_panorama) return textfile_error(&r->file, err, "a second panorama", "at most one");
    enum status st = read_seed(r, &p->seed, err);
    if (!st) st = read_colour(r, "the sky's radiance", MAX_RADIANCE, &p->sky, err);
    if (!st) st = read_colour(r, "the ground's radiance", MAX_RADIANCE, &p->ground, err);
    if (!st) st = textfile_end(&r->file, err);
    r->scene->sky.has_panorama = !st;
    return st;
}

/* ------------------------------------------------------------------------------------------------------------- file */

static enum status read_line(struct reader *r, struct err *err)
{
    static const char *const words[] = {"texture", "material", "glow", "sun",  "panorama", "wall", "opening",
                                        "window",  "box",      "quad", "mesh", "room",     "lamp"};
    static enum status (*const lines[])(struct reader *, struct err *) = {read_texture, read_material, read_glow,
                                                                          read_sun, read_panorama};
    static item_reader *const items[] = {read_wall, read_opening, read_opening, read_box,
                                         read_quad, read_mesh,    read_room,    read_lamp};
    enum { LINES = sizeof lines / sizeof *lines, WORDS = sizeof words / sizeof *words };
    int word = 0;
    enum status st = read_choice(r, words, WORDS, "a line of a scene", &word, err);
    if (st) return st;
    return word < LINES ? lines[word](r, err) : read_item(r, (enum item_kind)(word - LINES), items[word - LINES], err);
}

static bool emits(struct rgb c) { return rgb_max(c) > 0; }

static bool has_light(const struct scene *s)
{
    if (s->sky.has_sun && emits(s->sky.sun.radiance)) return true;
    if (s->sky.has_panorama && (emits(s->sky.panorama.sky) || emits(s->sky.panorama.ground))) return true;
    for (int i = 0; i < s->item_count; i++)
        if (emits(s->items[i].radiance)) return true;
    for (int i = 0; i < s->material_count; i++)
        if (emits(s->materials[i].glow)) return true;
    return false;
}

enum status scene_read(struct scene *s, const char *folder, const char *file, struct provenance *prov, struct err *err)
{
    struct reader r = {.scene = s, .folder = folder, .prov = prov};
    char *path = NULL;
    *s = (struct scene){0};
    if (asprintf(&path, "%s/%s", folder, file) < 0) return err_nomem(err, "a file name", strlen(folder) + strlen(file));
    enum status st = textfile_open(&r.file, path, err);
    if (!st) st = description_header(&r.file, "remodel-scene", err);
    while (!st && textfile_next(&r.file)) st = read_line(&r, err);
    if (!st && !s->item_count) st = err_set(err, ST_DATA, "%s has no surfaces; add a room, a box or a quad.", path);
    if (!st && !has_light(s))
        st = err_set(
            err, ST_DATA,
            "%s has no light: every photo would be black; add a lamp, a sun or a panorama with a positive radiance.",
            path);
    if (!st && prov) st = provenance_add_file(prov, file, path, err);
    textfile_release(&r.file);
    free(path);
    if (st) scene_release(s);
    return st;
}

void scene_release(struct scene *s)
{
    if (!s) return;
    for (int i = 0; i < s->texture_count; i++) free(s->textures[i].name);
    for (int i = 0; i < s->material_count; i++) free(s->materials[i].name);
    for (int i = 0; i < s->item_count; i++) {
        free(s->items[i].name);
        free(s->items[i].triangles);
    }
    free(s->textures);
    free(s->materials);
    free(s->items);
    *s = (struct scene){0};
}
