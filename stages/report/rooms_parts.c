/* rooms_parts.c - see rooms_parts.h; and the release of what was read. */
#include "stages/report/rooms_parts.h"

#include <stdio.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "stages/report/passing.h"

enum status rooms_note(struct rooms *rooms, const char *what, const struct err *problem, struct err *err)
{
    if (passing_refuse(problem->text, err)) return err->status;
    if (array_append(&rooms->notes, (size_t)rooms->note_count, sizeof *rooms->notes, "notes", err)) return err->status;
    snprintf(rooms->notes[rooms->note_count++], sizeof *rooms->notes, "%.100s: %.800s", what, problem->text);
    return ST_OK;
}

struct view_change *rooms_change_of(const struct rooms_reading *r, int change, int lens)
{
    return &r->table[(size_t)change * (size_t)r->lenses.count + (size_t)lens];
}

void rooms_look_release(struct room_look *look)
{
    picture_release(&look->after);
    picture_release(&look->relit);
    picture_release(&look->made);
    picture_release(&look->ratio);
}

void rooms_release(struct rooms *rooms)
{
    for (int i = 0; i < rooms->photo_count; i++) {
        struct room_photo *p = &rooms->photos[i];
        for (int k = 0; k < p->look_count; k++) rooms_look_release(&p->looks[k]);
        picture_release(&p->before);
        free(p->looks);
    }
    for (int i = 0; i < rooms->change_count; i++) free(rooms->changes[i].about);
    free(rooms->photos);
    free(rooms->changes);
    free(rooms->notes);
    *rooms = (struct rooms){0};
}
