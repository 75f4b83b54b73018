/* mesh_file.c - see mesh_file.h. */
#include "stages/simulate/mesh_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "stages/simulate/description.h"

#define MAX_TRIANGLES (1 << 22)

struct mesh {
    struct vec3 *vertices;
    struct vec3 (*triangles)[3];
    int vertex_count, triangle_count;
};

static enum status read_vertex(struct mesh *m, struct textfile *t, struct err *err)
{
    double v[3] = {0, 0, 0};
    enum status st = ST_OK;
    for (int i = 0; !st && i < 3; i++) {
        st = textfile_double(t, "a vertex's coordinate", &v[i], err);
        if (!st && fabs(v[i]) > MAX_METRES)
            st = textfile_error(t, err, "a larger number", "a vertex's coordinate, at most %g", MAX_METRES);
    }
    if (!st) st = array_append(&m->vertices, (size_t)m->vertex_count, sizeof *m->vertices, "vertices", err);
    if (!st) m->vertices[m->vertex_count++] = vec3_make(v[0], v[1], v[2]);
    return st;
}

static enum status read_corner(const struct mesh *m, struct textfile *t, struct vec3 *corner, struct err *err)
{
    char *word = NULL, *slash;
    int64_t index = 0;
    enum status st = textfile_word(t, "a face's vertex", &word, err);
    if (st) return st;
    if ((slash = strchr(word, '/'))) *slash = '\0';
    if (!scan_int(word, &index) || index == 0 || index > m->vertex_count || -index > m->vertex_count)
        return textfile_error(t, err, word, "a vertex from 1 to %d, or from -1 backwards", m->vertex_count);
    *corner = m->vertices[index > 0 ? index - 1 : m->vertex_count + index];
    return ST_OK;
}

static enum status read_face(struct mesh *m, struct textfile *t, struct err *err)
{
    struct vec3 first = {0, 0, 0}, before = {0, 0, 0}, corner = {0, 0, 0};
    enum status st = read_corner(m, t, &first, err);
    if (!st) st = read_corner(m, t, &before, err);
    do {
        if (!st) st = read_corner(m, t, &corner, err);
        if (!st && m->triangle_count == MAX_TRIANGLES)
            st = textfile_error(t, err, "one more", "at most %d triangles", MAX_TRIANGLES);
        if (!st) st = array_append(&m->triangles, (size_t)m->triangle_count, sizeof *m->triangles, "triangles", err);
        if (!st) {
            struct vec3 *triangle = m->triangles[m->triangle_count];
            triangle[0] = first;
            triangle[1] = before;
            triangle[2] = corner;
            const struct vec3 n = vec3_cross(vec3_sub(before, first), vec3_sub(corner, first));
            if (vec3_length(n) > 0) m->triangle_count++; /* triangles without area are left out */
        }
        before = corner;
    } while (!st && textfile_more(t));
    return st;
}

enum status mesh_file_read(struct vec3 (**triangles)[3], int *count, const char *path, struct err *err)
{
    struct textfile t = {0};
    struct mesh m = {0};
    enum status st = textfile_open(&t, path, err);
    while (!st && textfile_next(&t)) {
        char *word = NULL;
        st = textfile_word(&t, "v or f", &word, err);
        if (!st && !strcmp(word, "v"))
            st = read_vertex(&m, &t, err);
        else if (!st && !strcmp(word, "f"))
            st = read_face(&m, &t, err);
    }
    if (!st && !m.triangle_count)
        st = err_set(err, ST_DATA,
                     "%s has no faces with an area (lines that begin with f); export it as Wavefront OBJ.", path);
    textfile_release(&t);
    free(m.vertices);
    if (st) free(m.triangles);
    *triangles = st ? NULL : m.triangles;
    *count = st ? 0 : m.triangle_count;
    return st;
}
