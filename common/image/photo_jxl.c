/* photo_jxl.c - JPEG XL files, by libjxl. Rows are as stored, with the orientation reported. More than 8 bits become
 * 16. Alpha is dropped; of an animation the first frame is read. libjxl decodes lossy files to colours of any space: if
 * the original has an ICC profile, of which it knows nothing, 16 bits of BT.2020 are asked for. */
#include "common/image/photo_formats.h"

#include <stdlib.h>
#include <string.h>

#include <jxl/decode.h>
#include <jxl/version.h>

/* Until 0.9 functions had an argument for a format, unused. */
#if JPEGXL_NUMERIC_VERSION < JPEGXL_COMPUTE_NUMERIC_VERSION(0, 9, 0)
#define FORMAT NULL,
#else
#define FORMAT
#endif

enum { EXIF_ROOM = 1 << 16 };

struct jxl_reader {
    const struct photo_bytes *file;
    JxlDecoder *decoder;
    JxlPixelFormat format;
    unsigned char *pixels, *exif; /* owned */
    size_t exif_size;
    bool in_exif; /* the decoder is writing the EXIF box */
    bool any_space, grey;
    int primaries, transfer; /* codes of ITU-T H.273; 0: an ICC profile */
    unsigned char *icc;      /* owned */
    size_t icc_size;
};

static enum status jxl_damaged(const struct jxl_reader *r, struct err *err)
{
    return err_set(err, ST_DATA, "%s is a damaged or cut-off JPEG XL file; copy or export the photo again.",
                   r->file->path);
}

static enum status take_info(struct photo *p, struct jxl_reader *r, struct err *err)
{
    JxlBasicInfo basic;
    if (JxlDecoderGetBasicInfo(r->decoder, &basic) != JXL_DEC_SUCCESS) return jxl_damaged(r, err);
    if (basic.exponent_bits_per_sample)
        return err_set(err, ST_DATA, "%s is a JPEG XL file of floating point samples; save it as EXR.", r->file->path);
    p->info.width = (int)basic.xsize;
    p->info.height = (int)basic.ysize;
    p->info.bits = basic.bits_per_sample > 8 ? 16 : 8;
    p->info.orientation = (int)basic.orientation;
    r->any_space = !basic.uses_original_profile;
    r->grey = basic.num_color_channels == 1;
    r->format = (JxlPixelFormat){3, p->info.bits == 16 ? JXL_TYPE_UINT16 : JXL_TYPE_UINT8, JXL_LITTLE_ENDIAN, 0};
    return photo_check_size(r->file->path, basic.xsize, basic.ysize, err);
}

/* The codes of an encoding that has some. */
static void find_codes(struct jxl_reader *r, const JxlColorEncoding *e)
{
    const bool d65 = e->white_point == JXL_WHITE_POINT_D65, grey = e->color_space == JXL_COLOR_SPACE_GRAY;
    const bool known =
        e->transfer_function == JXL_TRANSFER_FUNCTION_709 || e->transfer_function == JXL_TRANSFER_FUNCTION_LINEAR ||
        e->transfer_function == JXL_TRANSFER_FUNCTION_SRGB || e->transfer_function == JXL_TRANSFER_FUNCTION_PQ ||
        e->transfer_function == JXL_TRANSFER_FUNCTION_HLG;
    int primaries = 0;
    if (grey || (d65 && e->primaries == JXL_PRIMARIES_SRGB)) primaries = 1;
    if (!grey && d65 && e->primaries == JXL_PRIMARIES_2100) primaries = 9;
    if (!grey && d65 && e->primaries == JXL_PRIMARIES_P3) primaries = 12;
    if (!grey && e->white_point == JXL_WHITE_POINT_DCI && e->primaries == JXL_PRIMARIES_P3) primaries = 11;
    if (!known || !primaries) return;
    r->primaries = primaries;
    r->transfer = (int)e->transfer_function;
}

static enum status take_colours(struct photo *p, struct jxl_reader *r, struct err *err)
{
    const JxlColorEncoding wide = {.color_space = JXL_COLOR_SPACE_RGB,
                                   .white_point = JXL_WHITE_POINT_D65,
                                   .primaries = JXL_PRIMARIES_2100,
                                   .transfer_function = JXL_TRANSFER_FUNCTION_SRGB,
                                   .rendering_intent = JXL_RENDERING_INTENT_RELATIVE};
    JxlColorEncoding e;
    if (r->any_space && !r->grey &&
        JxlDecoderGetColorAsEncodedProfile(r->decoder, FORMAT JXL_COLOR_PROFILE_TARGET_ORIGINAL, &e) !=
            JXL_DEC_SUCCESS &&
        JxlDecoderSetPreferredColorProfile(r->decoder, &wide) == JXL_DEC_SUCCESS) {
        p->info.bits = 16;
        r->format.data_type = JXL_TYPE_UINT16;
    }
    if (JxlDecoderGetColorAsEncodedProfile(r->decoder, FORMAT JXL_COLOR_PROFILE_TARGET_DATA, &e) == JXL_DEC_SUCCESS)
        find_codes(r, &e);
    if (r->primaries || r->icc ||
        JxlDecoderGetICCProfileSize(r->decoder, FORMAT JXL_COLOR_PROFILE_TARGET_DATA, &r->icc_size) !=
            JXL_DEC_SUCCESS ||
        !r->icc_size)
        return ST_OK;
    if (!(r->icc = malloc(r->icc_size))) return err_nomem(err, "a colour profile", r->icc_size);
    if (JxlDecoderGetColorAsICCProfile(r->decoder, FORMAT JXL_COLOR_PROFILE_TARGET_DATA, r->icc, r->icc_size) !=
        JXL_DEC_SUCCESS)
        return jxl_damaged(r, err);
    return ST_OK;
}

/* An EXIF box begins with an offset of 4 bytes. */
static enum status take_exif(struct photo *p, const struct jxl_reader *r, struct err *err)
{
    const unsigned char *b = r->exif;
    const int orientation = p->info.orientation;
    if (r->exif_size < 4) return ST_OK;
    const size_t from = 4 + ((size_t)b[0] << 24 | (size_t)b[1] << 16 | (size_t)b[2] << 8 | b[3]);
    if (from < r->exif_size) photo_exif_take(&p->info, b + from, r->exif_size - from, err);
    p->info.orientation = orientation; /* the image's own holds */
    return err->status;
}

static enum status take_pixels(struct photo *p, const struct jxl_reader *r, struct err *err)
{
    const size_t samples = (size_t)p->info.width * (size_t)p->info.height * 3;
    if (photo_init_samples(p, err)) return err->status;
    for (size_t i = 0; i < samples; i++)
        p->samples[i] = p->info.bits == 8 ? r->pixels[i] : (uint16_t)(r->pixels[2 * i] | r->pixels[2 * i + 1] << 8);
    return ST_OK;
}

static void end_exif(struct jxl_reader *r)
{
    if (r->in_exif) r->exif_size = EXIF_ROOM - JxlDecoderReleaseBoxBuffer(r->decoder);
    r->in_exif = false;
}

static enum status begin_box(struct jxl_reader *r, struct err *err)
{
    JxlBoxType type;
    end_exif(r);
    if (r->exif || JxlDecoderGetBoxType(r->decoder, type, JXL_TRUE) != JXL_DEC_SUCCESS || memcmp(type, "Exif", 4) != 0)
        return ST_OK;
    if (!(r->exif = malloc(EXIF_ROOM))) return err_nomem(err, "EXIF data", EXIF_ROOM);
    r->in_exif = JxlDecoderSetBoxBuffer(r->decoder, r->exif, EXIF_ROOM) == JXL_DEC_SUCCESS;
    return ST_OK;
}

static enum status give_buffer(struct jxl_reader *r, struct err *err)
{
    size_t size = 0;
    if (JxlDecoderImageOutBufferSize(r->decoder, &r->format, &size) != JXL_DEC_SUCCESS) return jxl_damaged(r, err);
    free(r->pixels);
    if (!(r->pixels = malloc(size))) return err_nomem(err, "a photo", size);
    if (JxlDecoderSetImageOutBuffer(r->decoder, &r->format, r->pixels, size) != JXL_DEC_SUCCESS)
        return jxl_damaged(r, err);
    return ST_OK;
}

static enum status finish(struct photo *p, const struct jxl_reader *r, bool pixels, struct err *err)
{
    if (take_exif(p, r, err)) return err->status;
    if (r->primaries) return photo_set_codes(p, r->primaries, r->transfer, r->file->path, err);
    return photo_set_icc(p, r->icc, r->icc ? r->icc_size : 0, pixels, r->file->path, err);
}

static enum status decode(struct photo *p, struct jxl_reader *r, bool pixels, struct err *err)
{
    bool image = false, known = false;
    while (!err->status) {
        switch (JxlDecoderProcessInput(r->decoder)) {
        case JXL_DEC_BASIC_INFO:
            known = !take_info(p, r, err);
            break;
        case JXL_DEC_COLOR_ENCODING:
            take_colours(p, r, err);
            break;
        case JXL_DEC_BOX:
            begin_box(r, err);
            break;
        case JXL_DEC_BOX_NEED_MORE_OUTPUT: /* no camera writes this much */
            end_exif(r);
            r->exif_size = 0;
            break;
        case JXL_DEC_NEED_IMAGE_OUT_BUFFER:
            give_buffer(r, err);
            break;
        case JXL_DEC_FULL_IMAGE:
            if (!image && pixels) take_pixels(p, r, err);
            image = true;
            break;
        case JXL_DEC_SUCCESS:
            end_exif(r);
            return known && (image || !pixels) ? finish(p, r, pixels, err) : jxl_damaged(r, err);
        default:
            jxl_damaged(r, err);
        }
    }
    return err->status;
}

enum status photo_read_jxl(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err)
{
    struct jxl_reader r = {.file = file, .decoder = JxlDecoderCreate(NULL)};
    if (!r.decoder) return err_nomem(err, "a JPEG XL decoder", 0);
    const int events = JXL_DEC_BASIC_INFO | JXL_DEC_COLOR_ENCODING | JXL_DEC_BOX | (pixels ? JXL_DEC_FULL_IMAGE : 0);
    if (JxlDecoderSubscribeEvents(r.decoder, events) || JxlDecoderSetKeepOrientation(r.decoder, JXL_TRUE) ||
        JxlDecoderSetDecompressBoxes(r.decoder, JXL_TRUE) || JxlDecoderSetInput(r.decoder, file->bytes, file->size))
        err_set(err, ST_INTERNAL, "%s: libjxl takes no input.", file->path);
    JxlDecoderCloseInput(r.decoder);
    if (!err->status) decode(p, &r, pixels, err);
    JxlDecoderDestroy(r.decoder);
    free(r.pixels);
    free(r.exif);
    free(r.icc);
    return err->status;
}
