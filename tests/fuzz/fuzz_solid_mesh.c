/* fuzz_solid_mesh.c - model.txt: any bytes give a consistent mesh, which can be checked, triangulated, and written and
 * read back unchanged, or an error. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/model/solid_mesh.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void use(const struct solid_mesh *mesh)
{
    struct solid_triangles triangles = {0};
    struct err err = ERR_INIT;
    for (int h = 0; h < mesh->half_edge_count; h++) {
        const struct solid_half_edge *e = &mesh->half_edges[h];
        if (mesh->half_edges[e->twin].twin != h || mesh->half_edges[e->next].prev != h) abort();
    }
    if (solid_mesh_check(mesh, 0, NULL, &err) && !*err.text) abort(); /* coordinates are arbitrary */
    err = (struct err)ERR_INIT;
    if (solid_mesh_triangulate(&triangles, mesh, &err)) {
        if (!*err.text || triangles.triangles) abort();
        return;
    }
    if (triangles.first[mesh->face_count] != triangles.count) abort();
    solid_triangles_release(&triangles);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct solid_mesh mesh, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (solid_mesh_read(&mesh, path, NULL, &err)) {
        if (!strstr(err.text, path) || mesh.faces || mesh.face_count) abort();
    } else {
        use(&mesh);
        if (!solid_mesh_write(&mesh, path, NULL, &err)) { /* a name may be too long to write */
            if (solid_mesh_read(&again, path, NULL, &err) || again.face_count != mesh.face_count) abort();
            for (int i = 0; i < mesh.face_count; i++)
                if (solid_face_id(&mesh, i) != solid_face_id(&again, i) ||
                    strcmp(solid_face_name(&mesh, i), solid_face_name(&again, i)))
                    abort();
            for (int i = 0; i < mesh.vertex_count; i++)
                if (memcmp(&mesh.vertices[i].p, &again.vertices[i].p, sizeof again.vertices[i].p)) abort();
            solid_mesh_release(&again);
        }
        solid_mesh_release(&mesh);
    }
    unlink(path);
    return 0;
}
