/* product.c - paths of products, and the product of a path.
 *
 * A path is a pattern: a folder and a file with {placeholders}. A placeholder stands for one of its forms, which are
 * separated by | and in which * is a name and # a number. Making a path replaces each placeholder by the key's value;
 * finding a path's product tries all forms of all placeholders, by backtracking, and counts the letters that the
 * pattern gives, so that "ids/index.txt" is the index and not the record of a view that is called index. */
#include "common/product/product.h"

#include <assert.h>
#include <ctype.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "common/base/scan.h"

const struct product products[PRODUCT_COUNT] = {
#define PRODUCT(id, root, folder, file, format, head, stages, meaning) \
    [PRODUCT_##id] = {#id, PRODUCT_##root, folder, file, PRODUCT_IS_##format, head, stages, meaning},
#include "common/product/products.def"
#undef PRODUCT
};

static const struct placeholder {
    const char *field;
    size_t offset;
    const char *shown, *forms;
} placeholders[PRODUCT_KEY_COUNT] = {
#define PRODUCT_KEY(field, type, shown, forms, meaning) {#field, offsetof(struct product_key, field), shown, forms},
#include "common/product/product_keys.def"
#undef PRODUCT_KEY
};

/* The placeholder at `at`, which points to its brace; *end is set behind its closing brace. */
static const struct placeholder *placeholder_at(const char *at, const char **end)
{
    const size_t n = strcspn(++at, "}");

    *end = at + n + 1;
    for (int i = 0; i < PRODUCT_KEY_COUNT; i++)
        if (!strncmp(placeholders[i].field, at, n) && !placeholders[i].field[n]) return &placeholders[i];
    assert(!"a placeholder of products.def that product_keys.def lacks");
    return NULL;
}

static unsigned keys_of(const char *pattern)
{
    unsigned keys = 0;

    while ((pattern = strchr(pattern, '{'))) keys |= 1u << (placeholder_at(pattern, &pattern) - placeholders);
    return keys;
}

unsigned product_keys(enum product_id id) { return keys_of(products[id].folder) | keys_of(products[id].file); }

bool product_made_by(enum product_id id, const char *stage)
{
    const size_t n = strlen(stage);

    for (const char *p = products[id].stages; (p = strstr(p, stage)); p += n)
        if ((p == products[id].stages || p[-1] == ' ') && (!p[n] || p[n] == ' ')) return true;
    return false;
}

/* --- from a product to its path --- */

/* The value of a placeholder in a key; text is room for a number. */
static const char *value_of(const struct placeholder *place, const struct product_key *key, char text[16], int *length)
{
    const char *at = (const char *)key + place->offset, *value;

    if (*place->forms == '#') {
        int number;
        memcpy(&number, at, sizeof number);
        snprintf(text, 16, "%d", number);
        value = text;
    } else {
        memcpy(&value, at, sizeof value);
    }
    if (!value) {
        value = place->forms;
        *length = (int)strcspn(value, "|");
        assert(!memchr(value, '*', (size_t)*length)); /* the key lacks a name that the path has */
    } else {
        *length = (int)strlen(value);
    }
    return value;
}

/* Appends the expanded pattern to the path of `length` bytes; key NULL: with the names that documents show. */
static size_t expand(char path[FILE_PATH], size_t length, const char *pattern, const struct product_key *key)
{
    while (*pattern && length < FILE_PATH) {
        char number[16];
        const char *text = pattern;
        int n = (int)strcspn(pattern, "{");

        pattern += n;
        if (!n) {
            const struct placeholder *place = placeholder_at(pattern, &pattern);
            text = key ? value_of(place, key, number, &n) : place->shown;
            if (!key) n = (int)strlen(text);
        }
        length += (size_t)snprintf(path + length, FILE_PATH - length, "%.*s", n, text);
    }
    return length;
}

static enum status expand_in(char path[FILE_PATH], const char *folder, size_t length, enum product_id id,
                             const struct product_key *key, struct err *err)
{
    char shown[SCAN_QUOTED];

    if (length && length < FILE_PATH) length += (size_t)snprintf(path + length, FILE_PATH - length, "/");
    if (length < FILE_PATH) length = expand(path, length, products[id].file, key);
    if (length < FILE_PATH) return ST_OK;
    return err_set(err, ST_IO, "the path of %s in %s is longer than %d bytes; use shorter names.", products[id].meaning,
                   scan_quote(shown, folder), FILE_PATH - 1);
}

enum status product_path_below(char path[FILE_PATH], const char *scene, enum product_id id,
                               const struct product_key *key, struct err *err)
{
    static const struct product_key none;
    size_t length = (size_t)snprintf(path, FILE_PATH, "%s%s", scene, *scene && *products[id].folder ? "/" : "");

    if (!key) key = &none;
    if (length < FILE_PATH) length = expand(path, length, products[id].folder, key);
    return expand_in(path, *scene ? scene : products[id].folder, length, id, key, err);
}

enum status product_path(char path[FILE_PATH], enum product_id id, const struct product_key *key, struct err *err)
{
    return product_path_below(path, "", id, key, err);
}

enum status product_path_in(char path[FILE_PATH], const char *folder, enum product_id id, const struct product_key *key,
                            struct err *err)
{
    static const struct product_key none;

    return expand_in(path, folder, (size_t)snprintf(path, FILE_PATH, "%s", folder), id, key ? key : &none, err);
}

enum status product_pattern(char pattern[FILE_PATH], enum product_id id, struct err *err)
{
    *pattern = '\0';
    return expand_in(pattern, products[id].folder, expand(pattern, 0, products[id].folder, NULL), id, NULL, err);
}

/* --- from a path to its product --- */

/* What is left of a pattern: up to three pieces, one after the other. */
struct rest {
    const char *text;
    size_t length;
    const struct rest *next;
};

static int match(const struct rest *rest, const char *path);

/* The best of the names that may begin the path, and of what follows each. */
static int match_name(const struct rest *after, const char *path, bool number)
{
    int best = -1;

    for (const char *p = path; *p && *p != '/' && (!number || isdigit((unsigned char)*p)); p++) {
        const int found = match(after, p + 1);
        if (found > best) best = found;
    }
    return best;
}

static int match_forms(const struct placeholder *place, const struct rest *after, const char *path)
{
    int best = -1;

    for (const char *form = place->forms; *form;) {
        const size_t n = strcspn(form, "|");
        const int found = match(&(struct rest){form, n, after}, path);
        if (found > best) best = found;
        form += n + (form[n] == '|');
    }
    return best;
}

/* How many letters of the path the pattern gives; -1: it is another's. */
static int match(const struct rest *rest, const char *path)
{
    while (rest && !rest->length) rest = rest->next;
    if (!rest) return *path ? -1 : 0;

    const char c = *rest->text;
    if (c == '{') {
        const char *end;
        const struct placeholder *place = placeholder_at(rest->text, &end);
        return match_forms(place, &(struct rest){end, rest->length - (size_t)(end - rest->text), rest->next}, path);
    }
    const struct rest after = {rest->text + 1, rest->length - 1, rest->next};
    if (c == '*' || c == '#') return match_name(&after, path, c == '#');
    if (c != *path) return -1;
    const int found = match(&after, path + 1);
    return found < 0 ? -1 : found + 1;
}

/* How well a path fits a product's pattern; -1: not at all. */
static int match_product(enum product_id id, const char *path)
{
    const struct product *p = &products[id];
    const struct rest file = {p->file, strlen(p->file), NULL}, slash = {"/", *p->folder != '\0', &file};

    return match(&(struct rest){p->folder, strlen(p->folder), &slash}, path);
}

/* The next folder or file of a path; NULL: there is none. */
static const char *next_part(const char *path)
{
    const char *slash = strchr(path, '/');
    return slash ? slash + 1 : NULL;
}

enum product_id product_at(const char *path)
{
    enum product_id best = PRODUCT_COUNT;
    int most = -1;

    for (const char *p = path; p; p = next_part(p))
        for (enum product_id id = 0; id < PRODUCT_COUNT; id++) {
            const int found = match_product(id, p);
            if (found > most) most = found, best = id;
        }
    return best;
}

const char *product_name(enum product_id id, const char *path)
{
    const char *last = path;

    for (const char *p = path; p; p = next_part(p)) {
        last = p;
        if (id != PRODUCT_COUNT && match_product(id, p) >= 0) return p;
    }
    if (id == PRODUCT_COUNT) return last;
    for (const char *p = strchr(products[id].file, '/'); p && last > path; p = strchr(p + 1, '/'))
        for (last--; last > path && last[-1] != '/'; last--)
            ;
    return last;
}

/* --- reading and writing --- */

enum status product_read_head(struct textfile *t, int *version, enum product_id id, struct err *err)
{
    const char *head = products[id].head;
    char word[64];
    const size_t length = strcspn(head, " ");
    int64_t wanted = 0, found = 0;

    snprintf(word, sizeof word, "%.*s", (int)length, head);
    scan_int(head + length + 1, &wanted);
    if (!textfile_expect_line(t, word, err) && !textfile_int(t, "the version", 1, wanted, &found, err))
        textfile_end(t, err);
    if (!err->status && version) *version = (int)found;
    return err->status;
}

enum status product_open(struct textfile *t, int *version, enum product_id id, const char *path,
                         struct provenance *prov, struct err *err)
{
    provenance_open(prov, product_name(id, path), t, path, err);
    if (!err->status && products[id].head) product_read_head(t, version, id, err);
    if (err->status) textfile_release(t);
    return err->status;
}

enum status product_begin(struct outfile *f, enum product_id id, const char *path, const struct provenance *prov,
                          struct err *err)
{
    if (outfile_open(f, path, err)) return err->status;
    if (prov) provenance_print(prov, f->fp);
    if (products[id].head) fprintf(f->fp, "%s\n", products[id].head);
    return ST_OK;
}
