/* unite.c - time of the union of walls: a house of equal rooms, each wall with a window.
 *
 *   unite [--walls N] [--turned DEGREES]
 *
 * The rooms form a square grid on one floor slab, with at least N walls; each wall is cut into four boxes around its
 * window and reaches into its corners. --turned rotates the house, so that no wall is along an axis. Prints "seconds S"
 * (the union), "check_s S", "triangulate_s S", "error E" (relative error of the volume), "walls N", "solids N",
 * "faces N", "vertices N", "genus N". */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/base/scan.h"
#include "stages/build_model/solid/unite.h"

#define ROOM      4.0
#define THICKNESS 0.2
#define HEIGHT    2.6
#define WINDOW    1.2 /* width and height of a window */

struct house {
    struct solid_list list;
    double angle; /* radians */
};

/* A box of the house before the rotation; `along` 1: x and y are swapped. */
static enum status add(struct house *h, const char *name, int along, struct vec3 low, struct vec3 high, struct err *err)
{
    static const char *const sides[6] = {"start", "end", "out", "in", "bottom", "top"};
    const double c = cos(h->angle), s = sin(h->angle);
    const struct vec3 x = {c, s, 0}, y = {-s, c, 0}, z = {0, 0, 1};
    const struct vec3 axes[3] = {along ? y : x, along ? x : y, z};
    const double from[3] = {low.x, low.y, low.z}, to[3] = {high.x, high.y, high.z};
    struct half_space spaces[6];
    char names[6][64];
    for (int i = 0; i < 6; i++) {
        snprintf(names[i], sizeof names[i], "%s/%s", name, sides[i]);
        spaces[i].normal = i % 2 ? axes[i / 2] : vec3_scale(axes[i / 2], -1);
        spaces[i].offset = i % 2 ? to[i / 2] : -from[i / 2];
        spaces[i].name = names[i];
    }
    return solid_list_add(&h->list, "walls", spaces, 6, err);
}

/* From grid point i to i + 1 of grid line k, in four pieces around the window. */
static enum status add_wall(struct house *h, int along, int k, int i, struct err *err)
{
    char name[48];
    const double middle = (i + 0.5) * ROOM, half = THICKNESS / 2, y0 = k * ROOM - half, y1 = k * ROOM + half;
    const double x[4] = {i * ROOM - half, middle - WINDOW / 2, middle + WINDOW / 2, (i + 1) * ROOM + half};
    const double z[4] = {0, 0.9, 0.9 + WINDOW, HEIGHT};
    snprintf(name, sizeof name, "wall/%c%d-%d", along ? 'y' : 'x', k, i);
    for (int p = 0; p < 3; p += 2)
        if (add(h, name, along, vec3_make(x[p], y0, 0), vec3_make(x[p + 1], y1, HEIGHT), err) ||
            add(h, name, along, vec3_make(x[1], y0, z[p]), vec3_make(x[2], y1, z[p + 1]), err))
            return err->status;
    return ST_OK;
}

int main(int argc, char **argv)
{
    const char *walls_text = "1000", *turned_text = "0";
    const struct cli_opt opts[] = {
        CLI_ABOUT("Measures the time of the union of the walls of a house."),
        CLI_STR("walls", &walls_text, 0, "minimum number of walls"),
        CLI_STR("turned", &turned_text, 0, "rotation of the house, degrees"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct house h = {.angle = 0};
    struct solid_mesh mesh = {0};
    struct solid_report report = {0};
    struct solid_triangles triangles = {0};
    struct err err = ERR_INIT;
    int64_t walls;
    double degrees;

    if (cli_parse(argc, argv, "unite", opts, &prov, &err) != CLI_RUN) return err_exit_code(&err);
    if (!scan_int(walls_text, &walls) || walls < 1 || walls > 100000 || !scan_double(turned_text, &degrees))
        err_set(&err, ST_USAGE, "found --walls %s --turned %s, wanted 1 to 100000 walls and degrees.", walls_text,
                turned_text);
    int rooms = 1;
    while (!err.status && 2 * rooms * (rooms + 1) < walls) rooms++;
    h.angle = degrees * M_PI / 180;
    const double size = rooms * ROOM + THICKNESS;
    if (!err.status)
        add(&h, "floor", 0, vec3_make(-THICKNESS / 2, -THICKNESS / 2, -0.3),
            vec3_make(size - THICKNESS / 2, size - THICKNESS / 2, 0), &err);
    for (int along = 0; along < 2; along++)
        for (int k = 0; k <= rooms; k++)
            for (int i = 0; !err.status && i < rooms; i++) add_wall(&h, along, k, i, &err);
    double seconds = 0, check = 0, triangulate = 0;
    if (!err.status) {
        double began = clock_seconds();
        unite_solids(&mesh, &h.list, NULL, &err);
        seconds = clock_seconds() - began;
        began = clock_seconds();
        if (!err.status) solid_mesh_check(&mesh, 0, &report, &err);
        check = clock_seconds() - began;
        began = clock_seconds();
        if (!err.status) solid_mesh_triangulate(&triangles, &mesh, &err);
        triangulate = clock_seconds() - began;
    }
    if (err.status) {
        err_report(&err);
    } else {
        const int count = 2 * rooms * (rooms + 1), lines = rooms + 1;
        const double area = 2 * lines * THICKNESS * size - lines * lines * THICKNESS * THICKNESS;
        const double volume = size * size * 0.3 + area * HEIGHT - count * WINDOW * WINDOW * THICKNESS;
        int genus = 0;
        for (int i = 0; i < report.count; i++) genus += report.shells[i].genus;
        printf("seconds %.6f\ncheck_s %.6f\ntriangulate_s %.6f\nerror %.3g\nunit 1\nwalls %d\nsolids %d\nfaces %d\n"
               "vertices %d\nshells %d\ngenus %d\n",
               seconds, check, triangulate, fabs(report.volume - volume) / volume, count, h.list.count, mesh.face_count,
               mesh.vertex_count, report.count, genus);
    }
    solid_triangles_release(&triangles);
    solid_report_release(&report);
    solid_mesh_release(&mesh);
    solid_list_release(&h.list);
    return err_exit_code(&err);
}
