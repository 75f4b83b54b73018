/* embree.h - rays by Embree 3 or 4, whichever is installed: they take the settings of a query in different structs.
 *
 * The packets are coherent: their rays begin near each other and go alike. valid: -1 for a ray that counts, else 0. */
#ifndef REMODEL_EMBREE_H
#define REMODEL_EMBREE_H

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#if RTC_VERSION_MAJOR >= 4

static inline void embree_intersect(RTCScene scene, struct RTCRayHit *r) { rtcIntersect1(scene, r, NULL); }
static inline void embree_occluded(RTCScene scene, struct RTCRay *r) { rtcOccluded1(scene, r, NULL); }

static inline void embree_intersect_packet(RTCScene scene, const int *valid, struct RTCRayHit8 *r)
{
    struct RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, r, &args);
}

static inline void embree_occluded_packet(RTCScene scene, const int *valid, struct RTCRay8 *r)
{
    struct RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded8(valid, scene, r, &args);
}

#else

static inline void embree_intersect(RTCScene scene, struct RTCRayHit *r)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, r);
}

static inline void embree_occluded(RTCScene scene, struct RTCRay *r)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, r);
}

static inline void embree_intersect_packet(RTCScene scene, const int *valid, struct RTCRayHit8 *r)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &context, r);
}

static inline void embree_occluded_packet(RTCScene scene, const int *valid, struct RTCRay8 *r)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(valid, scene, &context, r);
}

#endif
#endif
