/* edit_room.h - shared by tests of relighting: a room of 4 x 4 x 4 about the origin, made of slabs, and edits of it.
 *
 * Texture is one colour per face of the room. The ids of its faces are FIRST ... FIRST + 5, -x +x -y +y -z +z, as in
 * box_field.h; all other faces get ids in the order in which tests name them. */
#ifndef REMODEL_TESTS_EDIT_ROOM_H
#define REMODEL_TESTS_EDIT_ROOM_H

#include "tests/unit/common/gather/box_field.h"

#include "common/base/hash.h"
#include "common/relight/light_change.h"

#define SLAB_WEST                                        \
    {                                                    \
        "walls", "west", {-3, -2, -2}, {-2, 2, 2}, false \
    }
#define SLAB_EAST                                      \
    {                                                  \
        "walls", "east", {2, -2, -2}, {3, 2, 2}, false \
    }
#define SLAB_SOUTH                                        \
    {                                                     \
        "walls", "south", {-2, -3, -2}, {2, -2, 2}, false \
    }
#define SLAB_NORTH                                      \
    {                                                   \
        "walls", "north", {-2, 2, -2}, {2, 3, 2}, false \
    }
#define SLAB_FLOOR                                        \
    {                                                     \
        "walls", "floor", {-2, -2, -3}, {2, 2, -2}, false \
    }
#define SLAB_TOP                                          \
    {                                                     \
        "walls", "ceiling", {-2, -2, 2}, {2, 2, 3}, false \
    }
#define PANE                                                  \
    {                                                         \
        "glass/big", "pane", {-2, 2, -2}, {2, 2.01, 2}, false \
    }
#define INFILL                                           \
    {                                                    \
        "walls", "infill", {-2, 2, -2}, {2, 3, 2}, false \
    }

enum { EAST = FIRST + 1, NORTH = FIRST + 3, OTHERS = 20 };

static const struct box closed_room[] = {SLAB_WEST, SLAB_EAST, SLAB_SOUTH, SLAB_NORTH, SLAB_FLOOR, SLAB_TOP};
static const struct box window_room[] = {SLAB_WEST, SLAB_EAST, SLAB_SOUTH, SLAB_FLOOR, SLAB_TOP, PANE};
static const struct box walled_room[] = {SLAB_WEST, SLAB_EAST, SLAB_SOUTH, SLAB_FLOOR, SLAB_TOP, INFILL};
/* The east wall is moved by half a unit. */
static const struct box wide_room[] = {SLAB_WEST,
                                       {"walls", "east", {2.5, -2, -2}, {3.5, 2, 2}, false},
                                       {"walls", "south", {-2, -3, -2}, {2.5, -2, 2}, false},
                                       {"walls", "north", {-2, 2, -2}, {2.5, 3, 2}, false},
                                       {"walls", "floor", {-2, -2, -3}, {2.5, 2, -2}, false},
                                       {"walls", "ceiling", {-2, -2, 2}, {2.5, 2, 3}, false}};
/* A wall of 0.4 stands across the room. The floor is in two parts. */
static const struct box split_room[] = {SLAB_WEST,
                                        SLAB_EAST,
                                        SLAB_SOUTH,
                                        SLAB_NORTH,
                                        {"walls", "floor", {-2, -2, -3}, {-0.2, 2, -2}, false},
                                        {"walls", "floor", {0.2, -2, -3}, {2, 2, -2}, false},
                                        SLAB_TOP,
                                        {"walls", "between", {-0.2, -2, -3}, {0.2, 2, 2}, false}};
#define COUNT(boxes) ((int)(sizeof(boxes) / sizeof *(boxes)))

/* The id of a name: of the room's faces, or the place in a list that all models share. */
static inline int room_id(const char *name)
{
    static const char *const inner[6] = {"west/1", "east/0", "south/3", "north/2", "floor/5", "ceiling/4"};
    static char others[64][64];
    static int count;
    for (int i = 0; i < 6; i++)
        if (!strcmp(name, inner[i])) return FIRST + i;
    for (int i = 0; i < count; i++)
        if (!strcmp(name, others[i])) return OTHERS + i;
    assert_true(count < 64);
    snprintf(others[count], sizeof others[count], "%s", name);
    return OTHERS + count++;
}

static inline struct solid_mesh make_slabs(const struct box *boxes, int count)
{
    struct solid_mesh mesh = make_boxes(boxes, count);
    struct err err = ERR_INIT;
    int ids[6 * MAX_BOXES];
    for (int i = 0; i < mesh.name_count; i++) ids[i] = room_id(mesh.names[i].name);
    assert_ok(solid_mesh_set_ids(&mesh, ids, &err), err);
    return mesh;
}

/* An edit of a room; {0} but for what a test sets. edit_write() fills the rest. */
struct edit {
    const struct box *before, *after;
    int before_count, after_count;
    const float (*colours)[3]; /* radiance of the six faces */
    const char *lights;        /* lines of lights.txt; NULL: none */
    float sky;                 /* radiance outdoors; 0: dark */
    struct texture_map map;    /* its faces are the test's */
    const char *objects;       /* lines of objects.txt after its header, with %s for the hash of `mesh`; NULL: none */
    const char *mesh;          /* mesh.obj */
    const char *lux_scale;     /* scale.txt, in a model in metres; NULL: none */
    struct light_change_files files;
};

static inline const char *keep_path(const char *name)
{
    static char paths[32][PATH_MAX];
    static int next;
    char *path = paths[next++ % 32];
    snprintf(path, PATH_MAX, "%s/%s", scratch, name);
    return path;
}

static inline const char *write_slabs(const char *name, const struct box *boxes, int count)
{
    struct solid_mesh mesh = make_slabs(boxes, count);
    struct err err = ERR_INIT;
    const char *path = keep_path(name);
    assert_ok(solid_mesh_write(&mesh, path, NULL, &err), err);
    solid_mesh_release(&mesh);
    return path;
}

static inline const char *write_sky(float radiance)
{
    struct outdoors o;
    struct err err = ERR_INIT;
    struct provenance prov = {0};
    const char *path = keep_path("outdoors.exr");
    assert_ok(outdoors_init(&o, 64, &err), err);
    for (int i = 0; i < o.width * o.height; i++) {
        for (int c = 0; c < 3; c++) o.rgb[3 * i + c] = radiance;
        o.source[i] = OUTDOORS_REFERENCE;
    }
    assert_ok(outdoors_write(&o, path, &prov, &err), err);
    outdoors_release(&o);
    return path;
}

static inline const char *write_objects(const char *lines, const char *mesh)
{
    char hash[HASH_TEXT], body[4096], text[8192];
    struct err err = ERR_INIT;
    assert_ok(hash_file(hash, scratch_write("mesh.obj", mesh), &err), err);
    snprintf(body, sizeof body, lines, hash, hash);
    snprintf(text, sizeof text, "remodel-objects 1\n%s", body);
    scratch_write("objects.txt", text);
    return keep_path("objects.txt");
}

/* Writes all files of the edit. */
static inline void edit_write(struct edit *e)
{
    const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .scale = 1, .metric = e->lux_scale != NULL};
    struct err err = ERR_INIT;
    write_vita(e->colours, 6, 0);
    e->files = (struct light_change_files){.base = write_slabs("base.txt", e->before, e->before_count),
                                           .edited = write_slabs("edited.txt", e->after, e->after_count),
                                           .vita = keep_path("vita"),
                                           .map = keep_path("texture.txt"),
                                           .axes = keep_path("axes.txt")};
    assert_ok(model_axes_write(&axes, e->files.axes, NULL, &err), err);
    assert_ok(texture_map_write(&e->map, e->files.map, NULL, &err), err);
    if (e->lights) {
        write_lights(e->lights);
        e->files.lights = keep_path("lights.txt");
    }
    if (e->sky > 0) e->files.outdoors = write_sky(e->sky);
    if (e->lux_scale) e->files.lux_scale = e->lux_scale, e->files.scene = keep_path("");
    if (e->objects) {
        e->files.objects = write_objects(e->objects, e->mesh);
        e->files.scene = keep_path("");
    }
}

static inline void edit_read(struct light_change *c, struct edit *e)
{
    struct err err = ERR_INIT;
    edit_write(e);
    assert_ok(light_change_read(c, &e->files, NULL, &err), err);
}

/* An edit of the closed room that changes no wall. */
static inline struct edit edit_of_closed_room(const float colours[6][3])
{
    return (struct edit){.before = closed_room,
                         .after = closed_room,
                         .before_count = COUNT(closed_room),
                         .after_count = COUNT(closed_room),
                         .colours = colours};
}

/* The index of the face of a name in a mesh; the first of several. */
static inline int face_named(const struct solid_mesh *mesh, const char *name)
{
    for (int i = 0; i < mesh->face_count; i++)
        if (!strcmp(mesh->names[mesh->faces[i].name].name, name)) return i;
    fail_msg("no face %s", name);
    return -1;
}

/* Rules for texture maps. */
static inline struct texture_rule rule_shifted(enum texture_rule_kind kind, int from, double x)
{
    return (struct texture_rule){.kind = kind, .from = from, .matrix = {{1, 0, 0, x}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
}

static inline struct texture_rule rule_colour(float albedo)
{
    return (struct texture_rule){.kind = TEXTURE_COLOUR, .albedo = {albedo, albedo, albedo}};
}

static const float plain[6][3] = {{.3f, .3f, .3f}, {.3f, .3f, .3f}, {.3f, .3f, .3f},
                                  {.3f, .3f, .3f}, {.3f, .3f, .3f}, {.3f, .3f, .3f}};

/* What bright_lamp could light: no face is brighter than a grey one would be. */
static const float lit[6][3] = {{.15f, .15f, .15f}, {.15f, .15f, .15f}, {.15f, .15f, .15f},
                                {.15f, .15f, .15f}, {.4f, .4f, .4f},    {.15f, .15f, .15f}};
static const char bright_lamp[] = "quad lamp 0.5 0 1.99 0.5 0 0 0 -0.5 0 60 60 60 90 0\n";

/* A cube of side 1 with a corner at the origin. */
static const char cube[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                           "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

#endif
