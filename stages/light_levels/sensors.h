/* sensors.h - the points at which light is asked for: work planes and floors of rooms, and named places. */
#ifndef REMODEL_LEVELS_SENSORS_H
#define REMODEL_LEVELS_SENSORS_H

#include "common/gather/model_field.h"
#include "common/model/model_metre.h"
#include "common/model/model_plan.h"
#include "stages/light_levels/levels_params.h"
#include "stages/light_levels/place_list.h"

enum sensor_kind {
    SENSOR_WORK_PLANE,
    SENSOR_WORK_PLANE_LOW, /* where a metre is a guess: at the ends of its interval */
    SENSOR_WORK_PLANE_HIGH,
    SENSOR_FLOOR,         /* below nothing */
    SENSOR_FLOOR_COVERED, /* below furniture, boxes and objects */
    SENSOR_PLACE,
    SENSOR_KINDS
};

/* Points that are summed up together. */
struct sensor_area {
    enum sensor_kind kind;
    const char *name; /* of the room or place */
    int first, count;
    int room;    /* of the plan; -1: of a place in none */
    double step; /* distance of neighbours, model units */
};

/* {0} is the empty state; everything is owned but the names. */
struct sensors {
    struct gather_point *points;
    struct sensor_area *areas;
    int count, area_count;
};

/* The word of a kind in files, such as work-plane or place. */
const char *sensor_kind_word(enum sensor_kind kind);

/* Spreads points over the rooms of a plan and over places. Points inside solids are left out. plan and places must
 * outlive s, which the caller releases in each case. ST_DATA: a place whose points all lie inside solids, with file and
 * line. */
enum status sensors_make(struct sensors *s, const struct model_field *field, const struct model_plan *plan,
                         const struct place_list *places, const struct levels_params *params,
                         const struct model_metre *metre, struct err *err);
void sensors_release(struct sensors *s);

#endif
