/* draw_text.c - texts as JSON strings; see draw_data.h. */
#include <stdio.h>

#include "stages/draw_model/draw_data.h"

void draw_data_write_string(FILE *to, const char *text, size_t size)
{
    putc('"', to);
    for (size_t i = 0; i < size; i++) {
        const unsigned char c = (unsigned char)text[i];
        if (c == '\n')
            fputs("\\n", to);
        else if (c < ' ' || c == 127)
            fprintf(to, "\\u%04x", c);
        else
            fprintf(to, c == '"' || c == '\\' ? "\\%c" : "%c", c);
    }
    putc('"', to);
}
