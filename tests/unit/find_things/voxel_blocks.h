/* voxel_blocks.h - shared by the tests of find_things: blocks of voxels of a grid. */
#ifndef REMODEL_TESTS_VOXEL_BLOCKS_H
#define REMODEL_TESTS_VOXEL_BLOCKS_H

#include "tests/unit/scratch.h"

#include "common/model/thing_volume.h"

/* The voxels from (x0, y0, z0) up to and with (x1, y1, z1). */
struct block {
    int x0, y0, z0, x1, y1, z1;
};

static inline int64_t voxel_of(const struct voxel_grid *g, int x, int y, int z)
{
    return ((int64_t)z * g->size[1] + y) * g->size[0] + x;
}

static inline bool in_block(const struct block *b, const struct voxel_grid *g, int64_t at)
{
    const int x = (int)(at % g->size[0]), y = (int)(at / g->size[0] % g->size[1]),
              z = (int)(at / g->size[0] / g->size[1]);
    return x >= b->x0 && x <= b->x1 && y >= b->y0 && y <= b->y1 && z >= b->z0 && z <= b->z1;
}

static inline void put_block(uint32_t *ids, const struct voxel_grid *g, struct block b, uint32_t id)
{
    for (int64_t i = 0; i < (int64_t)voxel_count(g); i++)
        if (in_block(&b, g, i)) ids[i] = id;
}

/* The ids are those of these blocks, the later before the earlier, and 0 elsewhere. */
static inline void assert_blocks(const uint32_t *ids, const struct voxel_grid *g, const struct block *blocks,
                                 const uint32_t *wanted, int count)
{
    for (int64_t i = 0; i < (int64_t)voxel_count(g); i++) {
        uint32_t id = 0;
        for (int k = 0; k < count; k++)
            if (in_block(&blocks[k], g, i)) id = wanted[k];
        if (ids[i] != id)
            fail_msg("voxel %d %d %d is of %u, wanted %u", (int)(i % g->size[0]), (int)(i / g->size[0] % g->size[1]),
                     (int)(i / g->size[0] / g->size[1]), ids[i], id);
    }
}

#endif
