/* obj_mesh.c - see obj_mesh.h. */
#include "common/light/obj_mesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/light/obj_normals.h"
#include "common/light/obj_polygon.h"

#define MAX_TRIANGLES (1 << 22)

struct obj_reader {
    struct textfile t;
    struct vec3 *vertices, *normals;
    int vertex_count, normal_count;
    struct obj_corner *polygon; /* of the line */
    int polygon_count;
    int crossed; /* polygons that cross themselves */
    struct obj_mesh *mesh;
    struct err *err;
};

void obj_mesh_release(struct obj_mesh *mesh)
{
    if (!mesh) return;
    free(mesh->triangles);
    free(mesh->normals);
    *mesh = (struct obj_mesh){0};
}

/* ------------------------------------------------------------------------------------------------------------ lines */

/* A line v or vn: appends to list. what: "a vertex". */
static enum status read_point(struct obj_reader *r, struct vec3 **list, int *count, const char *what)
{
    double v[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        char coordinate[64];
        snprintf(coordinate, sizeof coordinate, "%s's coordinate", what);
        if (textfile_double(&r->t, coordinate, &v[i], r->err)) return r->err->status;
        if (fabs(v[i]) > OBJ_MAX_COORDINATE)
            return textfile_error(&r->t, r->err, "a larger number", "%s, at most %g", coordinate, OBJ_MAX_COORDINATE);
    }
    if (array_append(list, (size_t)*count, sizeof **list, "vertices", r->err)) return r->err->status;
    (*list)[(*count)++] = vec3_make(v[0], v[1], v[2]);
    return ST_OK;
}

/* An index, from 1 or from -1 backwards, into `count` lines above; *index is from 0. */
static enum status read_index(struct obj_reader *r, const char *word, int count, const char *what, const char *line,
                              int *index)
{
    int64_t number = 0;
    const bool is_number = scan_int(word, &number) && number != 0;
    if (!is_number || number > count || number < -count)
        return textfile_error(&r->t, r->err, word,
                              "%s from 1 to %d, or from -1 backwards, of the lines %s above; export the mesh again",
                              what, count, line);
    *index = (int)(number > 0 ? number - 1 : count + number);
    return ST_OK;
}

/* "3", "3/1", "3//2" or "3/1/2": vertex, texture, normal. */
static enum status read_corner(struct obj_reader *r)
{
    char *word = NULL, *normal = NULL;
    int vertex = 0, of_normal = 0;
    if (textfile_word(&r->t, "a face's vertex, three or more", &word, r->err)) return r->err->status;
    char *slash = strchr(word, '/');
    if (slash && (normal = strchr(slash + 1, '/'))) normal++;
    if (slash) *slash = '\0';
    if (!r->vertex_count)
        return textfile_error(&r->t, r->err, word, "lines v with the vertices before the faces; export the mesh again");
    if (read_index(r, word, r->vertex_count, "a vertex", "v", &vertex) ||
        (normal && *normal && read_index(r, normal, r->normal_count, "a normal", "vn", &of_normal)) ||
        array_append(&r->polygon, (size_t)r->polygon_count, sizeof *r->polygon, "corners", r->err))
        return r->err->status;
    struct obj_corner *corner = &r->polygon[r->polygon_count++];
    *corner = (struct obj_corner){r->vertices[vertex], {0, 0, 0}};
    if (normal && *normal) corner->normal = obj_unit(r->normals[of_normal]);
    return ST_OK;
}

static enum status add_triangle(struct obj_reader *r, const int corners[3])
{
    struct obj_mesh *m = r->mesh;
    const struct obj_corner *c[3];
    for (int k = 0; k < 3; k++) c[k] = &r->polygon[corners[k]];
    const struct vec3 across = vec3_cross(vec3_sub(c[1]->at, c[0]->at), vec3_sub(c[2]->at, c[0]->at));
    if (!(vec3_length(across) > 0)) {
        m->dropped++;
        return ST_OK;
    }
    if (m->count == MAX_TRIANGLES)
        return textfile_error(&r->t, r->err, "one more", "at most %d triangles; simplify the mesh", MAX_TRIANGLES);
    if (array_append(&m->triangles, (size_t)m->count, sizeof *m->triangles, "triangles", r->err) ||
        array_append(&m->normals, (size_t)m->count, sizeof *m->normals, "normals", r->err))
        return r->err->status;
    for (int k = 0; k < 3; k++) {
        m->triangles[m->count][k] = c[k]->at;
        m->normals[m->count][k] = vec3_length(c[k]->normal) > 0 ? c[k]->normal : obj_unit(across);
    }
    m->count++;
    return ST_OK;
}

static enum status read_face(struct obj_reader *r)
{
    int *triangles = NULL, count = 0;
    bool crosses = false;
    r->polygon_count = 0;
    for (int k = 0; k < 3 || textfile_more(&r->t); k++)
        if (read_corner(r)) return r->err->status;
    obj_polygon_triangles(&triangles, &count, &crosses, r->polygon, r->polygon_count, r->err);
    for (int i = 0; !r->err->status && i < count; i++) add_triangle(r, triangles + 3 * (ptrdiff_t)i);
    free(triangles);
    r->crossed += crosses;
    return r->err->status;
}

static enum status read_line(struct obj_reader *r)
{
    char *word = NULL;
    if (textfile_word(&r->t, "v or f", &word, r->err)) return r->err->status;
    if (!strcmp(word, "v")) return read_point(r, &r->vertices, &r->vertex_count, "a vertex");
    if (!strcmp(word, "vn")) return read_point(r, &r->normals, &r->normal_count, "a normal");
    return !strcmp(word, "f") ? read_face(r) : ST_OK;
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
    if (!err->status && !r.normal_count) obj_normals_smooth(mesh, err);
    if (!err->status && r.crossed)
        log_note("%s: %d polygons cross themselves; they are filled from their first corners", path, r.crossed);
    if (!err->status && mesh->dropped)
        log_note("%s: %d of %d triangles have no area and are left out", path, mesh->dropped,
                 mesh->count + mesh->dropped);
    if (err->status) obj_mesh_release(mesh);
    textfile_release(&r.t);
    free(r.vertices);
    free(r.normals);
    free(r.polygon);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------- move */

/* The normals of a surface that m moves, times a factor: with the cofactors of m's 3 x 3 part. */
static struct vec3 moved_normal(const struct vec3 rows[3], struct vec3 n)
{
    return obj_unit(vec3_make(vec3_dot(vec3_cross(rows[1], rows[2]), n), vec3_dot(vec3_cross(rows[2], rows[0]), n),
                              vec3_dot(vec3_cross(rows[0], rows[1]), n)));
}

void obj_mesh_move(struct obj_mesh *mesh, const double m[3][4])
{
    struct vec3 rows[3];
    for (int k = 0; k < 3; k++) rows[k] = vec3_make(m[k][0], m[k][1], m[k][2]);
    for (int i = 0; i < mesh->count; i++)
        for (int k = 0; k < 3; k++) {
            const struct vec3 p = mesh->triangles[i][k];
            mesh->triangles[i][k] = vec3_make(vec3_dot(rows[0], p) + m[0][3], vec3_dot(rows[1], p) + m[1][3],
                                              vec3_dot(rows[2], p) + m[2][3]);
            mesh->normals[i][k] = moved_normal(rows, mesh->normals[i][k]);
        }
}
