/* write_gltf.c - glTF 2.0 in its binary form: JSON, then vertices and pictures.
 *
 * Layout of a .glb file: a header of 12 bytes, a chunk "JSON", a chunk "BIN"; each chunk is padded to four bytes.
 * The JSON describes the second chunk: a buffer view is a range of its bytes, an accessor says which vectors a view
 * holds. Here every accessor has its own view, and every view begins at a multiple of four.
 *
 * A body becomes a node with a mesh, and the triangles of a body with one material become a primitive: pages come
 * first, then glass, then the colours in order of the triangles. So the order of everything follows from the model,
 * and the same model gives the same bytes. Vertices are not shared between triangles: faces are flat, each has its
 * own normal, and the corners of two tiles have different texture coordinates. Synthetic objects follow, then
 * lamps that an edit adds (extension KHR_lights_punctual) with their luminous openings, then furniture, a node and a
 * material each. Furniture has thousands of triangles of a curved surface, so these do share
 * their vertices, and have no normals, which unlit materials do not need.
 *
 * glTF's y points up and its z to the viewer, so a point (x, y, z) becomes (x, z, -y). Textures hold the light of
 * the room, so materials are unlit (extension KHR_materials_unlit). `extras` of a primitive lists its faces with the
 * number of the first triangle of each, so that a script finds a face by its name.
 *
 * Memory: the whole file. The loop over materials goes through all triangles for each pair of body and material,
 * O(bodies x materials x triangles); rooms have a few hundred faces. */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/outfile.h"
#include "common/base/version.h"
#include "common/product/product.h"
#include "stages/export_model/writers.h"

/* numbers of the format; NO_TARGET: a view that holds no vertices */
enum { INTEGERS = 5125, FLOATS = 5126, NO_TARGET = 0, VERTICES = 34962, TRIANGLES = 34963 };
enum { MAX_OBJECT_NAME = 300 };

struct bytes {
    unsigned char *data; /* owned */
    size_t size, room;
};

struct gltf {
    const struct export_scene *s;
    struct bytes bin;
    json_t *views, *accessors, *meshes, *nodes, *materials, *children, *lights;
    int colours; /* materials of colours so far */
    struct err *err;
};

static enum status put_bytes(struct gltf *g, const void *data, size_t size)
{
    struct bytes *b = &g->bin;
    const size_t padded = (size + 3) / 4 * 4;
    if (array_reserve(&b->data, &b->room, b->size + padded, 1, "a glTF file", g->err)) return g->err->status;
    memcpy(b->data + b->size, data, size);
    memset(b->data + b->size + size, 0, padded - size);
    b->size += padded;
    return ST_OK;
}

/* *index: of the new view of the buffer. */
static enum status add_view(struct gltf *g, const void *data, size_t size, int target, json_int_t *index)
{
    const size_t at = g->bin.size;
    if (put_bytes(g, data, size)) return g->err->status;
    json_t *view =
        json_pack("{s:i, s:I, s:I}", "buffer", 0, "byteOffset", (json_int_t)at, "byteLength", (json_int_t)size);
    if (target) json_object_set_new(view, "target", json_integer(target));
    *index = (json_int_t)json_array_size(g->views);
    json_array_append_new(g->views, view);
    return ST_OK;
}

/* An accessor of `count` vectors of `size` floats. bounds: with the least and the greatest, as positions need them. */
static enum status add_vectors(struct gltf *g, const float *data, size_t count, int size, bool bounds,
                               json_int_t *index)
{
    json_int_t view;
    if (add_view(g, data, count * (size_t)size * sizeof *data, VERTICES, &view)) return g->err->status;
    json_t *a = json_pack("{s:I, s:i, s:I, s:s}", "bufferView", view, "componentType", FLOATS, "count",
                          (json_int_t)count, "type", size == 3 ? "VEC3" : "VEC2");
    if (bounds) {
        json_t *low = json_array(), *high = json_array();
        for (int k = 0; k < size; k++) {
            float least = INFINITY, most = -INFINITY;
            for (size_t i = 0; i < count; i++) {
                least = fminf(least, data[i * (size_t)size + (size_t)k]);
                most = fmaxf(most, data[i * (size_t)size + (size_t)k]);
            }
            json_array_append_new(low, json_real((double)least));
            json_array_append_new(high, json_real((double)most));
        }
        json_object_set_new(a, "min", low);
        json_object_set_new(a, "max", high);
    }
    *index = (json_int_t)json_array_size(g->accessors);
    json_array_append_new(g->accessors, a);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- materials */

static json_t *unlit(const char *name, json_t *pbr)
{
    json_object_set_new(pbr, "metallicFactor", json_real(0));
    json_object_set_new(pbr, "roughnessFactor", json_real(1));
    return json_pack("{s:s, s:o, s:{s:{}}}", "name", name, "pbrMetallicRoughness", pbr, "extensions",
                     "KHR_materials_unlit");
}

static void add_materials(struct gltf *g)
{
    char name[32];
    for (int i = 0; i < g->s->page_count; i++) {
        snprintf(name, sizeof name, "page%d", i);
        json_array_append_new(g->materials, unlit(name, json_pack("{s:{s:i}}", "baseColorTexture", "index", i)));
    }
    json_t *glass = unlit("glass", json_pack("{s:[f,f,f,f]}", "baseColorFactor", 0.8, 0.9, 0.95, 0.2));
    json_object_set_new(glass, "alphaMode", json_string("BLEND"));
    json_array_append_new(g->materials, glass);
}

static int material_of(struct gltf *g, const struct export_triangle *t)
{
    if (t->material >= 0) return t->material;
    if (t->material == MATERIAL_GLASS) return g->s->page_count;
    char name[96];
    snprintf(name, sizeof name, "colour %.6g %.6g %.6g", (double)t->albedo[0], (double)t->albedo[1],
             (double)t->albedo[2]);
    for (size_t i = 0; i < json_array_size(g->materials); i++)
        if (!strcmp(json_string_value(json_object_get(json_array_get(g->materials, i), "name")), name)) return (int)i;
    json_array_append_new(g->materials, unlit(name, json_pack("{s:[f,f,f,f]}", "baseColorFactor", (double)t->albedo[0],
                                                              (double)t->albedo[1], (double)t->albedo[2], 1.0)));
    return (int)json_array_size(g->materials) - 1;
}

/* ---------------------------------------------------------------------------------------------------------- meshes */

/* glTF's y is up: x, z, -y. */
static void put_point(float to[3], struct vec3 p)
{
    to[0] = (float)p.x;
    to[1] = (float)p.z;
    to[2] = (float)-p.y;
}

/* A primitive of `count` vertices; uv NULL: without texture. */
static json_t *primitive_of(struct gltf *g, const float *at, const float *n, const float *uv, size_t count,
                            int material)
{
    json_int_t a = 0, b = 0, c = 0;
    if (!add_vectors(g, at, count, 3, true, &a)) add_vectors(g, n, count, 3, false, &b);
    json_t *attributes = json_pack("{s:I, s:I}", "POSITION", a, "NORMAL", b);
    if (!g->err->status && uv) {
        add_vectors(g, uv, count, 2, false, &c);
        json_object_set_new(attributes, "TEXCOORD_0", json_integer(c));
    }
    return json_pack("{s:o, s:i}", "attributes", attributes, "material", material);
}

/* A mesh and its node. */
static void add_node(struct gltf *g, const char *name, json_t *primitives)
{
    const json_int_t mesh = (json_int_t)json_array_size(g->meshes);
    json_array_append_new(g->meshes, json_pack("{s:s, s:o}", "name", name, "primitives", primitives));
    json_array_append_new(g->children, json_integer((json_int_t)json_array_size(g->nodes)));
    json_array_append_new(g->nodes, json_pack("{s:s, s:I}", "name", name, "mesh", mesh));
}

/* The triangles of a body that have one material, as a primitive; adds nothing without such triangles. */
static enum status add_primitive(struct gltf *g, json_t *primitives, int body, int material)
{
    const struct export_faces *f = g->s->faces;
    float *at = malloc(((size_t)f->count + 1) * 9 * sizeof *at), *n = malloc(((size_t)f->count + 1) * 9 * sizeof *n);
    float *uv = malloc(((size_t)f->count + 1) * 6 * sizeof *uv);
    json_t *faces = json_array();
    size_t count = 0;
    int last = -1;
    if (!at || !n || !uv) err_nomem(g->err, "vertices", (size_t)f->count * 36);
    for (int i = 0; !g->err->status && i < f->count; i++) {
        const struct export_triangle *t = &f->triangles[i];
        if (g->s->mesh->faces[t->face].body != body || material_of(g, t) != material) continue;
        if (t->face != last)
            json_array_append_new(faces, json_pack("{s:s, s:I}", "name", solid_face_name(g->s->mesh, t->face), "first",
                                                   (json_int_t)(count / 3)));
        last = t->face;
        for (int k = 0; k < 3; k++, count++) {
            put_point(at + 3 * count, t->p[k]);
            put_point(n + 3 * count, g->s->mesh->faces[t->face].normal);
            uv[2 * count] = (float)t->uv[k][0];
            uv[2 * count + 1] = (float)t->uv[k][1];
        }
    }
    if (!g->err->status && count) {
        json_t *p = primitive_of(g, at, n, material < g->s->page_count ? uv : NULL, count, material);
        json_object_set_new(p, "extras", json_pack("{s:O}", "faces", faces));
        json_array_append_new(primitives, p);
    }
    json_decref(faces);
    free(at);
    free(n);
    free(uv);
    return g->err->status;
}

static enum status add_bodies(struct gltf *g)
{
    for (int i = 0; i < g->s->faces->count; i++) material_of(g, &g->s->faces->triangles[i]); /* in order of triangles */
    for (int body = 0; !g->err->status && body < g->s->mesh->body_count; body++) {
        json_t *primitives = json_array();
        for (int m = 0; !g->err->status && m < (int)json_array_size(g->materials); m++)
            add_primitive(g, primitives, body, m);
        if (!json_array_size(primitives)) {
            json_decref(primitives);
            continue;
        }
        add_node(g, g->s->mesh->bodies[body].name, primitives);
    }
    return g->err->status;
}

static enum status add_object(struct gltf *g, const struct object *o, const struct obj_mesh *mesh)
{
    const size_t floats = 9 * (size_t)mesh->count;
    float *at = malloc((floats + 1) * sizeof *at), *n = malloc((floats + 1) * sizeof *n);
    char name[MAX_OBJECT_NAME];
    snprintf(name, sizeof name, "object/%s", o->name);
    if (!at || !n) err_nomem(g->err, "vertices", 2 * floats * sizeof *at);
    for (int i = 0; !g->err->status && i < 3 * mesh->count; i++) {
        put_point(at + 3 * i, mesh->triangles[i / 3][i % 3]);
        put_point(n + 3 * i, export_objects_normal(mesh->triangles[i / 3]));
    }
    if (!g->err->status) {
        const int material = (int)json_array_size(g->materials);
        json_t *colour =
            json_pack("{s:[f,f,f,f]}", "baseColorFactor", o->brdf.albedo.r, o->brdf.albedo.g, o->brdf.albedo.b, 1.0);
        json_array_append_new(g->materials, unlit(name, colour));
        add_node(g, name, json_pack("[o]", primitive_of(g, at, n, NULL, (size_t)(3 * mesh->count), material)));
    }
    free(at);
    free(n);
    return g->err->status;
}

static enum status add_objects(struct gltf *g)
{
    const struct export_objects *all = g->s->objects;
    for (int i = 0; !g->err->status && i < all->list.count; i++) add_object(g, &all->list.items[i], &all->meshes[i]);
    return g->err->status;
}

/* The luminous opening as a fan of triangles, seen from the side to which it shines. */
static json_t *opening_of(struct gltf *g, int lamp)
{
    const struct planned_lamp *l = &g->s->lamps->planned.list[lamp];
    struct vec3 corners[PLANNED_LAMP_CORNERS];
    float at[9 * PLANNED_LAMP_CORNERS], n[9 * PLANNED_LAMP_CORNERS];
    const int count = 3 * (export_lamps_outline(corners, g->s->lamps, lamp) - 2);
    const json_int_t material = (json_int_t)json_array_size(g->materials);
    double c[3];
    for (int k = 0; k < count; k++) {
        put_point(at + 3 * k, corners[k % 3 ? k / 3 + k % 3 : 0]);
        put_point(n + 3 * k, l->down);
    }
    export_lamps_colour(c, l);
    json_array_append_new(g->materials,
                          unlit(l->name, json_pack("{s:[f,f,f,f]}", "baseColorFactor", c[0], c[1], c[2], 1.0)));
    return primitive_of(g, at, n, NULL, (size_t)count, (int)material);
}

/* A light shines along its node's -z. */
static json_t *lamp_matrix(const struct planned_lamp *l)
{
    const struct vec3 z = vec3_scale(l->down, -1), x = l->along, y = vec3_cross(z, x);
    float axes[4][3];
    put_point(axes[0], x);
    put_point(axes[1], y);
    put_point(axes[2], z);
    put_point(axes[3], l->at);
    json_t *m = json_array();
    for (int i = 0; i < 16; i++) json_array_append_new(m, json_real(i % 4 == 3 ? i == 15 : (double)axes[i / 4][i % 4]));
    return m;
}

static enum status add_lamp(struct gltf *g, int lamp)
{
    const struct planned_lamp *l = &g->s->lamps->planned.list[lamp];
    char name[MAX_OBJECT_NAME];
    struct lamp_cone cone;
    double c[3];
    snprintf(name, sizeof name, "lamp/%s", l->name);
    add_node(g, name, json_pack("[o]", opening_of(g, lamp)));
    const bool is_cone = export_lamps_cone(&cone, l);
    export_lamps_colour(c, l);
    cone.candela /= rgb_luminance(rgb_make(c[0], c[1], c[2])); /* programs multiply it by the colour */
    json_t *light = json_pack("{s:s, s:s, s:[f,f,f], s:f, s:{s:s, s:f}}", "name", l->name, "type",
                              is_cone ? "spot" : "point", "color", c[0], c[1], c[2], "intensity", cone.candela,
                              "extras", "ies", g->s->lamps->files[lamp], "lumens", export_lamps_lumens(l));
    if (is_cone)
        json_object_set_new(light, "spot",
                            json_pack("{s:f, s:f}", "innerConeAngle", cone.inner, "outerConeAngle", cone.outer));
    json_array_append_new(g->children, json_integer((json_int_t)json_array_size(g->nodes)));
    json_array_append_new(g->nodes,
                          json_pack("{s:s, s:o, s:{s:{s:I}}}", "name", l->name, "matrix", lamp_matrix(l), "extensions",
                                    "KHR_lights_punctual", "light", (json_int_t)json_array_size(g->lights)));
    json_array_append_new(g->lights, light);
    return g->err->status;
}

static enum status add_lamps(struct gltf *g)
{
    for (int i = 0; !g->err->status && i < g->s->lamps->planned.count; i++) add_lamp(g, i);
    return g->err->status;
}

/* An accessor of the corners of triangles. */
static enum status add_triangles(struct gltf *g, const struct thing_mesh *mesh, json_int_t *index)
{
    const size_t count = 3 * (size_t)mesh->triangle_count;
    uint32_t *corners = malloc((count + 1) * sizeof *corners);
    json_int_t view;
    if (!corners) return err_nomem(g->err, "triangles", count * sizeof *corners);
    for (size_t i = 0; i < count; i++) corners[i] = (uint32_t)mesh->triangles[i / 3][i % 3];
    if (!add_view(g, corners, count * sizeof *corners, TRIANGLES, &view)) {
        *index = (json_int_t)json_array_size(g->accessors);
        json_array_append_new(g->accessors, json_pack("{s:I, s:i, s:I, s:s}", "bufferView", view, "componentType",
                                                      INTEGERS, "count", (json_int_t)count, "type", "SCALAR"));
    }
    free(corners);
    return g->err->status;
}

static enum status add_thing(struct gltf *g, const struct export_thing *t)
{
    const struct thing_mesh *mesh = &t->mesh;
    const size_t count = (size_t)mesh->vertex_count;
    float *at = malloc((3 * count + 1) * sizeof *at);
    char name[MAX_OBJECT_NAME];
    json_int_t points = 0, triangles = 0;
    double c[3];
    snprintf(name, sizeof name, "thing/%s", t->name);
    export_thing_colour(c, t, g->s->exposure);
    if (!at) err_nomem(g->err, "vertices", 3 * count * sizeof *at);
    for (size_t i = 0; !g->err->status && i < count; i++) put_point(at + 3 * i, mesh->vertices[i]);
    if (!g->err->status && !add_vectors(g, at, count, 3, true, &points) && !add_triangles(g, mesh, &triangles)) {
        const json_int_t material = (json_int_t)json_array_size(g->materials);
        json_array_append_new(g->materials,
                              unlit(name, json_pack("{s:[f,f,f,f]}", "baseColorFactor", c[0], c[1], c[2], 1.0)));
        add_node(g, name,
                 json_pack("[{s:{s:I}, s:I, s:I, s:{s:[{s:s, s:i}]}}]", "attributes", "POSITION", points, "indices",
                           triangles, "material", material, "extras", "faces", "name", name, "first", 0));
    }
    free(at);
    return g->err->status;
}

static enum status add_things(struct gltf *g)
{
    for (int i = 0; !g->err->status && i < g->s->things->count; i++) add_thing(g, &g->s->things->things[i]);
    return g->err->status;
}

static enum status add_picture(struct gltf *g, json_t *images, json_t *textures, int page)
{
    char path[FILE_PATH], name[32];
    json_int_t view;
    snprintf(name, sizeof name, "page%d", page);
    if (product_path_in(path, g->s->out, PRODUCT_EXPORT_PAGE, &(struct product_key){.page = page}, g->err))
        return g->err->status;
    FILE *file = fopen(path, "rb");
    unsigned char *data = NULL;
    long size = -1;
    if (file && !fseek(file, 0, SEEK_END) && (size = ftell(file)) > 0 && !fseek(file, 0, SEEK_SET))
        data = malloc((size_t)size);
    const bool whole = data && fread(data, 1, (size_t)size, file) == (size_t)size;
    if (file) fclose(file);
    if (whole)
        add_view(g, data, (size_t)size, NO_TARGET, &view);
    else
        err_set(g->err, ST_IO, "%s cannot be read again.", path);
    free(data);
    if (g->err->status) return g->err->status;
    json_array_append_new(images,
                          json_pack("{s:s, s:I, s:s}", "name", name, "bufferView", view, "mimeType", "image/png"));
    json_array_append_new(textures, json_pack("{s:i, s:i}", "source", page, "sampler", 0));
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ file */

static void put_u32(FILE *to, size_t value)
{
    for (int k = 0; k < 4; k++) fputc((int)(value >> (8 * k) & 255), to);
}

static enum status write_file(struct gltf *g, const char *json)
{
    const size_t length = strlen(json), padded = (length + 3) / 4 * 4;
    struct outfile out = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, g->s->out, PRODUCT_EXPORT_GLB, NULL, g->err) && !outfile_open(&out, path, g->err)) {
        fputs("glTF", out.fp);
        put_u32(out.fp, 2);
        put_u32(out.fp, 12 + 8 + padded + 8 + g->bin.size);
        put_u32(out.fp, padded);
        fputs("JSON", out.fp);
        fputs(json, out.fp);
        for (size_t i = length; i < padded; i++) fputc(' ', out.fp);
        put_u32(out.fp, g->bin.size);
        fwrite("BIN", 1, 4, out.fp);
        fwrite(g->bin.data, 1, g->bin.size, out.fp);
        outfile_commit(&out, g->err);
    }
    outfile_discard(&out);
    return g->err->status;
}

/* Jansson's functions leave out what they have no memory for, and only say so one by one. This notes it for all. */
static bool starved;
static void *take(size_t size)
{
    void *p = malloc(size);
    if (!p) starved = true;
    return p;
}

enum status write_gltf(const struct export_scene *s, struct err *err)
{
    starved = false;
    json_set_alloc_funcs(take, free);
    struct gltf g = {.s = s, .err = err, .views = json_array(), .accessors = json_array(), .meshes = json_array()};
    g.nodes = json_array();
    g.materials = json_array();
    g.children = json_array();
    g.lights = json_array();
    json_t *images = json_array(), *textures = json_array();
    add_materials(&g);
    for (int i = 0; !err->status && i < s->page_count; i++) add_picture(&g, images, textures, i);
    if (!err->status && !add_bodies(&g) && !add_objects(&g) && !add_lamps(&g)) add_things(&g);
    json_t *root = json_pack("{s:{s:s, s:s}, s:[s], s:i, s:[{s:s, s:O}], s:O, s:O, s:O, s:O, s:O, s:[{s:I}]}", "asset",
                             "version", "2.0", "generator", "remodel " REMODEL_VERSION, "extensionsUsed",
                             "KHR_materials_unlit", "scene", 0, "scenes", "name", s->name, "nodes", g.children, "nodes",
                             g.nodes, "meshes", g.meshes, "materials", g.materials, "accessors", g.accessors,
                             "bufferViews", g.views, "buffers", "byteLength", (json_int_t)g.bin.size);
    if (s->page_count) {
        json_object_set(root, "images", images);
        json_object_set(root, "textures", textures);
        /* clamped at the edges, linear with mipmaps */
        json_object_set_new(
            root, "samplers",
            json_pack("[{s:i, s:i, s:i, s:i}]", "magFilter", 9729, "minFilter", 9987, "wrapS", 33071, "wrapT", 33071));
    }
    if (root && json_array_size(g.lights)) {
        json_array_append_new(json_object_get(root, "extensionsUsed"), json_string("KHR_lights_punctual"));
        json_object_set_new(root, "extensions", json_pack("{s:{s:O}}", "KHR_lights_punctual", "lights", g.lights));
    }
    char *text = root ? json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    if (!err->status && starved) err_nomem(err, "a glTF model", g.bin.size);
    if (!err->status && !text) err_set(err, ST_DATA, "the model cannot be written as glTF: a name is not UTF-8.");
    if (!err->status) write_file(&g, text);
    free(text);
    free(g.bin.data);
    json_decref(root);
    json_decref(images);
    json_decref(textures);
    json_decref(g.views);
    json_decref(g.accessors);
    json_decref(g.meshes);
    json_decref(g.nodes);
    json_decref(g.materials);
    json_decref(g.children);
    json_decref(g.lights);
    return err->status;
}
