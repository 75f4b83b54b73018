/* nearest_descriptors.c - exact nearest neighbours among descriptors of two photos.
 *
 * All scalar products are formed, in registers: four features of one photo (rows) times sixteen of the other (columns,
 * two blocks). A lane of a vector is a column. Descriptors are widened to 16 bits, because the instruction that
 * multiplies bytes adds the products in 16 bits, where they overflow. A row keeps the best of each lane until all its
 * columns have passed. Of equal products the lower index wins, and the second is as large as the best.
 *
 * Memory: rows of a stripe (ROWS x 256 bytes) stay in the first cache while all columns pass, columns of a panel
 * (PANEL blocks x 2 KiB) in the second while all stripes pass. */
#include "common/capture/nearest_descriptors.h"

#include <stdlib.h>
#include <string.h>

#include "common/math/lanes.h"

enum { LANES = 8, ROWS = 4, COLUMNS = 2, PANEL = 64, PAIRS = DESCRIPTOR_SIZE / 2 };

enum status nearest_descriptors_init(struct nearest_descriptors *b, const struct feature_list *list, struct err *err)
{
    const size_t blocks = ((size_t)list->count + LANES * COLUMNS - 1) / (LANES * COLUMNS) * COLUMNS;
    const size_t rows = ((size_t)list->count + ROWS - 1) / ROWS * ROWS;
    *b = (struct nearest_descriptors){.count = list->count, .blocks = (int)blocks};
    b->rows = calloc(rows * DESCRIPTOR_SIZE + 1, sizeof *b->rows);
    b->lanes = calloc(blocks * LANES * DESCRIPTOR_SIZE + 1, sizeof *b->lanes);
    if (!b->rows || !b->lanes) {
        nearest_descriptors_release(b);
        return err_nomem(err, "descriptors", blocks * LANES * DESCRIPTOR_SIZE * sizeof *b->lanes);
    }
    for (int i = 0; i < list->count; i++)
        for (int k = 0; k < DESCRIPTOR_SIZE; k++) {
            const int16_t value = list->features[i].descriptor[k];
            b->rows[(size_t)i * DESCRIPTOR_SIZE + (size_t)k] = value;
            b->lanes[((size_t)(i / LANES) * PAIRS + (size_t)(k / 2)) * 2 * LANES + (size_t)(2 * (i % LANES) + k % 2)] =
                value;
        }
    return ST_OK;
}

void nearest_descriptors_release(struct nearest_descriptors *b)
{
    if (!b) return;
    free(b->rows);
    free(b->lanes);
    *b = (struct nearest_descriptors){0};
}

struct best_lanes {
    i32x8 best, second, at;
};

static inline void take(struct best_lanes *b, i32x8 product, i32x8 at)
{
    const i32x8 better = product > b->best;
    b->second = i32x8_max(b->second, i32x8_min(b->best, product));
    b->best = i32x8_max(b->best, product);
    b->at = i32x8_if(better, at, b->at);
}

/* sums[r][c]: of row r and the columns of block c. */
static inline void multiply(i32x8 sums[ROWS][COLUMNS], const int16_t *rows, const int16_t *columns)
{
    i32x8 s00 = {0}, s01 = {0}, s10 = {0}, s11 = {0}, s20 = {0}, s21 = {0}, s30 = {0}, s31 = {0};
    const int16_t *second = columns + PAIRS * 2 * LANES;
    for (int k = 0; k < PAIRS; k++) {
        const i16x16 c0 = i16x16_load(columns + (size_t)k * 2 * LANES),
                     c1 = i16x16_load(second + (size_t)k * 2 * LANES);
        int32_t two;
#define ROW(r)                                                    \
    memcpy(&two, rows + (r)*DESCRIPTOR_SIZE + 2 * k, sizeof two); \
    s##r##0 += i32x8_weigh_i16(c0, (i16x16)i32x8_all(two));       \
    s##r##1 += i32x8_weigh_i16(c1, (i16x16)i32x8_all(two));
        ROW(0)
        ROW(1)
        ROW(2)
        ROW(3)
#undef ROW
    }
    sums[0][0] = s00, sums[0][1] = s01, sums[1][0] = s10, sums[1][1] = s11;
    sums[2][0] = s20, sums[2][1] = s21, sums[3][0] = s30, sums[3][1] = s31;
}

/* The best of all lanes. */
static struct nearest nearest_of(const struct best_lanes *b)
{
    struct nearest n = {-1, -1, -1};
    for (int k = 0; k < LANES; k++) {
        const int32_t best = b->best[k], second = b->second[k], at = b->at[k];
        if (best > n.best || (best == n.best && at >= 0 && at < n.at)) {
            n.second = n.best > second ? n.best : second;
            n.best = best;
            n.at = at;
        } else if (best > n.second)
            n.second = best;
    }
    return n;
}

/* Columns beyond the last have products of 0, which must not count. */
static i32x8 products_of(i32x8 sum, i32x8 at, int count) { return i32x8_if(at < count, sum, i32x8_all(-1)); }

static const struct best_lanes none = {
    {-1, -1, -1, -1, -1, -1, -1, -1}, {-1, -1, -1, -1, -1, -1, -1, -1}, {-1, -1, -1, -1, -1, -1, -1, -1}};

enum status nearest_descriptors_find(struct nearest *ab, struct nearest *ba, const struct nearest_descriptors *a,
                                     const struct nearest_descriptors *b, struct err *err)
{
    const size_t rows = ((size_t)a->count + ROWS - 1) / ROWS * ROWS, blocks = (size_t)b->blocks;
    struct best_lanes *of_rows = aligned_alloc(32, (rows + 1) * sizeof *of_rows),
                      *of_blocks = aligned_alloc(32, (blocks + 1) * sizeof *of_blocks);
    if (!of_rows || !of_blocks) {
        free(of_rows);
        free(of_blocks);
        return err_nomem(err, "nearest features", (rows + blocks) * sizeof *of_rows);
    }
    for (size_t i = 0; i < rows; i++) of_rows[i] = none;
    for (size_t i = 0; i < blocks; i++) of_blocks[i] = none;
    for (size_t panel = 0; panel < blocks; panel += PANEL)
        for (size_t row = 0; row < (size_t)a->count; row += ROWS)
            for (size_t block = panel; block < blocks && block < panel + PANEL; block += COLUMNS) {
                i32x8 sums[ROWS][COLUMNS];
                multiply(sums, a->rows + row * DESCRIPTOR_SIZE, b->lanes + block * PAIRS * 2 * LANES);
                for (int c = 0; c < COLUMNS; c++) {
                    const i32x8 at = (int)(block + (size_t)c) * LANES + (i32x8){0, 1, 2, 3, 4, 5, 6, 7};
                    struct best_lanes column = of_blocks[block + (size_t)c];
                    for (int r = 0; r < ROWS && row + (size_t)r < (size_t)a->count; r++) {
                        take(&of_rows[row + (size_t)r], products_of(sums[r][c], at, b->count), at);
                        take(&column, sums[r][c], i32x8_all((int)row + r));
                    }
                    of_blocks[block + (size_t)c] = column;
                }
            }
    for (int i = 0; i < a->count; i++) ab[i] = nearest_of(&of_rows[i]);
    for (int i = 0; i < b->count; i++) {
        const struct best_lanes *l = &of_blocks[i / LANES];
        ba[i] = (struct nearest){l->at[i % LANES], l->best[i % LANES], l->second[i % LANES]};
    }
    free(of_rows);
    free(of_blocks);
    return ST_OK;
}
