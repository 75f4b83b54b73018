/* cross_validation.c - response and radiance fitted to every other exposure of a real scene predict the others.
 *
 * ../shared/data/brackets-memorial is the church of [Debevec 1997]: 16 exposures one stop apart, scanned from film,
 * which does not follow the sRGB curve. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/sort.h"
#include "stages/fit_response/recover.h"
#include "stages/hdr_merge/merge.h"
#include "stages/import_photos/exposure_list.h"

struct stack { /* exposures ascending */
    struct photo photos[MERGE_MAX_EXPOSURES];
    double exposures[MERGE_MAX_EXPOSURES];
    int count;
};

static void read_stack(struct stack *s, const char *folder)
{
    struct exposure_list list = {0};
    struct err err = ERR_INIT;
    char path[300];
    *s = (struct stack){0};
    if (access(folder, R_OK)) {
        print_message("%s does not exist\n", folder);
        skip();
    }
    snprintf(path, sizeof path, "%s/exposures.txt", folder);
    assert_ok(exposure_list_read(&list, path, &err), err);
    for (int i = list.count - 1; i >= 0; i--, s->count++) { /* the list has the longest first */
        snprintf(path, sizeof path, "%s/%s", folder, list.lines[i].file);
        assert_ok(photo_read(&s->photos[s->count], path, &err), err);
        s->exposures[s->count] = exposure_value(&list.lines[i].exposure);
        assert_true(!s->count || s->exposures[s->count] > s->exposures[s->count - 1]);
    }
    exposure_list_release(&list);
}

static double luminance(const float *rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

/* Relative errors of the luminance that `merged` predicts at exposure t, for well exposed pixels: no colour near
 * saturation, brighter than a twentieth of white, as in the comparisons with truth. */
static size_t compare(double *errors, const struct merged *merged, const struct photo *p, double t,
                      const struct response *response)
{
    const float brightest = 255 * srgb_from_linear(0.76f);
    size_t n = 0;
    for (size_t i = 0; i < (size_t)p->info.width * (size_t)p->info.height; i++) {
        const uint16_t *s = p->samples + 3 * i;
        float light[3];
        for (int c = 0; c < 3; c++) light[c] = response_light(response, c, (float)s[c] / 255);
        if (merged->marks[i] || s[0] > brightest || s[1] > brightest || s[2] > brightest || luminance(light) < 0.05)
            continue;
        errors[n++] = fabs(luminance(merged->radiance.data + 3 * i) * t / luminance(light) - 1);
    }
    return n;
}

/* Fits to the exposures of index `odd` mod 2 and predicts the others; returns the median error. */
static double predict(const struct stack *s, int odd)
{
    struct photo fitted[MERGE_MAX_EXPOSURES];
    double exposures[MERGE_MAX_EXPOSURES];
    const double scale = s->exposures[s->count / 2];
    int count = 0;
    const struct fit_params fit = FIT_PARAMS_DEFAULT;
    const struct merge_params params = MERGE_PARAMS_DEFAULT;
    struct patches patches = {0};
    struct response response;
    struct merged merged = {0};
    struct noise noise[MERGE_MAX_EXPOSURES], measured;
    bool known = false;
    struct err err = ERR_INIT;
    char summary[RESPONSE_SUMMARY];
    for (int k = odd; k < s->count; k += 2, count++) {
        fitted[count] = s->photos[k];
        exposures[count] = s->exposures[k] / scale;
    }
    const struct brackets b = {fitted, exposures, count, &response, NULL};
    assert_ok(recover_add_patches(&patches, fitted, exposures, count, fit.max_patches, &err), err);
    assert_ok(recover_decide(&response, summary, &patches, &fit, &err), err);
    print_message("response curve: %s\n", summary);
    assert_true(response.table);
    assert_ok(noise_measure(&measured, &known, &b, &err), err);
    for (int k = 0; k < count; k++)
        noise[k] = known ? measured : noise_given(params.electrons, params.read_noise, &response, 8);
    assert_ok(merge_brackets(&merged, &b, noise, &params, &err), err);

    const size_t pixels = (size_t)fitted[0].info.width * (size_t)fitted[0].info.height;
    double *errors = malloc((size_t)s->count * pixels * sizeof *errors);
    size_t all = 0;
    assert_non_null(errors);
    for (int k = !odd; k < s->count; k += 2) {
        double *mine = errors + all;
        const size_t n = compare(mine, &merged, &s->photos[k], s->exposures[k] / scale, &response);
        if (!n) continue;
        sort_doubles(mine, n);
        print_message("  exposure %2d: median error %.4f, 90 %% below %.3f, of %.1f %% of the pixels\n", k, mine[n / 2],
                      mine[n * 9 / 10], 100.0 * (double)n / (double)pixels);
        all += n;
    }
    sort_doubles(errors, all);
    const double median = errors[all / 2];
    print_message("  median error %.4f of %zu pixels\n", median, all);
    free(errors);
    merge_release(&merged);
    recover_release_patches(&patches);
    return median;
}

static void memorial_predicts_held_out_exposures(void **state)
{
    struct stack s;
    (void)state;
    read_stack(&s, "../shared/data/brackets-memorial");
    for (int odd = 0; odd < 2; odd++) assert_true(predict(&s, odd) < 0.05);
    for (int k = 0; k < s.count; k++) photo_release(&s.photos[k]);
}

/* The stated times are wrong: the photos of 1 s and 0.5 s, and other pairs, are equally bright. */
static void living_room_has_wrong_exposures(void **state)
{
    struct stack s;
    struct exposure_agreement worst;
    const struct response srgb = {0};
    struct err err = ERR_INIT;
    (void)state;
    read_stack(&s, "../shared/data/brackets-living-room");
    const struct brackets b = {s.photos, s.exposures, s.count, &srgb, NULL};
    assert_ok(merge_agreement(&worst, &b, &err), err);
    print_message("exposure %d: stated %.3g times the one before, measured %.3g\n", worst.pair, worst.stated,
                  worst.measured);
    assert_true(worst.pair > 0 && worst.measured < 1.1 && worst.stated > 1.9);
    for (int k = 0; k < s.count; k++) photo_release(&s.photos[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memorial_predicts_held_out_exposures),
        cmocka_unit_test(living_room_has_wrong_exposures),
    };
    return cmocka_run_group_tests_name("cross_validation", tests, NULL, NULL);
}
