/* light_objects.c - see light_objects.h.
 *
 * Elements. Triangles of an object whose middles lie in one cell of a grid of `side`, and whose normals are nearest to
 * one of the six axes, are an element. Its point is the middle of its largest triangle, so that it lies on the surface.
 * The back of a triangle is an element of its own: an open mesh, a screen or a leaf, is lit from both sides. */
#include "common/relight/light_objects.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/math/numbers.h"
#include "common/product/product.h"

enum { MAX_TRIANGLES = 4000000 };

/* -------------------------------------------------------------------------------------------------------- triangles */

static enum status add_triangle(struct light_objects *o, const struct vec3 t[3], int object, struct err *err)
{
    if (o->count >= MAX_TRIANGLES)
        return err_set(err, ST_DATA, "the object %s makes more than %d triangles; give a coarser mesh.",
                       o->list.items[object].name, MAX_TRIANGLES);
    if (array_append(&o->triangles, (size_t)o->count, sizeof *o->triangles, "triangles", err) ||
        array_append(&o->object, (size_t)o->count, sizeof *o->object, "triangles", err) ||
        array_append(&o->facet, (size_t)o->count, sizeof *o->facet, "triangles", err))
        return err->status;
    memcpy(o->triangles[o->count], t, sizeof *o->triangles);
    o->facet[o->count] = o->facet_count - 1;
    o->object[o->count++] = object;
    return ST_OK;
}

/* Halves a triangle across its longest side until no side is longer than `side`. */
static enum status cut_triangle(struct light_objects *o, const struct vec3 t[3], int object, double side, int depth,
                                struct err *err)
{
    int longest = 0;
    double most = 0;
    for (int k = 0; k < 3; k++) {
        const double length = vec3_length(vec3_sub(t[(k + 1) % 3], t[k]));
        if (length > most) most = length, longest = k;
    }
    if (most <= side || depth > 24) return add_triangle(o, t, object, err);
    const struct vec3 a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3];
    const struct vec3 middle = vec3_scale(vec3_add(a, b), 0.5);
    const struct vec3 halves[2][3] = {{a, middle, c}, {middle, b, c}};
    for (int k = 0; k < 2; k++)
        if (cut_triangle(o, halves[k], object, side, depth + 1, err)) return err->status;
    return ST_OK;
}

static enum status add_facet(struct light_objects *o, const struct obj_mesh *mesh, int i, int object, double side,
                             struct err *err)
{
    if (array_append(&o->facets, (size_t)o->facet_count, sizeof *o->facets, "triangles", err)) return err->status;
    struct obj_facet *f = &o->facets[o->facet_count++];
    memcpy(f->corners, mesh->triangles[i], sizeof f->corners);
    memcpy(f->normals, mesh->normals[i], sizeof f->normals);
    return cut_triangle(o, mesh->triangles[i], object, side, 0, err);
}

static enum status read_object(struct light_objects *o, int object, const char *folder, double side,
                               struct provenance *prov, struct err *err)
{
    struct obj_mesh mesh = {0};
    char name[FILE_PATH];
    const struct object *item = &o->list.items[object];
    object_mesh_read(&mesh, item, folder, err); /* which compares the hash */
    if (!err->status) file_path(name, "objects", item->file, "", err);
    if (!err->status && prov) provenance_add_hash(prov, name, item->hash, err);
    for (int i = 0; !err->status && i < mesh.count; i++) add_facet(o, &mesh, i, object, side, err);
    obj_mesh_release(&mesh);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- elements */

struct patch { /* one side of a triangle */
    int object, triangle, side, way;
    int64_t cell[3];
    double area;
};

static int same_or_order(const struct patch *p, const struct patch *q)
{
    if (p->object != q->object) return p->object < q->object ? -1 : 1;
    if (p->way != q->way) return p->way < q->way ? -1 : 1;
    for (int k = 0; k < 3; k++)
        if (p->cell[k] != q->cell[k]) return p->cell[k] < q->cell[k] ? -1 : 1;
    return 0;
}

static int by_place(const void *a, const void *b)
{
    const struct patch *p = a, *q = b;
    const int order = same_or_order(p, q);
    if (order) return order;
    if (p->area != q->area) return p->area > q->area ? -1 : 1;
    if (p->triangle != q->triangle) return p->triangle < q->triangle ? -1 : 1;
    return p->side - q->side;
}

static struct vec3 middle_of(const struct vec3 t[3])
{
    return vec3_scale(vec3_add(t[0], vec3_add(t[1], t[2])), 1.0 / 3);
}

static struct vec3 normal_of(const struct vec3 t[3])
{
    return vec3_normalize(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0])));
}

static struct patch patch_of(const struct light_objects *o, int triangle, int side, double width)
{
    const struct vec3 *t = o->triangles[triangle];
    const struct vec3 m = middle_of(t), n = vec3_scale(normal_of(t), side ? -1 : 1);
    const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    struct patch p = {.object = o->object[triangle], .triangle = triangle, .side = side};
    if (x >= y && x >= z)
        p.way = n.x > 0 ? 0 : 1;
    else if (y >= z)
        p.way = n.y > 0 ? 2 : 3;
    else
        p.way = n.z > 0 ? 4 : 5;
    p.cell[0] = (int64_t)floor(m.x / width), p.cell[1] = (int64_t)floor(m.y / width);
    p.cell[2] = (int64_t)floor(m.z / width);
    p.area = vec3_length(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0])));
    return p;
}

static enum status find_elements(struct light_objects *o, double side, struct err *err)
{
    const size_t count = 2 * (size_t)o->count;
    struct patch *patches = malloc((count + 1) * sizeof *patches);
    o->element = calloc((size_t)o->count + 1, sizeof *o->element);
    o->radiance = calloc((size_t)o->count + 1, sizeof *o->radiance);
    o->elements = calloc(count + 1, sizeof *o->elements);
    if (!patches || !o->element || !o->radiance || !o->elements) {
        free(patches);
        return err_nomem(err, "elements of objects", count * sizeof *patches);
    }
    for (size_t i = 0; i < count; i++) patches[i] = patch_of(o, (int)(i / 2), (int)(i % 2), side);
    qsort(patches, count, sizeof *patches, by_place);
    for (size_t i = 0; i < count; i++) {
        const struct patch *p = &patches[i];
        if (!i || same_or_order(p - 1, p)) {
            const struct vec3 n = vec3_scale(normal_of(o->triangles[p->triangle]), p->side ? -1 : 1);
            o->elements[o->element_count++] =
                (struct object_element){p->object, {middle_of(o->triangles[p->triangle]), n}, rgb_grey(0)};
        }
        o->element[p->triangle][p->side] = o->element_count - 1;
    }
    free(patches);
    return ST_OK;
}

enum status light_objects_read(struct light_objects *o, const char *path, const char *folder, double side,
                               struct provenance *prov, struct err *err)
{
    *o = (struct light_objects){0};
    if (!path) return ST_OK;
    if (object_list_read(&o->list, path, prov, err)) return err->status;
    for (int i = 0; i < o->list.count; i++)
        if (read_object(o, i, folder, side, prov, err)) return err->status;
    return find_elements(o, side, err);
}

void light_objects_release(struct light_objects *o)
{
    if (!o) return;
    object_list_release(&o->list);
    free(o->triangles);
    free(o->facet);
    free(o->facets);
    free(o->object);
    free(o->element);
    free(o->elements);
    free(o->radiance);
    *o = (struct light_objects){0};
}

struct gather_point light_objects_point(const struct light_objects *o, int triangle, struct vec3 at, struct vec3 facing)
{
    const struct obj_facet *f = &o->facets[o->facet[triangle]];
    const struct vec3 *corners = f->corners, *normals = f->normals;
    const struct vec3 flat = vec3_cross(vec3_sub(corners[1], corners[0]), vec3_sub(corners[2], corners[0]));
    const double side = vec3_dot(flat, facing) < 0 ? -1 : 1, area = vec3_dot(flat, flat);
    struct vec3 normal = {0, 0, 0}, offset = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        const struct vec3 *a = &corners[(k + 1) % 3], *b = &corners[(k + 2) % 3];
        const double weight = clamp(vec3_dot(vec3_cross(vec3_sub(*a, at), vec3_sub(*b, at)), flat) / area, 0, 1);
        const struct vec3 n = vec3_scale(normals[k], side);
        const double below = fmin(0, vec3_dot(vec3_sub(at, corners[k]), n)); /* of the corner's tangent plane */
        normal = vec3_add(normal, vec3_scale(n, weight));
        offset = vec3_add(offset, vec3_scale(n, -weight * below));
    }
    normal = vec3_normalize(normal);
    if (!(vec3_dot(normal, facing) > 0)) return (struct gather_point){at, facing}; /* a sliver, or normals that lie */
    return (struct gather_point){vec3_add(at, offset), normal};
}

void light_objects_set_radiance(struct light_objects *o)
{
    for (int i = 0; i < o->count; i++)
        for (int side = 0; side < 2; side++) {
            const struct rgb albedo = o->list.items[o->object[i]].brdf.albedo;
            o->radiance[i][side] = rgb_scale(rgb_multiply(albedo, o->elements[o->element[i][side]].irradiance), 1 / PI);
        }
}

/* ------------------------------------------------------------------------------------------------------------ files */

enum status light_objects_write_light(const struct light_objects *o, const char *path, const struct provenance *prov,
                                      struct err *err)
{
    struct outfile f = {0};
    if (outfile_open(&f, path, err)) return err->status;
    fprintf(f.fp, "%s\n", products[PRODUCT_OBJECT_LIGHT].head);
    provenance_print(prov, f.fp);
    for (int i = 0; i < o->element_count; i++) {
        const struct rgb e = o->elements[i].irradiance;
        fprintf(f.fp, "element %.9g %.9g %.9g\n", e.r, e.g, e.b);
    }
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

static enum status read_element(struct light_objects *o, int i, struct textfile *t, struct err *err)
{
    double e[3];
    if (i >= o->element_count) return textfile_error(t, err, "an element", "no more than the objects' %d", i);
    if (textfile_expect(t, "element", err)) return err->status;
    for (int k = 0; k < 3; k++)
        if (textfile_number(t, "an irradiance", 0, INFINITY, &e[k], err)) return err->status;
    o->elements[i].irradiance = rgb_make(e[0], e[1], e[2]);
    return textfile_end(t, err);
}

enum status light_objects_read_light(struct light_objects *o, const char *path, struct provenance *prov,
                                     struct err *err)
{
    struct textfile t = {0};
    int count = 0;
    product_open(&t, NULL, PRODUCT_OBJECT_LIGHT, path, prov, err);
    while (!err->status && textfile_next(&t)) read_element(o, count++, &t, err);
    if (!err->status && count < o->element_count)
        textfile_error(&t, err, NULL, "%d elements, as many as the objects have; update the VITA again",
                       o->element_count);
    textfile_release(&t);
    if (!err->status) light_objects_set_radiance(o);
    return err->status;
}
