/* data_file.c - see data_file.h. */
#include "stages/walk/data_file.h"

#include "common/product/product.h"

enum status data_file_open(struct data_file *f, const char *folder, const char *name, struct err *err)
{
    char path[FILE_PATH];
    *f = (struct data_file){0};
    if (product_path_in(path, folder, PRODUCT_WALK_DATA, &(struct product_key){.name = name}, err) ||
        outfile_open(&f->out, path, err))
        return err->status;
    f->fp = f->out.fp;
    fputs("walk_take(", f->fp);
    data_write_text(f->fp, name);
    fputs(", ", f->fp);
    return ST_OK;
}

enum status data_file_commit(struct data_file *f, int64_t *bytes, struct err *err)
{
    fputs(");\n", f->fp);
    *bytes += ftell(f->fp);
    return outfile_commit(&f->out, err);
}

void data_file_discard(struct data_file *f)
{
    outfile_discard(&f->out);
    f->fp = NULL;
}

void data_write_text(FILE *to, const char *text)
{
    if (!text) {
        fputs("null", to);
        return;
    }
    putc('"', to);
    for (const char *c = text; *c; c++) {
        if ((unsigned char)*c < ' ' || *c == '"' || *c == '\\' || *c == '<')
            fprintf(to, "\\u%04x", (unsigned char)*c);
        else
            putc(*c, to);
    }
    putc('"', to);
}

void data_write_number(FILE *to, double number) { fprintf(to, "%.8g", number); }

void data_write_numbers(FILE *to, const double *numbers, int count)
{
    putc('[', to);
    for (int i = 0; i < count; i++) {
        if (i) putc(',', to);
        data_write_number(to, numbers[i]);
    }
    putc(']', to);
}

void data_write_point(FILE *to, struct vec3 p) { data_write_numbers(to, (const double[]){p.x, p.y, p.z}, 3); }
