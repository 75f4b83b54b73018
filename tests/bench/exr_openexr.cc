// exr_openexr.cc - see exr_openexr.h.
#include "tests/bench/exr_openexr.h"

#include <exception>
#include <string>
#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>
#include <half.h>

static Imf::Compression compression(enum exr_codec codec)
{
    switch (codec) {
    case EXR_NONE:
        return Imf::NO_COMPRESSION;
    case EXR_RLE:
        return Imf::RLE_COMPRESSION;
    case EXR_ZIPS:
        return Imf::ZIPS_COMPRESSION;
    case EXR_ZIP:
        break;
    }
    return Imf::ZIP_COMPRESSION;
}

extern "C" void openexr_set_threads(int threads) { Imf::setGlobalThreadCount(threads > 1 ? threads : 0); }

extern "C" enum status openexr_write(const struct exr_image *im, const char *path, struct err *err)
try {
    static const Imf::PixelType types[] = {Imf::UINT, Imf::HALF, Imf::FLOAT};
    const size_t width = im->width, samples = width * im->height;
    Imf::Header header(im->width, im->height);
    header.compression() = compression(im->codec);
    Imf::FrameBuffer buffer;
    std::vector<std::vector<half>> halves(im->count);
    for (int i = 0; i < im->count; i++) {
        const struct exr_plane *p = &im->planes[i];
        size_t size = p->type == EXR_HALF ? 2 : 4;
        char *base = reinterpret_cast<char *>(p->type == EXR_UINT ? (void *)p->u : (void *)p->f);
        if (p->type == EXR_HALF) { // the library converts when it reads, not when it writes
            halves[i].resize(samples);
            for (size_t s = 0; s < samples; s++) halves[i][s] = half(p->f[s]);
            base = reinterpret_cast<char *>(halves[i].data());
        }
        header.channels().insert(p->name, Imf::Channel(types[p->type]));
        buffer.insert(p->name, Imf::Slice(types[p->type], base, size, size * width));
    }
    Imf::OutputFile file(path, header);
    file.setFrameBuffer(buffer);
    file.writePixels(im->height);
    return ST_OK;
} catch (const std::exception &e) {
    return err_set(err, ST_IO, "OpenEXR cannot write %s: %s.", path, e.what());
}

extern "C" enum status openexr_read(struct exr_image *im, const char *path, struct err *err)
try {
    Imf::InputFile file(path);
    const auto window = file.header().dataWindow();
    if (exr_image_init(im, window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, err)) return err->status;
    const size_t width = im->width;
    Imf::FrameBuffer buffer;
    for (auto c = file.header().channels().begin(); c != file.header().channels().end(); ++c) {
        const Imf::PixelType type = c.channel().type;
        struct exr_plane *p = NULL;
        if (exr_add_plane(im, c.name(),
                          type == Imf::UINT   ? EXR_UINT
                          : type == Imf::HALF ? EXR_HALF
                                              : EXR_FLOAT,
                          &p, err))
            return err->status;
        char *base = p->u ? reinterpret_cast<char *>(p->u) : reinterpret_cast<char *>(p->f);
        base -= 4 * (window.min.x + (ptrdiff_t)width * window.min.y);
        buffer.insert(c.name(), Imf::Slice(p->u ? Imf::UINT : Imf::FLOAT, base, 4, 4 * width));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return ST_OK;
} catch (const std::exception &e) {
    return err_set(err, ST_IO, "OpenEXR cannot read %s: %s.", path, e.what());
}
