/* fuzz_tour.c - reader of tour.txt: any bytes give usable viewpoints that ways join, or an error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/plan_tour/tour_graph.h"
#include "stages/plan_tour/tour_stops.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

enum { NODES = 4 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    /* two rooms, a and b; p1 and p2 in a, p3 in b, p4 in a wall; no way leads from a to b, but for p2 */
    static const char *const photos[NODES] = {"p1", "p2", "p3", "p4"};
    struct model_room_corner corners[2][4] = {{{.x = 0}, {.x = 2}, {.x = 2, .y = 2}, {.y = 2}},
                                              {{.x = 3}, {.x = 5}, {.x = 5, .y = 2}, {.x = 3, .y = 2}}};
    struct model_room rooms[2];
    struct tour_node nodes[NODES];
    float weights[NODES * NODES];
    const struct model_plan plan = {.rooms = rooms, .room_count = 2};
    const struct tour_graph g = {.nodes = nodes, .weights = weights, .count = NODES, .unit = 1};
    char path[FUZZ_PATH], names[2][2] = {"a", "b"};
    struct tour_stop *stops = NULL;
    int count = 0;
    struct err err = ERR_INIT;

    for (int r = 0; r < 2; r++)
        rooms[r] = (struct model_room){
            .name = names[r], .ceiling = {{2.5, 0, 0}}, .ceilings = 1, .corners = corners[r], .corner_count = 4};
    for (int i = 0; i < NODES; i++)
        nodes[i] = (struct tour_node){
            .photo = photos[i], .centre = {i < 2 ? 0.5 + i : 4, 1, 1.5}, .axis = {1, 0, 0}, .usable = i < 3, .open = 1};
    for (int i = 0; i < NODES * NODES; i++) weights[i] = i % (NODES + 1) ? INFINITY : 0;
    weights[1 * NODES + 2] = weights[2 * NODES + 1] = 2;

    fuzz_file(path, data, size);
    if (tour_stops_find(&stops, &count, &g, &plan, 1, path, NULL, &err)) {
        if (!strstr(err.text, path)) abort();
    } else if (count < 1)
        abort();
    else
        for (int i = 0; i < count; i++) {
            if (stops[i].node < 0 || stops[i].node > 2) abort();
            if (!(stops[i].speed >= 0.01 && stops[i].speed <= 100)) abort();
            if (i &&
                (stops[i].node == stops[i - 1].node || !isfinite(weights[stops[i].node * NODES + stops[i - 1].node])))
                abort();
        }
    free(stops);
    unlink(path);
    return 0;
}
