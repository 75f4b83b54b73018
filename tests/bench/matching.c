/* matching.c - time of an exact search for nearest descriptors, beside what the processor could do.
 *
 *   matching [--series remodel|plain|peak] [--size N]
 *
 * N x N random descriptors, one thread. `remodel` is the search of match_photos; `plain` a loop over all pairs in C, as
 * the compiler makes it; `peak` the same number of multiplications and additions without any memory or comparison:
 * vectors of 16 products of 16 bits, summed in eight registers. Runs until half a second has passed. Prints "seconds S"
 * (CPU time of the fastest), "products P" (multiply-adds, 10^9) and "found F" (a sum over what was found, the same for
 * both searches). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/base/rng.h"
#include "common/capture/nearest_descriptors.h"
#include "common/math/lanes.h"

enum { REGISTERS = 8, PER_STEP = REGISTERS * 16 };

static struct feature_list made_list(int count, uint64_t seed)
{
    const struct rng rng = rng_make(seed, "matching", "");
    struct feature_list list = {calloc((size_t)count, sizeof *list.features), count, ""};
    for (int i = 0; list.features && i < count; i++)
        for (int k = 0; k < DESCRIPTOR_SIZE; k++)
            list.features[i].descriptor[k] = (uint8_t)(rng_u32(&rng, (uint64_t)i, (uint64_t)k) % 79);
    return list;
}

static long long search(const struct feature_list *a, const struct feature_list *b, struct nearest *ab,
                        struct nearest *ba, struct err *err)
{
    struct nearest_descriptors of_a = {0}, of_b = {0};
    long long found = 0;
    if (!nearest_descriptors_init(&of_a, a, err) && !nearest_descriptors_init(&of_b, b, err))
        nearest_descriptors_find(ab, ba, &of_a, &of_b, err);
    for (int i = 0; !err->status && i < a->count; i++) found += ab[i].at + ab[i].best + ab[i].second;
    nearest_descriptors_release(&of_a);
    nearest_descriptors_release(&of_b);
    return found;
}

static long long search_plainly(const struct feature_list *a, const struct feature_list *b)
{
    long long found = 0;
    for (int i = 0; i < a->count; i++) {
        int32_t best = -1, second = -1, at = -1;
        for (int j = 0; j < b->count; j++) {
            int32_t product = 0;
            for (int k = 0; k < DESCRIPTOR_SIZE; k++)
                product += a->features[i].descriptor[k] * b->features[j].descriptor[k];
            if (product > best) {
                second = best;
                best = product;
                at = j;
            } else if (product > second)
                second = product;
        }
        found += at + best + second;
    }
    return found;
}

static long long multiply_only(long long products)
{
    i32x8 sums[REGISTERS] = {{0}};
    i16x16 factor = (i16x16)i32x8_all(0x00010001);
    for (long long n = 0; n < products; n += PER_STEP)
        for (int r = 0; r < REGISTERS; r++) {
            sums[r] += i32x8_weigh_i16(factor, (i16x16)sums[r]);
            __asm__("" : "+x"(sums[r])); /* so that the compiler keeps each of them */
        }
    for (int r = 1; r < REGISTERS; r++) sums[0] += sums[r];
    return sums[0][0];
}

int main(int argc, char **argv)
{
    const char *series = "remodel";
    int size = 8192;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Times an exact search for nearest descriptors."),
        CLI_STR("series", &series, CLI_OPTIONAL, "remodel, plain or peak"),
        CLI_INT("size", &size, CLI_OPTIONAL, "descriptors of each picture"),
        CLI_END,
    };
    struct err err = ERR_INIT;
    struct provenance prov = {0};
    if (cli_parse(argc, argv, "matching", opts, &prov, &err) != CLI_RUN) {
        err_report(&err);
        return err_exit_code(&err);
    }
    struct feature_list a = made_list(size, 1), b = made_list(size, 2);
    struct nearest *ab = malloc((size_t)size * sizeof *ab), *ba = malloc((size_t)size * sizeof *ba);
    const long long products = (long long)size * size * DESCRIPTOR_SIZE;
    double best = 1e9, total = 0;
    long long found = 0;
    if (!a.features || !b.features || !ab || !ba) err_nomem(&err, "descriptors", (size_t)size * sizeof *a.features);
    while (!err.status && total < 0.5) {
        const double begin = clock_cpu_seconds();
        found = !strcmp(series, "remodel") ? search(&a, &b, ab, ba, &err)
                : !strcmp(series, "plain") ? search_plainly(&a, &b)
                                           : multiply_only(products);
        const double seconds = clock_cpu_seconds() - begin;
        total += seconds;
        best = seconds < best ? seconds : best;
    }
    if (!err.status) printf("seconds %.6g\nproducts %.9g\nfound %lld\n", best, (double)products * 1e-9, found);
    err_report(&err);
    feature_list_release(&a);
    feature_list_release(&b);
    free(ab);
    free(ba);
    provenance_release(&prov);
    return err_exit_code(&err);
}
