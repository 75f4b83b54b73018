/* fuzz_obj_mesh.c - OBJ meshes: any bytes give triangles with an area, finite corners and unit normals, or an error
 * with the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/light/obj_mesh.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check(const struct obj_mesh *mesh)
{
    if (mesh->count < 1 || mesh->dropped < 0) abort();
    for (int i = 0; i < mesh->count; i++) {
        const struct vec3 *t = mesh->triangles[i];
        if (!(vec3_length(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0]))) > 0)) abort();
        for (int k = 0; k < 3; k++)
            if (!(fabs(vec3_length(mesh->normals[i][k]) - 1) < 1e-9)) abort();
        for (int k = 0; k < 3; k++)
            if (!(fmax(fabs(t[k].x), fmax(fabs(t[k].y), fabs(t[k].z))) <= OBJ_MAX_COORDINATE)) abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct obj_mesh mesh;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (obj_mesh_read(&mesh, path, &err)) {
        if (!strstr(err.text, path) || mesh.triangles || mesh.count) abort();
    } else {
        check(&mesh);
        obj_mesh_release(&mesh);
    }
    unlink(path);
    return 0;
}
