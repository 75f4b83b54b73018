/* level_scale.c - see level_scale.h. */
#include "stages/light_levels/level_scale.h"

#include <math.h>
#include <string.h>

#include "common/image/false_colour.h"

enum { STEPS = 60 };
static const double KEY_HEIGHT = 14; /* px */

struct level_scale level_scale_of(const char *unit, int annual)
{
    static const double steps[] = {1, 2, 3, 5};
    struct level_scale s = {.unit = unit, .low = 0.1, .high = 10};
    if (!strcmp(unit, "lx")) s.low = 10, s.high = 10000;
    if (annual) s.low = 1, s.high = 100;
    for (int i = 0; i < LEVEL_LINES; i++) {
        s.lines[i] = steps[i % 4] * s.low * pow(10, i / 4);
        if (s.lines[i] <= s.high * 1.001) s.line_count = i + 1;
    }
    return s;
}

double level_scale_place(const struct level_scale *s, double value)
{
    return value > s->low ? fmin(1, log(value / s->low) / log(s->high / s->low)) : 0;
}

void level_scale_colour(const struct level_scale *s, double value, unsigned char rgb[3])
{
    colour_of_ramp(level_scale_place(s, value), rgb);
}

const char *level_scale_number(char text[32], double value)
{
    if (!(value >= 999.5)) {
        snprintf(text, 32, "%.3g", value);
        return text;
    }
    const double step = pow(10, floor(log10(value)) - 2);
    snprintf(text, 32, "%.0f", step * round(value / step));
    return text;
}

void level_scale_put_key(const struct level_scale *s, FILE *to, double x, double y, double width)
{
    for (int i = 0; i < STEPS; i++) {
        unsigned char c[3];
        colour_of_ramp((i + 0.5) / STEPS, c);
        fprintf(to, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.0f\" fill=\"#%02x%02x%02x\"/>\n",
                x + i * width / STEPS, y, width / STEPS + 0.5, KEY_HEIGHT, c[0], c[1], c[2]);
    }
    for (int i = 0; i < s->line_count; i++) {
        const double at = x + width * level_scale_place(s, s->lines[i]);
        const char *less = i == 0 ? "\xe2\x89\xa4 " : i == s->line_count - 1 ? "\xe2\x89\xa5 " : "";
        fprintf(to, "<path stroke=\"#222\" d=\"M%.1f %.1fv4\"/>\n", at, y + KEY_HEIGHT);
        if (i % 4 == 2) continue; /* 3 is near 2 */
        fprintf(to, "<text class=\"key\" x=\"%.1f\" y=\"%.1f\">%s%g</text>\n", at, y + KEY_HEIGHT + 17, less,
                s->lines[i]);
    }
    fprintf(to, "<text class=\"key\" x=\"%.1f\" y=\"%.1f\" style=\"text-anchor:start\">%s</text>\n", x + width + 6,
            y + 12, s->unit);
}
