/* html.c - see html.h. */
#include "stages/report/html.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* Length and code of the UTF-8 character at `s`; 0 if it is not one (an overlong form or a surrogate is not). */
static size_t utf8_next(const unsigned char *s, size_t size, uint32_t *code)
{
    static const uint32_t MIN_CODE[5] = {0, 0, 0x80, 0x800, 0x10000};
    size_t length = s[0] < 0x80             ? 1
                    : (s[0] & 0xe0) == 0xc0 ? 2
                    : (s[0] & 0xf0) == 0xe0 ? 3
                    : (s[0] & 0xf8) == 0xf0 ? 4
                                            : 0;
    if (!length || length > size) return 0;
    *code = length == 1 ? s[0] : s[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((s[i] & 0xc0) != 0x80) return 0;
        *code = *code << 6 | (s[i] & 0x3fu);
    }
    if (*code < MIN_CODE[length] || *code > 0x10ffff || (*code >= 0xd800 && *code <= 0xdfff)) return 0;
    return length;
}

static bool allowed(uint32_t code)
{
    if (code < 0x20) return code == '\t' || code == '\n';
    if (code >= 0x7f && code < 0xa0) return false;
    return (code & 0xfffe) != 0xfffe && !(code >= 0xfdd0 && code <= 0xfdef);
}

void html_bytes(FILE *to, const char *text, size_t size)
{
    const unsigned char *s = (const unsigned char *)text;
    for (size_t at = 0; at < size;) {
        uint32_t code = 0;
        size_t length = utf8_next(s + at, size - at, &code);
        if (!length || !allowed(code))
            fputs("\xef\xbf\xbd", to);
        else if (code == '&')
            fputs("&amp;", to);
        else if (code == '<')
            fputs("&lt;", to);
        else if (code == '>')
            fputs("&gt;", to);
        else if (code == '"')
            fputs("&quot;", to);
        else if (code == '\'')
            fputs("&#39;", to);
        else
            fwrite(s + at, 1, length, to);
        at += length ? length : 1;
    }
}

void html_text(FILE *to, const char *text) { html_bytes(to, text, strlen(text)); }

void html_printf(FILE *to, const char *fmt, ...)
{
    char text[4096];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    html_text(to, text);
}

void html_address(FILE *to, const char *path)
{
    static const char kept[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~@/";
    for (const char *c = path; *c; c++)
        if (strchr(kept, *c))
            fputc(*c, to);
        else
            fprintf(to, "%%%02X", (unsigned char)*c);
}
