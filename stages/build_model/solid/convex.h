/* convex.h - convex solids on the lattice, their facets and plane sections as polygons with exact corners. */
#ifndef REMODEL_BUILD_MODEL_CONVEX_H
#define REMODEL_BUILD_MODEL_CONVEX_H

#include "stages/build_model/solid/exact.h"
#include "stages/build_model/solid/solid.h"

/* A half-space rounded to the lattice: n . p <= d in lattice units. */
struct lattice_half_space {
    int64_t n[3], d;
    bool everywhere; /* contains everything within SOLID_REACH */
};

/* The half-spaces of all solids, in order; the caller frees them. Oblique planes that nearly coincide become one. */
enum status convex_half_spaces(struct lattice_half_space **half_spaces, const struct solid_list *list, struct err *err);

struct polygon_edge {
    int corner; /* point in which it begins */
    int plane;  /* that bounds the polygon here */
    int line;
};

/* Strictly convex, in a plane; its edges run in either orientation. */
struct polygon {
    int plane, solid;
    int side; /* the solid lies below this facet (1: the plane's normal points outwards), above (-1), or is cut (0) */
    int name; /* of a facet: rank of its name in the list; section: -1 */
    int first, count; /* edges */
    double low[3], high[3];
};

struct convex {
    int first, count; /* facets among the polygons */
    double low[3], high[3];
};

struct convex_set {
    struct exact_space space;
    struct convex *solids; /* all owned */
    struct polygon *polygons;
    struct polygon_edge *edges, *scratch[2];
    int *signs;
    int count, capacity, polygon_count, polygon_capacity, edge_count, edge_capacity, scratch_capacity[2];
    int signs_capacity;
};

/* names: rank of each half-space's name. ST_DATA: the solid is empty, flat, unbounded or out of reach. */
enum status convex_set_add(struct convex_set *set, const struct solid *solid,
                           const struct lattice_half_space *half_spaces, const int *names, struct err *err);

/* The polygon in which a plane cuts a solid's inside; -1: it does not. */
enum status convex_section(struct convex_set *set, int solid, int plane, int *polygon, struct err *err);

/* Boxes touch or overlap, within rounding. */
static inline bool boxes_meet(const double low0[3], const double high0[3], const double low1[3], const double high1[3])
{
    for (int i = 0; i < 3; i++)
        if (low0[i] > high1[i] + 0.25 || low1[i] > high0[i] + 0.25) return false;
    return true;
}

void convex_set_release(struct convex_set *set);

#endif
