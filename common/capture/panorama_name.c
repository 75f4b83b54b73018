/* panorama_name.c - see panorama_name.h. */
#include "common/capture/panorama_name.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/numbers.h"

char *panorama_name_make(const char *panorama, int view)
{
    char *name = NULL;
    return asprintf(&name, "%s_yaw%03d.png", panorama, view * PANORAMA_STEP) < 0 ? NULL : name;
}

size_t panorama_name_read(int *yaw, const char *name)
{
    const char *at = strrchr(name, '_');
    if (!at || at == name || strncmp(at, "_yaw", 4) != 0 || strspn(at + 4, "0123456789") != 3) return 0;
    if (at[7] && strcmp(at + 7, ".png") != 0) return 0;
    *yaw = atoi(at + 4);
    return *yaw < 360 && *yaw % PANORAMA_STEP == 0 ? (size_t)(at - name) : 0;
}

bool panorama_name_same(const char *a, const char *b)
{
    int yaw;
    const size_t length = panorama_name_read(&yaw, a);
    return length && length == panorama_name_read(&yaw, b) && !strncmp(a, b, length);
}

struct quat panorama_name_turn(int yaw)
{
    const double half = yaw * DEGREE / 2;
    return (struct quat){cos(half), 0, -sin(half), 0};
}
