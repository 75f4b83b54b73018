/* room.h - shared by the tests of trace_ids: models of boxes, and views of them. The scene's frame is the model's. */
#ifndef REMODEL_TESTS_ROOM_H
#define REMODEL_TESTS_ROOM_H

#include "tests/unit/box_solids.h"

#include "stages/trace_ids/view_layers.h"

static const struct model_axes same_frame = {.rotation = {1, 0, 0, 0}, .scale = 1};

struct seen {
    struct view_trace trace;
    struct view_ids ids;
    struct layered_depth depth;
};

/* Traces a view; its depth has one segment of confidence 1 that is everywhere z (0: where the model is). */
static inline struct seen see(const struct model_rays *m, const struct view *view, double z)
{
    const struct trace_params params = TRACE_PARAMS_DEFAULT;
    struct seen s = {0};
    struct err err = ERR_INIT;
    assert_ok(view_trace(&s.trace, m, &same_frame, view, &err), err);
    assert_ok(view_ids_init(&s.ids, view->width, view->height, &err), err);
    view_trace_ids(&s.ids, &s.trace);
    assert_ok(layered_depth_init(&s.depth, view->width, view->height, &err), err);
    s.depth.segments = calloc(3, sizeof *s.depth.segments);
    s.depth.segment_count = 3;
    for (int i = 0; i < 3; i++)
        s.depth.segments[i] = (struct depth_segment){.id = (uint32_t)i + 1, .sigma = 0.02, .confidence = 1};
    for (int i = 0; i < view->width * view->height; i++) {
        s.depth.interior.id[i] = 1;
        s.depth.interior.z[i] = z > 0 ? (float)z : s.ids.z[i];
    }
    assert_ok(view_jumps_find(&s.ids, &s.trace, &s.depth, &params, &err), err);
    assert_ok(view_clutter_find(&s.ids, &s.trace, &s.depth, 1, &params, &err), err);
    return s;
}

static inline void see_release(struct seen *s)
{
    view_trace_release(&s->trace);
    view_ids_release(&s->ids);
    layered_depth_release(&s->depth);
}

static inline int id_of(const struct model_rays *m, const char *name)
{
    for (int i = 0; i < m->mesh.name_count; i++)
        if (!strcmp(m->mesh.names[i].name, name)) return m->mesh.names[i].id;
    fail_msg("no face %s", name);
    return 0;
}

#endif
