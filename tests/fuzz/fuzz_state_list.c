/* fuzz_state_list.c - reader of states.txt, and of a state and a date on the command line: any bytes give states whose
 * numbers are in range, or an error that names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/light_levels/level_days.h"
#include "stages/light_levels/state_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check(const struct state_list *l)
{
    if (l->count < STATES_OF_EVERY_SCENE || !isfinite(l->north)) abort();
    for (int i = 0; i < l->count; i++) {
        const struct light_state *s = &l->items[i];
        if (!s->name || !*s->name) abort();
        for (int k = 0; k < s->named_count; k++)
            if (!s->named[k].name || !(s->named[k].factor >= 0) || !isfinite(s->named[k].factor)) abort();
        for (int k = 0; k < s->blind_count; k++)
            if (!(s->blinds[k].factor >= 0 && s->blinds[k].factor <= 1)) abort();
        if (s->sky == STATE_SKY_OVERCAST && !isfinite(s->horizontal)) abort();
        if (s->sky == STATE_SKY_TIME && (s->time.month < 1 || s->time.month > 12)) abort();
    }
    for (int i = 0; i < l->measured_count; i++)
        if (l->measured[i].state < 0 || l->measured[i].state >= l->count || !(l->measured[i].lux >= 0)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH], *words = malloc(size + 1);
    struct state_list list = {0};
    struct sun_time date;
    struct err err = ERR_INIT, words_err = ERR_INIT, date_err = ERR_INIT;

    if (!words) abort();
    fuzz_file(path, data, size);
    if (state_list_read(&list, path, NULL, &err)) {
        /* or the IES file that a line names, which has a name of its own */
        if (!*err.text || list.items || list.count) abort();
    } else {
        check(&list);
        state_list_release(&list);
    }
    memcpy(words, data, size);
    words[size] = '\0';
    if (state_list_read_words(&list, words, &words_err)) {
        if (!*words_err.text || list.items) abort();
    } else {
        check(&list);
        state_list_release(&list);
    }
    if (!level_date_read(&date, words, &date_err) &&
        (date.month < 1 || date.month > 12 || date.day < 1 || date.day > 31))
        abort();
    free(words);
    unlink(path);
    return 0;
}
