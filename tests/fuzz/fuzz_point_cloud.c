/* fuzz_point_cloud.c - points.ply: any bytes give valid points that can be written and read back, or an error. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/capture/point_cloud.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static char path[FUZZ_PATH];

static void remove_file(void) { unlink(path); }

static void check(const struct point_cloud *cloud)
{
    if (!(cloud->cell >= 0)) abort();
    for (size_t i = 0; i < cloud->count; i++) {
        const struct cloud_point *p = &cloud->points[i];
        if (!isfinite(p->position.x) || !isfinite(p->position.y) || !isfinite(p->position.z) || !p->views) abort();
        if (!(p->confidence >= 0 && p->confidence <= 1) || !(fabsf(p->normal[0]) < 1.01f)) abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int opened;
    struct point_cloud cloud, again;
    struct err err = ERR_INIT;

    if (!opened) {
        fuzz_file(path, data, 0);
        if (atexit(remove_file)) abort();
        opened = 1;
    }
    FILE *fp = fopen(path, "wb");
    if (!fp || (size && fwrite(data, 1, size, fp) != size) || fclose(fp)) abort();
    if (point_cloud_read(&cloud, path, NULL, &err)) {
        if (cloud.points || cloud.count || !strstr(err.text, path)) abort();
        return 0;
    }
    check(&cloud);
    if (point_cloud_write(&cloud, path, NULL, &err) || point_cloud_read(&again, path, NULL, &err)) abort();
    if (again.count != cloud.count || again.cell != cloud.cell) abort();
    for (size_t i = 0; i < cloud.count; i++)
        if (memcmp(&again.points[i].position, &cloud.points[i].position, sizeof cloud.points[i].position)) abort();
    point_cloud_release(&again);
    point_cloud_release(&cloud);
    return 0;
}
