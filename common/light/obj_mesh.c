/* obj_mesh.c - see obj_mesh.h. */
#include "common/light/obj_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

#define MAX_TRIANGLES (1 << 22)

struct obj_reader {
    struct textfile t;
    struct vec3 *vertices;
    int vertex_count;
    struct obj_mesh *mesh;
    struct err *err;
};

void obj_mesh_release(struct obj_mesh *mesh)
{
    if (!mesh) return;
    free(mesh->triangles);
    *mesh = (struct obj_mesh){0};
}

static enum status read_vertex(struct obj_reader *r)
{
    double v[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        if (textfile_double(&r->t, "a vertex's coordinate", &v[i], r->err)) return r->err->status;
        if (fabs(v[i]) > OBJ_MAX_COORDINATE)
            return textfile_error(&r->t, r->err, "a larger number", "a vertex's coordinate, at most %g",
                                  OBJ_MAX_COORDINATE);
    }
    if (array_append(&r->vertices, (size_t)r->vertex_count, sizeof *r->vertices, "vertices", r->err))
        return r->err->status;
    r->vertices[r->vertex_count++] = vec3_make(v[0], v[1], v[2]);
    return ST_OK;
}

static enum status read_corner(struct obj_reader *r, struct vec3 *corner)
{
    char *word = NULL, *slash;
    int64_t index = 0;
    if (textfile_word(&r->t, "a face's vertex, three or more", &word, r->err)) return r->err->status;
    if ((slash = strchr(word, '/'))) *slash = '\0';
    const bool number = scan_int(word, &index) && index != 0;
    if (!r->vertex_count)
        return textfile_error(&r->t, r->err, word, "lines v with the vertices before the faces; export the mesh again");
    if (!number || index > r->vertex_count || index < -r->vertex_count)
        return textfile_error(
            &r->t, r->err, word,
            "a vertex from 1 to %d, or from -1 backwards, of the lines v above; export the mesh again",
            r->vertex_count);
    *corner = r->vertices[index > 0 ? index - 1 : r->vertex_count + index];
    return ST_OK;
}

static enum status add_triangle(struct obj_reader *r, struct vec3 a, struct vec3 b, struct vec3 c)
{
    struct obj_mesh *m = r->mesh;
    if (!(vec3_length(vec3_cross(vec3_sub(b, a), vec3_sub(c, a))) > 0)) {
        m->dropped++;
        return ST_OK;
    }
    if (m->count == MAX_TRIANGLES)
        return textfile_error(&r->t, r->err, "one more", "at most %d triangles; simplify the mesh", MAX_TRIANGLES);
    if (array_append(&m->triangles, (size_t)m->count, sizeof *m->triangles, "triangles", r->err)) return r->err->status;
    struct vec3 *triangle = m->triangles[m->count++];
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
    return ST_OK;
}

static enum status read_face(struct obj_reader *r)
{
    struct vec3 first, before, corner;
    if (read_corner(r, &first) || read_corner(r, &before)) return r->err->status;
    do {
        if (read_corner(r, &corner) || add_triangle(r, first, before, corner)) return r->err->status;
        before = corner;
    } while (textfile_more(&r->t));
    return ST_OK;
}

static enum status read_line(struct obj_reader *r)
{
    char *word = NULL;
    if (textfile_word(&r->t, "v or f", &word, r->err)) return r->err->status;
    return !strcmp(word, "v") ? read_vertex(r) : !strcmp(word, "f") ? read_face(r) : ST_OK;
}

enum status obj_mesh_read(struct obj_mesh *mesh, const char *path, struct err *err)
{
    struct obj_reader r = {.mesh = mesh, .err = err};
    *mesh = (struct obj_mesh){0};
    textfile_open(&r.t, path, err);
    while (!err->status && textfile_next(&r.t)) read_line(&r);
    if (!err->status && !mesh->count)
        err_set(err, ST_DATA, "%s has no faces with an area (lines that begin with f); export it as Wavefront OBJ.",
                path);
    if (!err->status && mesh->dropped)
        log_note("%s: %d of %d triangles have no area and are left out", path, mesh->dropped,
                 mesh->count + mesh->dropped);
    if (err->status) obj_mesh_release(mesh);
    textfile_release(&r.t);
    free(r.vertices);
    return err->status;
}

void obj_mesh_move(struct obj_mesh *mesh, const double m[3][4])
{
    for (int i = 0; i < mesh->count; i++)
        for (int k = 0; k < 3; k++) {
            const struct vec3 p = mesh->triangles[i][k];
            double to[3];
            for (int row = 0; row < 3; row++) to[row] = m[row][0] * p.x + m[row][1] * p.y + m[row][2] * p.z + m[row][3];
            mesh->triangles[i][k] = vec3_make(to[0], to[1], to[2]);
        }
}
