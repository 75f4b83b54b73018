/* kernel_taps.h - the samples under a filter's kernel along one axis, and their weights. */
#ifndef REMODEL_KERNEL_TAPS_H
#define REMODEL_KERNEL_TAPS_H

#define KERNEL_LOBES  3
#define MAX_REDUCTION 64 /* larger reductions alias a little; limits the memory of the taps */
enum { LANES = 8, MAX_TAPS = 2 * KERNEL_LOBES * MAX_REDUCTION + 1 };

/* Those within one lobe are near. Weights from `count` to the next multiple of LANES are 0. */
struct kernel_taps {
    int first, count;
    int near_begin, near_end; /* relative to first */
    float weight[MAX_TAPS + LANES];
};

#endif
