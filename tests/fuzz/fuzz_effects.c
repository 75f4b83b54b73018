/* fuzz_effects.c - effect layers: any bytes give layers that can be applied, written and read back the same, or an
 * error message. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/film/effects.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void apply(const struct effects *e)
{
    float rgba[4 * 9], z[9] = {0, 1, 2, 3, 1e-20f, 1e20f, 0.5f, 7, 100};
    struct rendered_frame f = {.width = 9, .height = 1, .rgba = rgba, .z = z};
    const struct view v = {.fx = 5, .fy = 5, .cx = 4, .cy = 0.5, .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};

    for (int t = -1; t < 4; t++) {
        for (int i = 0; i < 36; i++) rgba[i] = i % 4 < 3 ? (float)(i % 5) / 4 : 1;
        effects_apply(e, t * 0.7, &v, &f);
        for (int i = 0; i < 36; i++)
            if (!(rgba[i] >= 0)) abort();
    }
}

static void same(const struct effects *a, const struct effects *b)
{
    if (a->layer_count != b->layer_count) abort();
    for (int i = 0; i < a->layer_count; i++) {
        const struct effect_layer *x = &a->layers[i], *y = &b->layers[i];
        if (strcmp(x->name, y->name) || x->kind != y->kind || x->region != y->region || x->curve != y->curve ||
            x->box_count != y->box_count || x->key_count != y->key_count)
            abort();
        for (int k = 0; k < x->box_count; k++)
            if (memcmp(&x->boxes[k], &y->boxes[k], sizeof *x->boxes)) abort();
        for (int k = 0; k < x->key_count; k++)
            if (memcmp(&x->keys[k], &y->keys[k], sizeof *x->keys)) abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct effects e, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (effects_read(&e, path, NULL, &err)) {
        if (!strstr(err.text, path) || e.layers || e.layer_count) abort();
    } else {
        apply(&e);
        if (effects_write(&e, path, NULL, &err) || effects_read(&again, path, NULL, &err)) abort();
        same(&e, &again);
        effects_release(&again);
    }
    effects_release(&e);
    unlink(path);
    return 0;
}
