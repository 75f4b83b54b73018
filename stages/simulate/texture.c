/* texture.c - procedural textures from cells and noise.
 *
 * A texture is a pure function of a seed and a place (u, v) on a face, in metres. A surface is divided into cells
 * (planks, bricks, books, posters); a hash of the cell's indices decides its look, and value noise adds detail
 * (common/light/value_noise.h). So a picture can be rendered in any order, and from any camera, with the same bits.
 *
 * What they are for. Depth is estimated from such pictures, so they need what real rooms have: detail at all scales,
 * marks that never repeat for feature matching (posters, book spines), and plain walls that are hard to match
 * (plaster). Dyes are those of printed things, so that rooms look like rooms.
 *
 * Edges are softened over 3 mm by smooth_step(). The path tracer averages samples over a pixel, so no other filter
 * is needed.
 *
 * PI_15 has 15 digits: the full PI would change the last bits of textures. */
#include "stages/simulate/texture.h"

#include <math.h>

#include "common/light/fast.h"
#include "common/light/value_noise.h"
#include "common/math/numbers.h"

#define PI_15 3.14159265358979 /* 15 digits: PI would change the last bits of textures */
#define SOFT  0.0015           /* m: half the width of a softened edge */

/* 1 inside [from, to], 0 outside, soft at both ends. */
static double band(double from, double to, double x)
{
    return smooth_step(from - SOFT, from + SOFT, x) * (1 - smooth_step(to - SOFT, to + SOFT, x));
}

static struct rgb varied(struct rgb c, double by)
{
    return rgb_make(clamp(c.r * (1 + by), 0, 1), clamp(c.g * (1 + by), 0, 1), clamp(c.b * (1 + by), 0, 1));
}

/* A colour for paper, cloth or a book cover, chosen by a hash: one of the dyes below, paler or darker. The dyes are
 * those of printed things, so that rooms look like rooms; light and dark ones alternate, which gives features
 * contrast. */
static struct rgb dye(uint32_t hash)
{
    static const struct rgb dyes[] = {
        {0.68, 0.60, 0.44},  /* cream */
        {0.04, 0.07, 0.17},  /* navy */
        {0.52, 0.32, 0.08},  /* ochre */
        {0.06, 0.13, 0.06},  /* forest */
        {0.70, 0.68, 0.62},  /* paper */
        {0.24, 0.04, 0.05},  /* burgundy */
        {0.34, 0.46, 0.55},  /* sky */
        {0.40, 0.14, 0.06},  /* terracotta */
        {0.33, 0.38, 0.26},  /* sage */
        {0.04, 0.04, 0.045}, /* charcoal */
        {0.56, 0.33, 0.28},  /* rose */
        {0.05, 0.19, 0.21},  /* teal */
    };
    const int count = sizeof dyes / sizeof *dyes, at = noise_floor(count * noise_unit(hash, 40));
    return varied(dyes[at < count ? at : count - 1], 0.5 * (noise_unit(hash, 41) - 0.5));
}

static struct rgb checker(const struct texture *t, double u, double v)
{
    const double x = u / t->size[0], y = v / t->size[0], soft = SOFT / t->size[0];
    const double a = fabs(x - 2 * floor(x / 2) - 1) - 0.5, b = fabs(y - 2 * floor(y / 2) - 1) - 0.5;
    const double sa = 2 * smooth_step(-soft, soft, a) - 1, sb = 2 * smooth_step(-soft, soft, b) - 1;
    return rgb_mix(t->colour[0], t->colour[1], 0.5 - 0.5 * sa * sb);
}

/* Planks along u, `size` wide and 8 to 14 times as long, each row shifted, with grain, rings and knots along them. */
static struct rgb wood(const struct texture *t, uint32_t seed, double u, double v)
{
    const double wide = t->size[0];
    const int row = noise_floor(v / wide);
    const uint32_t line = noise_hash(seed, row, 1);
    const double length = wide * (8 + 6 * noise_unit(line, 0)), shifted = u + length * noise_unit(line, 1);
    const uint32_t plank = noise_hash(seed + 5, noise_floor(shifted / length), row);
    const double du = shifted - length * floor(shifted / length), dv = v - wide * floor(v / wide);

    const double x = du / wide + 31 * noise_unit(plank, 0), y = dv / wide + 17 * noise_unit(plank, 1);
    const double warp = noise_value(plank, 0.45 * x, 1.3 * y);
    const double rings = 0.5 + 0.5 * sin(2 * PI_15 * (3.5 * y + 1.6 * warp + 0.15 * x));
    const double grain = noise_value(plank + 9, 1.8 * x, 26 * y), fine = noise_value(plank + 11, 7 * x, 70 * y);
    const double knot = noise_value(plank + 21, 1.1 * x, 2.2 * y);
    double dark = 0.15 + 0.3 * rings * rings + 0.22 * grain + 0.12 * fine + 0.5 * (noise_unit(plank, 2) - 0.5);
    dark += 0.7 * smooth_step(0.72, 0.95, knot);
    const double seam = 1 - band(SOFT, wide - SOFT, dv) * band(SOFT, length - SOFT, du);
    return rgb_scale(rgb_mix(t->colour[0], t->colour[1], clamp(dark, 0, 1)), 1 - 0.75 * seam);
}

static struct rgb brick(const struct texture *t, uint32_t seed, double u, double v)
{
    const double wide = t->size[0], high = t->size[1], joint = t->size[2] / 2;
    const int row = noise_floor(v / high);
    const double shifted = u + (row & 1 ? wide / 2 : 0);
    const uint32_t cell = noise_hash(seed, noise_floor(shifted / wide), row);
    double du = shifted - wide * floor(shifted / wide), dv = v - high * floor(v / high);
    const double rough = noise_octaves(seed + 3, u / 0.03, v / 0.03, 4);
    du += 0.003 * rough;
    dv += 0.003 * noise_value(seed + 4, u / 0.025, v / 0.025);
    const double inside = band(joint, wide - joint, du) * band(joint, high - joint, dv);
    const double pits = smooth_step(0.45, 0.7, noise_value(cell, u / 0.011, v / 0.011));
    const double tint = 0.75 * (noise_unit(cell, 0) - 0.55) + 0.3 * rough - 0.35 * pits;
    struct rgb face = varied(t->colour[0], tint);
    face = rgb_mix(face, varied(t->colour[1], -0.3), 0.35 * smooth_step(0.55, 0.95, noise_unit(cell, 1)));
    return rgb_mix(varied(t->colour[1], 0.25 * rough), face, inside);
}

static struct rgb plaster(const struct texture *t, uint32_t seed, double u, double v)
{
    const double x = u / t->size[0], y = v / t->size[0];
    const double coarse = noise_octaves(seed, x, y, 5);
    const double specks = smooth_step(0.55, 0.85, noise_value(seed + 91, 7 * x, 7 * y));
    return varied(t->colour[0], t->size[1] * (1.4 * coarse - 0.8 * specks));
}

/* Coverage (0..1) of the point (x, y) by one mark of a print. Lengths are in units of the print's smaller side. */
static double mark_cover(uint32_t hash, double x, double y, double wide, double high, double soft)
{
    const double dx = x - wide * noise_unit(hash, 0), dy = y - high * noise_unit(hash, 1);
    const double size = 0.04 + 0.26 * noise_unit(hash, 2) * noise_unit(hash, 3), reach = 2.2 * size + 0.04;
    if (dx * dx + dy * dy > reach * reach) return 0;
    const double p = noise_unit(hash, 4) - 0.5, q = noise_unit(hash, 6) - 0.5, length = sqrt(p * p + q * q) + 1e-9;
    const double c = p / length, s = q / length, a = c * dx + s * dy, b = c * dy - s * dx;
    double d;
    switch (hash % 4) {
    case 0: /* disk or ring */
        d = sqrt(a * a + b * b) - size;
        if (hash & 64) d = fabs(d) - 0.25 * size;
        break;
    case 1: /* box */
        d = fast_max(fabs(a) - size, fabs(b) - size * (0.2 + 0.8 * noise_unit(hash, 5)));
        break;
    case 2: /* triangle */
        d = fast_max(fabs(a) * 0.866 + b * 0.5, -b) - 0.5 * size;
        break;
    default: /* line */
        d = fast_max(fabs(a) - 2.2 * size, fabs(b) - 0.012 - 0.02 * noise_unit(hash, 5));
        break;
    }
    return 1 - smooth_step(-soft, soft, d);
}

/* Ink (0..1) of rows of blocks that look like letters from afar. x runs along the row; x and y are in letter
 * heights. */
static double lettering(uint32_t seed, double x, double y, double soft)
{
    const double line = floor(y / 1.7), dy = y - 1.7 * line, cell = floor(x / 0.72), dx = x - 0.72 * cell;
    const uint32_t h = noise_hash(seed, noise_floor(cell), noise_floor(line));
    if (dy > 1 || noise_unit(h, 0) < 0.17) return 0;
    const double bottom = noise_unit(h, 1) < 0.3 ? 0 : 0.25, top = noise_unit(h, 2) < 0.5 ? 1 : 0.7;
    const double box = fast_max(fabs(dx - 0.3) - 0.26, fast_max(bottom - dy, dy - top));
    const double hole = fast_max(fabs(dx - 0.3 - 0.12 * (noise_unit(h, 3) - 0.5)) - 0.1,
                                 fabs(dy - 0.5) - 0.08 - 0.3 * noise_unit(h, 4));
    return (1 - smooth_step(-soft, soft, box)) * smooth_step(-soft, soft, hole);
}

#define MARKS 36

static struct rgb print(const struct texture *t, uint32_t seed, double u, double v)
{
    const double wide = t->size[0], high = t->size[1], unit = fast_min(wide, high), soft = SOFT / unit;
    const uint32_t sheet = noise_hash(seed, noise_floor(u / wide), noise_floor(v / high));
    const double du = u - wide * floor(u / wide), dv = v - high * floor(v / high);
    const double x = du / unit, y = dv / unit, w = wide / unit, h = high / unit, border = 0.05;
    const double paper = band(border * unit, wide - border * unit, du) * band(border * unit, high - border * unit, dv);

    const double lift = dv / high;
    struct rgb c = rgb_mix(dye(sheet + 1), dye(sheet + 2), lift);
    c = varied(c, 0.45 * noise_octaves(sheet + 3, 5 * x, 5 * y, 4));
    for (int i = 0; i < MARKS; i++) {
        const uint32_t hash = noise_mix(sheet + 100u * (uint32_t)(i + 1));
        const double cover = mark_cover(hash, x, y, w, h, soft);
        if (cover > 0) c = rgb_mix(c, varied(dye(hash), 0.3 * noise_value(hash, 24 * x, 24 * y)), cover);
    }
    /* a block of text on a pale ground in the lower part of the sheet, with a headline above it */
    const double left = 0.12 + 0.25 * noise_unit(sheet, 7), text_wide = 0.4 * w, top = 0.32 * h;
    if (x > left && x < left + text_wide && y > 0.1 && y < top) {
        const double letter = y > top - 0.075 ? 0.05 : 0.018;
        const double ink = lettering(sheet + 8, (x - left) / letter, (y - 0.1) / letter, soft / letter);
        c = rgb_mix(rgb_grey(0.72), rgb_grey(0.05), ink);
    }
    return rgb_mix(rgb_grey(0.75), c, paper);
}

/* Spines of books side by side, 2 to 6 cm wide; each row has the height of the texture, with dark gaps above lower
 * books. */
static struct rgb books(const struct texture *t, uint32_t seed, double u, double v)
{
    const double high = t->size[1], pitch = 0.04;
    const int shelf = noise_floor(v / high), block = noise_floor(u / t->size[0]);
    const uint32_t row = noise_hash(seed, block, shelf);
    const double y = v - high * floor(v / high), cell = u / pitch;
    int at = noise_floor(cell);
    double from = floor(cell) + 0.55 * (noise_unit(noise_hash(row, at, 0), 0) - 0.5);
    if (cell < from) {
        at = noise_floor(cell - 1);
        from = floor(cell - 1) + 0.55 * (noise_unit(noise_hash(row, at, 0), 0) - 0.5);
    }
    const double to = floor(from + 0.6) + 1 + 0.55 * (noise_unit(noise_hash(row, (int)((uint32_t)at + 1), 0), 0) - 0.5);
    const uint32_t hash = noise_hash(row, at, 1);
    const double x = (cell - from) * pitch, wide = (to - from) * pitch;
    const double tall = high * (0.68 + 0.27 * noise_unit(hash, 1));
    if (y > tall) return rgb_grey(0.03 + 0.02 * smooth_step(tall, high, y));

    struct rgb c = varied(dye(hash), 0.12 * noise_octaves(hash, u / 0.02, v / 0.05, 3));
    const struct rgb second = dye(hash + 1);
    const double low = tall * (0.1 + 0.1 * noise_unit(hash, 2)), upper = tall * (0.8 + 0.1 * noise_unit(hash, 3));
    c = rgb_mix(c, second, band(low, low + 0.012, y) + band(upper, upper + 0.01, y));
    const double letter = fast_min(0.55 * wide, 0.022), begin = low + 0.03,
                 end = upper - 0.02 - 0.3 * tall * noise_unit(hash, 4);
    if (y > begin && y < end && fabs(x - wide / 2) < letter / 2) {
        const double ink = lettering(hash + 2, (y - begin) / letter, (x - wide / 2) / letter + 0.5, SOFT / letter);
        c = rgb_mix(c, noise_unit(hash, 41) < 0.6 ? rgb_make(0.75, 0.7, 0.5) : rgb_grey(0.04), ink);
    }
    const double rounded = 0.55 + 0.45 * sin(PI_15 * clamp(x / wide, 0, 1)); /* spines are darker at their edges */
    return rgb_scale(c, rounded * band(0.0015, wide - 0.0015, x));
}

struct rgb texture_at(const struct texture *t, uint32_t face, double u, double v)
{
    const uint32_t seed = t->seed + face;
    switch (t->kind) {
    case TEXTURE_CHECKER:
        return checker(t, u, v);
    case TEXTURE_WOOD:
        return wood(t, seed, u, v);
    case TEXTURE_BRICK:
        return brick(t, seed, u, v);
    case TEXTURE_PLASTER:
        return plaster(t, seed, u, v);
    case TEXTURE_PRINT:
        return print(t, seed, u, v);
    case TEXTURE_BOOKS:
        return books(t, seed, u, v);
    default:
        return t->colour[0];
    }
}

double texture_bound(const struct texture *t)
{
    const double strongest = fast_max(rgb_max(t->colour[0]), rgb_max(t->colour[1]));
    switch (t->kind) {
    case TEXTURE_BRICK:
        return fast_min(1, 1.8 * strongest);
    case TEXTURE_PLASTER:
        return fast_min(1, rgb_max(t->colour[0]) * (1 + 1.4 * t->size[1]));
    case TEXTURE_PRINT:
    case TEXTURE_BOOKS:
        return 1;
    default:
        return strongest;
    }
}
