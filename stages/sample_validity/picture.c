/* picture.c - picture of the regions of valid viewpoints. */
#include "stages/sample_validity/picture.h"

#include <stdlib.h>
#include <string.h>

#include "common/image/photo.h"
#include "common/math/numbers.h"

enum { MAP = 384, MARGIN = 12, SIDE = 2 * MAP + 3 * MARGIN };

static const unsigned char scale[][3] = {{32, 28, 92}, {36, 92, 140}, {32, 150, 120}, {140, 200, 72}, {250, 230, 60}};

struct map_panel { /* maps x, y of the reference frame to pixels */
    int left, top;
    double x0, y0, per_unit;
};

static void dot(unsigned char *pixels, int x, int y, const unsigned char color[3])
{
    if (x >= 0 && y >= 0 && x < SIDE && y < SIDE) memcpy(pixels + 3 * (y * SIDE + x), color, 3);
}

static void draw_square(unsigned char *pixels, const struct map_panel *m, double x, double y, int size,
                        const unsigned char color[3])
{
    const int px = m->left + (int)floor((x - m->x0) * m->per_unit), py = m->top + (int)floor((y - m->y0) * m->per_unit);
    for (int j = py - size; j <= py + size; j++)
        for (int i = px - size; i <= px + size; i++)
            if (i >= m->left && j >= m->top && i < m->left + MAP && j < m->top + MAP) dot(pixels, i, j, color);
}

static void line(unsigned char *pixels, const struct map_panel *m, struct vec3 a, struct vec3 b)
{
    static const unsigned char white[3] = {255, 255, 255};
    const double length = hypot(b.x - a.x, b.y - a.y) * m->per_unit;
    const int steps = (int)fmin(length, 8.0 * MAP) + 1;
    for (int i = 0; i <= steps; i++) {
        const double t = (double)i / steps;
        draw_square(pixels, m, a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), 0, white);
    }
}

static void color_of(double fraction, unsigned char color[3])
{
    const int last = (int)(sizeof scale / sizeof *scale) - 1;
    const double at = clamp(fraction, 0, 1) * last;
    const int i = at < last ? (int)at : last - 1;
    for (int c = 0; c < 3; c++)
        color[c] = (unsigned char)lround(scale[i][c] + (at - i) * (scale[i + 1][c] - scale[i][c]));
}

static void draw_cells(unsigned char *pixels, const struct map_panel *m, const struct validity_region *r, bool forward)
{
    static const unsigned char grey[3] = {96, 96, 96};
    double farthest = 0;
    for (int i = 0; i < r->columns * r->rows; i++)
        if (r->cells[i].valid) farthest = fmax(farthest, forward ? r->cells[i].high : -r->cells[i].low);
    for (int y = 0; y < MAP; y++)
        for (int x = 0; x < MAP; x++) {
            const int column = x * r->columns / MAP, row = y * r->rows / MAP;
            const struct validity_cell *c = &r->cells[row * r->columns + column];
            const double z = forward ? c->high : -c->low;
            unsigned char color[3];
            color_of(farthest > 0 ? z / farthest : 0, color);
            dot(pixels, m->left + x, m->top + y, c->valid ? color : grey);
        }
}

static void draw_mesh(unsigned char *pixels, const struct map_panel *m, const struct shot_setup *shot,
                      const struct view_mesh *mesh)
{
    static const unsigned char red[3] = {220, 40, 40}, white[3] = {255, 255, 255};
    for (int i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            line(pixels, m, shot_from_world(shot, mesh->vertices[mesh->triangles[i][k]]),
                 shot_from_world(shot, mesh->vertices[mesh->triangles[i][(k + 1) % 3]]));
    for (int i = 0; i < mesh->set->view_count; i++) {
        const struct vec3 c = shot_from_world(shot, mesh->set->views[i].center);
        draw_square(pixels, m, c.x, c.y, 2, white);
    }
    draw_square(pixels, m, 0, 0, 3, red);
}

/* A map of the square around a region's cells. */
static struct map_panel map_of(const struct validity_region *r, const struct shot_setup *shot, int left, int top)
{
    const struct validity_cell *a = &r->cells[0], *b = &r->cells[r->columns * r->rows - 1];
    const double w = r->columns > 1 ? (b->x - a->x) * r->columns / (r->columns - 1) : shot->high[0] - shot->low[0];
    const double h = r->rows > 1 ? (b->y - a->y) * r->rows / (r->rows - 1) : shot->high[1] - shot->low[1];
    const double side = fmax(w, h);
    return (struct map_panel){left, top, 0.5 * (a->x + b->x) - 0.5 * side, 0.5 * (a->y + b->y) - 0.5 * side,
                              MAP / side};
}

enum status validity_picture_write(const struct validity *v, const struct view_mesh *mesh, const char *path,
                                   struct err *err)
{
    unsigned char *pixels = malloc(3 * SIDE * SIDE);
    if (!pixels) return err_nomem(err, "a picture", 3 * SIDE * SIDE);
    memset(pixels, 40, 3 * SIDE * SIDE);
    for (int e = 0; e < 2; e++)
        for (int forward = 0; forward < 2; forward++) {
            const struct map_panel m =
                map_of(&v->region[e], &v->shot, MARGIN + forward * (MAP + MARGIN), MARGIN + e * (MAP + MARGIN));
            draw_cells(pixels, &m, &v->region[e], forward);
            draw_mesh(pixels, &m, &v->shot, mesh);
        }
    png_write(path, pixels, SIDE, SIDE, 3, err);
    free(pixels);
    return err->status;
}
