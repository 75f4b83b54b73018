/* tour_stops.h - where a tour stops: as scenes/NAME/tour.txt says, else in each room.
 *
 *   remodel-tour 1
 *   room NAME          the viewpoint in this room that is nearest to its middle
 *   photo ID           this viewpoint
 *   speed M            metres a second (without a scale: median distances between viewpoints) to the stops below
 *
 * A line for each stop, in order. Without the file the tour of an edit walks around what changed (tour_walk.h);
 * otherwise it begins at the viewpoint that sees farthest, and goes on to
 * the room that is nearest by the ways of the graph, until it has been in all of them. */
#ifndef REMODEL_TOUR_STOPS_H
#define REMODEL_TOUR_STOPS_H

#include "common/model/model_plan.h"
#include "stages/plan_tour/tour_graph.h"

/* *stops: malloc'ed; one or more. speed: where the script gives none. script: tour.txt; NULL: none. ST_DATA with file
 * and line: an unknown room or photo, one without a usable viewpoint, one that no way leads to; a list without stops.
 * Without a script, rooms that no way leads to are left out, and a warning names them. */
enum status tour_stops_find(struct tour_stop **stops, int *count, const struct tour_graph *g,
                            const struct model_plan *plan, double speed, const char *script, struct provenance *prov,
                            struct err *err);

/* Whether a point lies in a room's outline. */
bool tour_room_holds(const struct model_room *room, struct vec3 p);

#endif
