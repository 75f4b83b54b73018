/* fuzz_subject_list.c - lists of subjects: any bytes give a list that can be used, written and read back the same, or
 * an error message. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/film/subject_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void use(const struct subject *s)
{
    const struct view v = {.width = 9,
                           .height = 9,
                           .fx = 5,
                           .fy = 5,
                           .cx = 4,
                           .cy = 4,
                           .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    if (!s->view || !(s->x1 > s->x0) || !(s->y1 > s->y0) || !(s->depth > 0) || s->confirmed > s->asked) abort();
    if (!isfinite(subject_size_in(s, &v))) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct subject_list list, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (subject_list_read(&list, path, NULL, &err)) {
        if (!strstr(err.text, path) || list.subjects || list.count) abort();
    } else {
        for (int i = 0; i < list.count; i++) use(&list.subjects[i]);
        if (!subject_list_write(&list, path, NULL, &err)) { /* a name may be too long to write */
            if (subject_list_read(&again, path, NULL, &err) || again.count != list.count) abort();
            for (int i = 0; i < list.count; i++)
                if (strcmp(list.subjects[i].view, again.subjects[i].view) ||
                    list.subjects[i].depth != again.subjects[i].depth ||
                    memcmp(list.subjects[i].corner, again.subjects[i].corner, sizeof again.subjects[i].corner))
                    abort();
            subject_list_release(&again);
        }
        subject_list_release(&list);
    }
    unlink(path);
    return 0;
}
