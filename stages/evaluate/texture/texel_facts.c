/* texel_facts.c - see texel_facts.h.
 *
 * The tile's matrix and the plane of its face say where in the model a texel is; the model's axes and the similarity of
 * the cameras, where in the truth. There a picture of the shell gives its true radiance, and the pictures of the photo
 * that it was taken from say whether clutter stood in front of it. Texels are computed independently. */
#include "stages/evaluate/texture/texel_facts.h"

#include "common/base/parallel.h"
#include "stages/evaluate/texture/texel_places.h"

enum { ROWS = 4 };

struct tile_job {
    struct texel_facts *facts;
    const struct texel_truth *truth;
    const struct atlas_page *page;
    const struct atlas_tile *tile;
    struct texel_places places;
    struct vec3 normal; /* in the truth's world */
};

/* What the source's photo shows. */
static uint32_t source_flags(const struct texel_truth *t, int source, const struct surface_point *p)
{
    const int at = t->source_shell[source];
    const uint32_t flags = t->source_own[source] ? 0 : TEXEL_WARPED;
    if (at < 0 || !t->shell->views[at].clutter) return flags;
    switch (shell_view_sight(&t->shell->views[at], p)) {
    case SHELL_CLUTTER:
        return flags | TEXEL_SOURCE_KNOWN | TEXEL_SOURCE_CLUTTER;
    case SHELL_CLEAN:
        return flags | TEXEL_SOURCE_KNOWN | TEXEL_SOURCE_CLEAN;
    default:
        return flags | TEXEL_SOURCE_KNOWN; /* it shows another face: a wrong texel, but not for clutter */
    }
}

static bool clean_somewhere(const struct texel_truth *t, struct vec3 scene, const struct surface_point *p)
{
    for (int i = 0; i < t->view_count; i++) {
        const struct photo_view *v = &t->views[i];
        double x, y;
        if (!v->known || !(view_project(v->view, scene, &x, &y) > 0)) continue;
        if (!(x >= 0 && y >= 0 && x < v->view->width && y < v->view->height)) continue;
        if (!v->known[(size_t)y * (size_t)v->view->width + (size_t)x]) continue;
        if (shell_view_sight(&t->shell->views[v->shell], p) == SHELL_CLEAN) return true;
    }
    return false;
}

/* The viewpoint's own photo shows clutter at the point, of another colour than the surface's. */
static bool own_clutter(const struct texel_truth *t, const struct surface_point *p, const float radiance[3])
{
    float shown[3];
    if (t->own < 0 || !t->own_photo->data) return false;
    const struct shell_view *own = &t->shell->views[t->own];
    if (shell_view_sight(own, p) != SHELL_CLUTTER) return false;
    return shell_view_radiance(shown, own, t->own_photo, p, t->shell->tolerance, false) &&
           texture_texel_differs(shown, radiance);
}

static struct texel_facts facts_of(const struct tile_job *job, int x, int y)
{
    const struct texel_truth *t = job->truth;
    const size_t at = (size_t)y * (size_t)job->page->width + (size_t)x;
    const uint32_t source = job->page->source[at];
    struct texel_facts facts = {0, TEXEL_EXISTS};
    struct vec3 model;
    float radiance[3], found[3];
    if (source == ATLAS_NONE || !texel_place(&model, &job->places, x + 0.5, y + 0.5)) return (struct texel_facts){0, 0};
    const struct surface_point p = {truth_from_model_point(t->frame, model), job->normal, job->tile->face};
    facts.flags |= source < ATLAS_VIEWS ? TEXEL_FILLED : source_flags(t, (int)(source - ATLAS_VIEWS), &p);
    if (clean_somewhere(t, world_from_model_point(&t->frame->axes, model), &p)) facts.flags |= TEXEL_CLEAN_SOMEWHERE;
    if (!shell_radiance(radiance, t->shell, &p, t->own)) return facts;
    for (size_t c = 0; c < 3; c++) found[c] = (float)(t->scale * job->page->rgb[3 * at + c]);
    facts.square = texture_texel_square(found, radiance, t->white);
    facts.flags |= TEXEL_COMPARED;
    if (texture_texel_differs(found, radiance)) facts.flags |= TEXEL_DIFFERS;
    if (own_clutter(t, &p, radiance)) facts.flags |= TEXEL_OWN_CLUTTER;
    return facts;
}

static void tile_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct tile_job *job = ctx;
    const size_t width = (size_t)job->tile->width;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < width; x++)
            job->facts[y * width + x] = facts_of(job, job->tile->x + (int)x, job->tile->y + (int)y);
}

void texel_facts_of_tile(struct texel_facts *facts, const struct texel_truth *truth, const struct atlas_page *page,
                         const struct atlas_tile *tile, struct vec3 normal, double offset)
{
    struct tile_job job = {facts, truth, page, tile, {{{0}}, {0}}, {0, 0, 0}};
    const size_t count = (size_t)tile->width * (size_t)tile->height;
    const struct mat3 world_from_scene = truth->frame->truth_from_scene.rotation;
    job.normal = mat3_apply(world_from_scene, world_from_model_direction(&truth->frame->axes, normal));
    for (size_t i = 0; i < count; i++) facts[i] = (struct texel_facts){0, 0};
    if (texel_places_init(&job.places, tile, normal, offset)) parallel_for((size_t)tile->height, ROWS, tile_rows, &job);
}
