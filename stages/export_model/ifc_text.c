/* ifc_text.c - identifiers and strings of STEP files. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <xxhash.h>

#include "stages/export_model/writers.h"

/* A GUID of IFC: 128 bits as 22 digits of base 64, the first of which has two bits. */
void ifc_guid(char guid[23], const char *text)
{
    static const char digits[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$";
    const XXH128_hash_t h = XXH3_128bits(text, strlen(text));
    uint64_t high = h.high64, low = h.low64;
    for (int i = 21; i >= 0; i--) {
        guid[i] = digits[low & 63];
        low = low >> 6 | high << 58;
        high >>= 6;
    }
    guid[22] = '\0';
}

/* The next character of UTF-8 text; bytes that are not UTF-8 become U+FFFD. */
static uint32_t next_character(const unsigned char **at)
{
    const unsigned char *c = *at;
    const int more = *c < 0x80 ? 0 : *c >> 5 == 6 ? 1 : *c >> 4 == 14 ? 2 : *c >> 3 == 30 ? 3 : -1;
    uint32_t value = more == 0 ? *c : more < 0 ? 0xFFFD : *c & (0x3FU >> more);
    ++*at;
    for (int i = 0; i < more; i++) {
        if (**at >> 6 != 2) return 0xFFFD;
        value = value << 6 | (*(*at)++ & 0x3FU);
    }
    return value;
}

void ifc_text(FILE *to, const char *text)
{
    fputc('\'', to);
    for (const unsigned char *c = (const unsigned char *)text; *c;) {
        const uint32_t value = next_character(&c);
        if (value == '\'')
            fputs("''", to);
        else if (value == '\\')
            fputs("\\\\", to);
        else if (value >= 32 && value < 127)
            fputc((int)value, to);
        else if (value < 0x10000)
            fprintf(to, "\\X2\\%04X\\X0\\", (unsigned)value);
        else
            fprintf(to, "\\X4\\%08X\\X0\\", (unsigned)value);
    }
    fputc('\'', to);
}
