/* scene_items.c - the lines of scene.txt about walls, openings, rooms, objects and lamps (scene_reader.h). */
#include "stages/simulate/scene_reader.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/light/obj_mesh.h"

#define PERPENDICULAR 1e-6 /* largest cosine that counts as a right angle */

static enum status material_of(struct reader *r, int *material, struct err *err)
{
    return scene_read_known_name(r, "material", scene_next_material, material, err);
}

static enum status read_wall(struct reader *r, struct scene_item *it, struct err *err)
{
    if (!textfile_number(&r->file, "x of the wall's start", -MAX_METRES, MAX_METRES, &it->x0, err) &&
        !textfile_number(&r->file, "y of the wall's start", -MAX_METRES, MAX_METRES, &it->y0, err) &&
        !textfile_number(&r->file, "x of the wall's end", -MAX_METRES, MAX_METRES, &it->x1, err))
        textfile_number(&r->file, "y of the wall's end", -MAX_METRES, MAX_METRES, &it->y1, err);
    if (!err->status && hypot(it->x1 - it->x0, it->y1 - it->y0) < MIN_METRES)
        textfile_error(&r->file, err, "equal start and end points", "a wall with a length");
    if (!err->status && !scene_read_range(r, "the wall's height: Z0, then a larger Z1", &it->z0, &it->z1, err) &&
        !textfile_number(&r->file, "a thickness", MIN_METRES, 100, &it->thickness, err))
        material_of(r, &it->material, err);
    return err->status;
}

static enum status read_opening(struct reader *r, struct scene_item *it, struct err *err)
{
    const struct scene *s = r->scene;
    int wall = 0;
    scene_read_known_name(r, "wall", scene_next_item, &wall, err);
    if (!err->status && s->items[wall].kind != ITEM_WALL)
        textfile_error(&r->file, err, s->items[wall].name, "the name of a wall above");
    if (!err->status && !scene_read_range(r, "the range along the wall: S0, then a larger S1", &it->s0, &it->s1, err))
        scene_read_range(r, "the height: Z0, then a larger Z1", &it->z0, &it->z1, err);
    if (err->status) return err->status;
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
    return textfile_number(&r->file, "an angle in degrees", -360, 360, &it->turn, err);
}

static enum status read_box(struct reader *r, struct scene_item *it, struct err *err)
{
    static const char *const words[] = {"turn"};
    struct vec3 a, b;
    int word = 0;
    if (!description_point(&r->file, "a corner of the box", &a, err) &&
        !textfile_number(&r->file, "X1, larger than X0", a.x + MIN_METRES, MAX_METRES, &b.x, err) &&
        !textfile_number(&r->file, "Y1, larger than Y0", a.y + MIN_METRES, MAX_METRES, &b.y, err) &&
        !textfile_number(&r->file, "Z1, larger than Z0", a.z + MIN_METRES, MAX_METRES, &b.z, err))
        material_of(r, &it->material, err);
    if (!err->status && textfile_more(&r->file) && !scene_read_choice(r, words, 1, "an option of a box", &word, err))
        read_turn(r, it, err);
    if (err->status) return err->status;
    it->x0 = a.x, it->y0 = a.y, it->z0 = a.z;
    it->x1 = b.x, it->y1 = b.y, it->z1 = b.z;
    return ST_OK;
}

static enum status read_edges(struct reader *r, struct scene_item *it, struct err *err)
{
    if (!description_point(&r->file, "a corner", &it->at, err) &&
        !description_point(&r->file, "the first edge", &it->u, err))
        description_point(&r->file, "the second edge", &it->v, err);
    if (!err->status && vec3_length(vec3_cross(it->u, it->v)) < MIN_METRES * MIN_METRES)
        textfile_error(&r->file, err, "edges without an area between them", "two edges that span one");
    return err->status;
}

static enum status read_quad(struct reader *r, struct scene_item *it, struct err *err)
{
    return read_edges(r, it, err) || material_of(r, &it->material, err) ? err->status : ST_OK;
}

static enum status read_room(struct reader *r, struct scene_item *it, struct err *err)
{
    if (!textfile_number(&r->file, "X0", -MAX_METRES, MAX_METRES, &it->x0, err) &&
        !textfile_number(&r->file, "Y0", -MAX_METRES, MAX_METRES, &it->y0, err) &&
        !textfile_number(&r->file, "X1, larger than X0", it->x0 + MIN_METRES, MAX_METRES, &it->x1, err) &&
        !textfile_number(&r->file, "Y1, larger than Y0", it->y0 + MIN_METRES, MAX_METRES, &it->y1, err))
        scene_read_range(r, "the room's height: Z0, then a larger Z1", &it->z0, &it->z1, err);
    if (!err->status && !material_of(r, &it->material, err)) material_of(r, &it->ceiling, err);
    return err->status;
}

static enum status read_mesh(struct reader *r, struct scene_item *it, struct err *err)
{
    static const char *const words[] = {"at", "scale", "turn"};
    char *file = NULL, *path = NULL;
    it->scale = 1;
    if (!textfile_word(&r->file, "a mesh file, .obj", &file, err) && (strchr(file, '/') || *file == '.'))
        textfile_error(&r->file, err, file, "the name of a file beside the scene, without a folder");
    if (!err->status && asprintf(&path, "%s/%s", r->folder, file) < 0) {
        path = NULL;
        err_nomem(err, "a file name", strlen(r->folder) + strlen(file));
    }
    struct obj_mesh mesh = {0};
    if (!err->status && obj_mesh_read(&mesh, path, err)) err_context(err, "%s:%d", r->file.path, r->file.line);
    it->triangles = mesh.triangles;
    it->triangle_count = mesh.count;
    mesh.triangles = NULL; /* the item's now; pieces are flat here, so normals are not kept */
    obj_mesh_release(&mesh);
    if (!err->status && r->prov) provenance_add_file(r->prov, file, path, err);
    if (!err->status) material_of(r, &it->material, err);
    while (!err->status && textfile_more(&r->file)) {
        int word = 0;
        scene_read_choice(r, words, 3, "an option of a mesh", &word, err);
        if (!err->status && word == 0) description_point(&r->file, "the mesh's position", &it->at, err);
        if (!err->status && word == 1) textfile_number(&r->file, "a scale", 1e-6, 1e6, &it->scale, err);
        if (!err->status && word == 2) read_turn(r, it, err);
    }
    free(path);
    return err->status;
}

static enum status read_lamp(struct reader *r, struct scene_item *it, struct err *err)
{
    static const char *const words[] = {"quad", "disk"};
    int kind = 0;
    it->material = -1;
    if (scene_read_choice(r, words, 2, "a kind of lamp", &kind, err)) return err->status;
    it->kind = kind ? ITEM_LAMP_DISK : ITEM_LAMP_QUAD;
    if (it->kind == ITEM_LAMP_QUAD) {
        read_edges(r, it, err);
        if (!err->status && fabs(vec3_dot(vec3_normalize(it->u), vec3_normalize(it->v))) > PERPENDICULAR)
            textfile_error(&r->file, err, "slanted edges", "edges at a right angle");
        if (!err->status) scene_read_colour(r, "a radiance", MAX_RADIANCE, &it->radiance, err);
        return err->status;
    }
    if (!description_point(&r->file, "the centre", &it->at, err))
        description_point(&r->file, "the direction", &it->u, err);
    if (!err->status && !(vec3_length(it->u) > 0)) textfile_error(&r->file, err, "0 0 0", "a direction");
    if (!err->status && !textfile_number(&r->file, "a radius", 1e-4, 1e3, &it->radius, err) &&
        !scene_read_colour(r, "a radiance", MAX_RADIANCE, &it->radiance, err))
        textfile_number(&r->file, "half the angle of the cone, in degrees", 0.5, 90, &it->half_angle, err);
    if (!err->status && textfile_more(&r->file)) textfile_number(&r->file, "an exponent", 0, 1000, &it->exponent, err);
    return err->status;
}

void scene_item_release(struct scene_item *it)
{
    free(it->name);
    free(it->triangles);
}

typedef enum status item_reader(struct reader *r, struct scene_item *it, struct err *err);

enum status scene_read_item(struct reader *r, enum item_kind kind, struct err *err)
{
    static item_reader *const readers[] = {read_wall, read_opening, read_opening, read_box,
                                           read_quad, read_mesh,    read_room,    read_lamp};
    struct scene *s = r->scene;
    struct scene_item made = {.kind = kind, .wall = -1, .line = r->file.line};
    if (kind == ITEM_BOX || kind == ITEM_QUAD || kind == ITEM_MESH) made.furniture = r->furniture;
    if (!description_name(&r->file, &made.name, err) && scene_find_name(s, made.name, scene_next_item) >= 0)
        scene_name_taken(r, made.name, "wall, opening, window, box, quad, mesh, room or lamp", err);
    if (!err->status && !readers[kind](r, &made, err) && !textfile_end(&r->file, err) &&
        !description_append(&r->file, &s->items, s->item_count, MAX_LINES, sizeof made, err)) {
        s->items[s->item_count++] = made;
    } else {
        scene_item_release(&made);
    }
    return err->status;
}
