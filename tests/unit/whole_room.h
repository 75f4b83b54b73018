/* whole_room.h - a group's fixture: the closed room, made once for all tests. */
#ifndef REMODEL_TESTS_WHOLE_ROOM_H
#define REMODEL_TESTS_WHOLE_ROOM_H

#include "tests/unit/box_solids.h"

static struct model_rays model;

static int make_model(void **state)
{
    static const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    (void)state;
    model = make_rays(boxes, 2);
    return 0;
}

static int release_model(void **state)
{
    (void)state;
    model_rays_release(&model);
    return 0;
}

#endif
