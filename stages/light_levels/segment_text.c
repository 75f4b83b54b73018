/* segment_text.c - see segment_text.h.
 *
 * A glyph is a list of strokes between places of a grid of 3 x 5: "0242" is a stroke from column 0, row 2 to column 4,
 * row 2; columns count 0, 2, 4 and rows 0 to 8. */
#include "stages/light_levels/segment_text.h"

#include <string.h>

static const struct glyph {
    char letter;
    const char *strokes;
} glyphs[] = {
    {'0', "00404048 48080800"},
    {'1', "12202028"},
    {'2', "0040404444040408 0848"},
    {'3', "0040404848080444"},
    {'4', "000404444048"},
    {'5', "4000000404444448 4808"},
    {'6', "400000080848484444 04"},
    {'7', "00404018"},
    {'8', "00404048480808000444"},
    {'9', "4404040000404048 4808"},
    {':', "2222 2626"},
    {'-', "0444"},
    {'.', "2828"},
    {'l', "2028"},
    {'x', "03480843"},
    {'%', "40080011 3748"},
    {'<', "41044408"},
    {'>', "01444408"},
};
static const double ADVANCE = 0.72, WIDTH = 0.5, THICK = 0.055; /* of the height */

static const char *strokes_of(char letter)
{
    for (size_t i = 0; i < sizeof glyphs / sizeof *glyphs; i++)
        if (glyphs[i].letter == letter) return glyphs[i].strokes;
    return "";
}

double segment_text_width(const char *text, double height)
{
    const size_t n = strlen(text);
    return n ? height * (ADVANCE * (double)(n - 1) + WIDTH) : 0;
}

void segment_text_draw(const struct canvas *k, double left, double top, double height, const char *text,
                       const unsigned char colour[3])
{
    for (; *text; text++, left += ADVANCE * height) {
        double at[4];
        int count = 0;
        for (const char *s = strokes_of(*text); *s; s++) {
            if (*s == ' ') continue;
            at[count] = (count & 1 ? top + height * (*s - '0') / 8 : left + WIDTH * height * (*s - '0') / 4);
            if (++count < 4) continue;
            draw_line(k, at[0], at[1], at[2], at[3], THICK * height, colour);
            count = 0;
        }
    }
}
