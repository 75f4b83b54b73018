/* solid_mesh_file.c - reads and writes model.txt, writes OBJ.
 *
 * model.txt (docs/formats.md) has vertices, then bodies with their faces, each with its loops of vertex numbers.
 * Numbers have 17 digits, so that a model that was read is the model that was written, to the bit. Names are quoted.
 *
 * Counts come first, but nothing is allocated by them: arrays grow with the records that are really there, so a
 * damaged count costs an error and not the memory. Polygons hold offsets until the end, because growing arrays move.
 *
 * The reader builds the mesh by solid_mesh_make(), whose checks thus hold for every file; an error is brought back
 * to the line of the face. Faces of one name must have one id, and no two names may share one: ids are sorted to
 * find that, O(n log n). */
#include <inttypes.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"
#include "common/model/solid_mesh.h"
#include "common/product/product.h"

enum { MAX_COUNT = 100000000, NAME_SIZE = 1024 };

/* ------------------------------------------------------------------------------------------------------- model.txt */

static void write_loop(const struct solid_mesh *mesh, int loop, FILE *to)
{
    const int first = mesh->loops[loop].half_edge;
    int h = first, count = 0;
    do {
        count++;
        h = mesh->half_edges[h].next;
    } while (h != first);
    fprintf(to, "loop %d", count);
    do {
        fprintf(to, " %d", mesh->half_edges[h].origin);
        h = mesh->half_edges[h].next;
    } while (h != first);
    fputc('\n', to);
}

enum status solid_mesh_write(const struct solid_mesh *mesh, const char *path, const struct provenance *prov,
                             struct err *err)
{
    struct outfile f = {0};
    char name[NAME_SIZE];
    if (!product_begin(&f, PRODUCT_MODEL, path, prov, err)) fprintf(f.fp, "vertices %d\n", mesh->vertex_count);
    for (int i = 0; !err->status && i < mesh->vertex_count; i++) {
        const struct vec3 p = mesh->vertices[i].p;
        fprintf(f.fp, "vertex %.17g %.17g %.17g\n", p.x, p.y, p.z);
    }
    if (!err->status) fprintf(f.fp, "bodies %d\n", mesh->body_count);
    for (int b = 0; !err->status && b < mesh->body_count; b++) {
        if (!textfile_quote(mesh->bodies[b].name, name, sizeof name, err))
            fprintf(f.fp, "body %s %d\n", name, mesh->bodies[b].faces);
        for (int i = mesh->bodies[b].face; !err->status && i < mesh->bodies[b].face + mesh->bodies[b].faces; i++) {
            const struct solid_face *o = &mesh->faces[i];
            if (textfile_quote(solid_face_name(mesh, i), name, sizeof name, err)) break;
            fprintf(f.fp, "face %d %s %.17g %.17g %.17g %.17g %d\n", solid_face_id(mesh, i), name, o->normal.x,
                    o->normal.y, o->normal.z, o->offset, o->loops);
            for (int l = o->loop; l < o->loop + o->loops; l++) write_loop(mesh, l, f.fp);
        }
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

struct mesh_reader { /* the records so far; offsets replace pointers until the end */
    struct vec3 *vertices;
    struct solid_polygon *polygons;
    int *ids, *lines, *corners, *sizes;
    size_t *at; /* of each polygon in corners, in sizes */
    int vertex_count, vertex_capacity, polygon_count, polygon_capacity, id_capacity, line_capacity, corner_count;
    int corner_capacity, size_count, size_capacity, at_capacity;
};

static enum status grow(void *items, int *capacity, int need, size_t size, struct err *err)
{
    void *old;
    if (need <= *capacity) return ST_OK;
    if (need > INT_MAX / 2 - 16) return err_nomem(err, "a model", (size_t)need * size);
    const int more = need + need / 2 + 16;
    memcpy(&old, items, sizeof old);
    void *grown = realloc(old, (size_t)more * size);
    if (!grown) return err_nomem(err, "a model", (size_t)more * size);
    memcpy(items, &grown, sizeof grown);
    *capacity = more;
    return ST_OK;
}

static enum status next_line(struct textfile *t, const char *word, struct err *err)
{
    char *found, wanted[48];
    snprintf(wanted, sizeof wanted, "a line \"%s ...\"", word);
    if (!textfile_next(t)) return textfile_error(t, err, NULL, "%s", wanted);
    if (textfile_word(t, wanted, &found, err)) return err->status;
    return strcmp(found, word) ? textfile_error(t, err, found, "%s", wanted) : ST_OK;
}

static enum status read_loop(struct textfile *t, struct mesh_reader *r, struct err *err)
{
    int64_t count, v;
    if (next_line(t, "loop", err) || textfile_int(t, "number of corners", 3, MAX_COUNT, &count, err) ||
        grow(&r->sizes, &r->size_capacity, r->size_count + 1, sizeof *r->sizes, err))
        return err->status;
    r->sizes[r->size_count++] = (int)count;
    for (int64_t i = 0; i < count; i++) {
        if (textfile_int(t, "a vertex, counted from 0", 0, r->vertex_count - 1, &v, err) ||
            grow(&r->corners, &r->corner_capacity, r->corner_count + 1, sizeof *r->corners, err))
            return err->status;
        r->corners[r->corner_count++] = (int)v;
    }
    return textfile_end(t, err);
}

static enum status read_face(struct textfile *t, struct mesh_reader *r, const char *body, struct err *err)
{
    struct solid_polygon p = {.body = body};
    int64_t id, loops;
    char *name;
    const int n = r->polygon_count;
    if (next_line(t, "face", err) || textfile_int(t, "id", 1, INT_MAX - 1, &id, err) ||
        textfile_word(t, "the face's name", &name, err) || textfile_double(t, "x of the normal", &p.normal.x, err) ||
        textfile_double(t, "y of the normal", &p.normal.y, err) ||
        textfile_double(t, "z of the normal", &p.normal.z, err) || textfile_double(t, "offset", &p.offset, err) ||
        textfile_int(t, "number of loops", 1, MAX_COUNT, &loops, err) || textfile_end(t, err) ||
        grow(&r->polygons, &r->polygon_capacity, n + 1, sizeof *r->polygons, err) ||
        grow(&r->ids, &r->id_capacity, n + 1, sizeof *r->ids, err) ||
        grow(&r->lines, &r->line_capacity, n + 1, sizeof *r->lines, err) ||
        grow(&r->at, &r->at_capacity, 2 * n + 2, sizeof *r->at, err))
        return err->status;
    if (!*name) return textfile_error(t, err, name, "the face's name");
    p.name = name;
    p.loops = (int)loops;
    r->ids[n] = (int)id;
    r->lines[n] = t->line;
    r->at[2 * n] = (size_t)r->corner_count;
    r->at[2 * n + 1] = (size_t)r->size_count;
    r->polygons[n] = p;
    r->polygon_count++;
    for (int64_t i = 0; i < loops; i++)
        if (read_loop(t, r, err)) return err->status;
    return ST_OK;
}

static enum status read_records(struct textfile *t, struct mesh_reader *r, struct err *err)
{
    int64_t count, faces;
    char *body;
    if (next_line(t, "vertices", err) || textfile_int(t, "number of vertices", 0, MAX_COUNT, &count, err) ||
        textfile_end(t, err))
        return err->status;
    for (int64_t i = 0; i < count; i++) {
        struct vec3 p;
        if (next_line(t, "vertex", err) || textfile_double(t, "x", &p.x, err) || textfile_double(t, "y", &p.y, err) ||
            textfile_double(t, "z", &p.z, err) || textfile_end(t, err) ||
            grow(&r->vertices, &r->vertex_capacity, r->vertex_count + 1, sizeof *r->vertices, err))
            return err->status;
        r->vertices[r->vertex_count++] = p;
    }
    if (next_line(t, "bodies", err) || textfile_int(t, "number of bodies", 0, MAX_COUNT, &count, err) ||
        textfile_end(t, err))
        return err->status;
    for (int64_t i = 0; i < count; i++) {
        if (next_line(t, "body", err) || textfile_word(t, "the body's name", &body, err) ||
            textfile_int(t, "number of faces", 1, MAX_COUNT, &faces, err) || textfile_end(t, err))
            return err->status;
        if (!*body) return textfile_error(t, err, body, "the body's name");
        for (int64_t k = 0; k < faces; k++)
            if (read_face(t, r, body, err)) return err->status;
    }
    if (!textfile_next(t)) return ST_OK;
    char *word;
    return textfile_rest(t, "the end", &word, err) ? err->status : textfile_error(t, err, word, "the end of the file");
}

struct id_line {
    int id, name, line;
};

static int compare_ids(const void *a, const void *b)
{
    const struct id_line *p = a, *q = b;
    if (p->id != q->id) return p->id < q->id ? -1 : 1;
    return (p->line > q->line) - (p->line < q->line);
}

/* Sets the file's ids: one for each name, different for different names. */
static enum status set_ids(struct solid_mesh *mesh, const struct mesh_reader *r, const char *path, struct err *err)
{
    int *ids = calloc((size_t)mesh->name_count + 1, sizeof *ids);
    struct id_line *all = malloc(((size_t)mesh->face_count + 1) * sizeof *all);
    char quoted[SCAN_QUOTED];
    if (!ids || !all) err_nomem(err, "ids of faces", (size_t)mesh->face_count * sizeof *all);
    for (int i = 0; !err->status && i < mesh->face_count; i++) {
        int *id = &ids[mesh->faces[i].name];
        if (*id && *id != r->ids[i])
            err_set(err, ST_DATA, "%s:%d: found id %d for %s, wanted %d, as before.", path, r->lines[i], r->ids[i],
                    scan_quote(quoted, solid_face_name(mesh, i)), *id);
        *id = r->ids[i];
        all[i] = (struct id_line){r->ids[i], mesh->faces[i].name, r->lines[i]};
    }
    if (!err->status && mesh->face_count) qsort(all, (size_t)mesh->face_count, sizeof *all, compare_ids);
    for (int i = 1; !err->status && i < mesh->face_count; i++)
        if (all[i].id == all[i - 1].id && all[i].name != all[i - 1].name)
            err_set(err, ST_DATA, "%s:%d: found id %d for %s, wanted an id that no other name has.", path, all[i].line,
                    all[i].id, scan_quote(quoted, mesh->names[all[i].name].name));
    if (!err->status) solid_mesh_set_ids(mesh, ids, err);
    free(ids);
    free(all);
    return err->status;
}

enum status solid_mesh_read(struct solid_mesh *mesh, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    struct mesh_reader r = {0};
    int faulty = -1;
    *mesh = (struct solid_mesh){0};
    if (!product_open(&t, NULL, PRODUCT_MODEL, path, prov, err)) read_records(&t, &r, err);
    for (int i = 0; !err->status && i < r.polygon_count; i++) {
        r.polygons[i].corners = r.corners + r.at[2 * i];
        r.polygons[i].sizes = r.sizes + r.at[2 * i + 1];
    }
    if (!err->status) {
        solid_mesh_make(mesh, r.vertices, r.vertex_count, r.polygons, r.polygon_count, &faulty, err);
        if (err->status == ST_DATA && faulty >= 0)
            err_context(err, "%s:%d", path, r.lines[faulty]);
        else if (err->status)
            err_context(err, "%s", path);
    }
    if (!err->status) set_ids(mesh, &r, path, err);
    free(r.vertices);
    free(r.polygons);
    free(r.ids);
    free(r.lines);
    free(r.corners);
    free(r.sizes);
    free(r.at);
    textfile_release(&t);
    if (err->status) solid_mesh_release(mesh);
    return err->status;
}
