/* live_json.h - a model as JSON, for pages.
 *
 *   walls     name, line, normal [x, y] and at: the in face n p = c; span: S where openings may lie; foot, top,
 *             thickness, sign, origin, direction; corners: four in plan; angled
 *   openings  name, line, kind, wall, s, z, fill; slots: name, line, kind, room, low, high
 *   boxes     name, line, low, high, turn; rooms: name, line, floor, ceiling, walls, middle
 *   things    name
 *   faces     name, id, glass, normal, loops of vertices, the outer one first
 *   vertices  [x, y, z] each
 *
 * line: of the statement in its script. Removed items are left out. */
#ifndef REMODEL_BUILD_MODEL_LIVE_JSON_H
#define REMODEL_BUILD_MODEL_LIVE_JSON_H

#include "stages/build_model/building/building.h"

/* *text is owned by the caller. ST_NOMEM. */
enum status live_json_model(char **text, const struct building *b, struct err *err);
enum status live_json_photos(char **text, const struct placer *placer, struct err *err);

#endif
