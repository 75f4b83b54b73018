/* gain_map.c - HDR photos with a gain map: the light that was written comes back; maps of any size; damaged files. */
#include "tests/unit/scratch.h"

#include <math.h>

#include <lcms2.h>
#include <turbojpeg.h>

#include "common/image/gain_map.h"
#include "common/image/photo.h"

enum { W = 64, H = 48, BLOCK = 8, MAX_FILE = 1 << 17 };

#define RDF_OPEN                                                                  \
    "<x:xmpmeta xmlns:x='adobe:ns:meta/'>\n<rdf:RDF xmlns:rdf='http://www.w3.org" \
    "/1999/02/22-rdf-syntax-ns#'><rdf:Description xmlns:hdrgm='http://ns.adobe.com/hdr-gain-map/1.0/' "
#define RDF_CLOSE "</rdf:RDF></x:xmpmeta>\n<?xpacket end='w'?>"

/* A file to be written: a JPEG and its map. */
struct made {
    unsigned char base[3 * W * H], map[3 * W * H]; /* R G B; a grey map has one byte per sample */
    int map_width, map_height;
    bool grey, mpf, container, iso;
    const char *map_data;         /* XMP data of the map, or */
    unsigned char fractions[200]; /* those of ISO */
    size_t fractions_size;
    unsigned char icc[4000];
    cmsUInt32Number icc_size;
    size_t moved; /* bytes by which both lists are wrong */
    unsigned char file[MAX_FILE];
    size_t size, map_at;
};

static struct made m;
static const char *path;

static void put32(unsigned char *to, size_t v)
{
    for (int i = 0; i < 4; i++) to[i] = (unsigned char)(v >> (24 - 8 * i));
}

static void add_segment(unsigned char marker, const char *name, const void *body, size_t size)
{
    const size_t named = strlen(name) + 1, length = 2 + named + size;
    const unsigned char head[4] = {0xff, marker, (unsigned char)(length >> 8), (unsigned char)length};
    memcpy(m.file + m.size, head, 4);
    memcpy(m.file + m.size + 4, name, named);
    memcpy(m.file + m.size + 4 + named, body, size);
    m.size += 2 + length;
}

static void add_jpeg_rest(const unsigned char *jpeg, size_t size)
{
    memcpy(m.file + m.size, jpeg + 2, size - 2);
    m.size += size - 2;
}

static unsigned char *encode(size_t *size, const unsigned char *pixels, int width, int height, bool grey)
{
    unsigned char *bytes = NULL;
    unsigned long length = 0;
    tjhandle handle = tjInitCompress();
    assert_int_equal(tjCompress2(handle, pixels, width, 0, height, grey ? TJPF_GRAY : TJPF_RGB, &bytes, &length,
                                 grey ? TJSAMP_GRAY : TJSAMP_444, 100, TJFLAG_ACCURATEDCT),
                     0);
    tjDestroy(handle);
    *size = length;
    return bytes;
}

/* The second picture's entry has its size and its offset from the index. */
static size_t add_index(size_t map_size)
{
    unsigned char index[82] = {'M', 'M', 0, 42, 0, 0, 0, 8, 0, 3};
    static const unsigned char version[12] = {0xb0, 0, 0, 7, 0, 0, 0, 4, '0', '1', '0', '0'},
                               number[12] = {0xb0, 1, 0, 4, 0, 0, 0, 1, 0, 0, 0, 2},
                               list[12] = {0xb0, 2, 0, 7, 0, 0, 0, 32, 0, 0, 0, 50};
    memcpy(index + 10, version, 12);
    memcpy(index + 22, number, 12);
    memcpy(index + 34, list, 12);
    put32(index + 50 + 16 + 4, map_size);
    add_segment(0xe2, "MPF", index, sizeof index);
    return m.size - sizeof index;
}

/* Makes the file and writes it as `path`. */
static void write_file(void)
{
    size_t base_size, map_size, index = 0;
    unsigned char *base = encode(&base_size, m.base, W, H, false),
                  *map = encode(&map_size, m.map, m.map_width, m.map_height, m.grey);
    static unsigned char second[MAX_FILE];
    m.size = 2;
    memcpy(m.file, map, 2);
    if (m.map_data) add_segment(0xe1, "http://ns.adobe.com/xap/1.0/", m.map_data, strlen(m.map_data));
    if (m.iso) add_segment(0xe2, "urn:iso:std:iso:ts:21496:-1", m.fractions, m.fractions_size);
    add_jpeg_rest(map, map_size);
    const size_t second_size = m.size;
    memcpy(second, m.file, second_size);
    m.size = 2;
    if (m.container) {
        char xmp[2000];
        snprintf(xmp, sizeof xmp,
                 RDF_OPEN "xmlns:C='http://ns.google.com/photos/1.0/container/' "
                          "xmlns:I='http://ns.google.com/photos/1.0/container/item/' hdrgm:Version='1.0'>"
                          "<C:Directory><rdf:Seq><rdf:li rdf:parseType='Resource'>"
                          "<C:Item I:Semantic='Primary' I:Mime='image/jpeg'/></rdf:li>"
                          "<rdf:li rdf:parseType='Resource'><C:Item I:Semantic='Other' I:Length='%d'/></rdf:li>"
                          "<rdf:li rdf:parseType='Resource'>"
                          "<C:Item I:Semantic='GainMap' I:Mime='image/jpeg' I:Length='%zu'/></rdf:li>"
                          "</rdf:Seq></C:Directory></rdf:Description>" RDF_CLOSE,
                 (int)m.moved, second_size);
        add_segment(0xe1, "http://ns.adobe.com/xap/1.0/", xmp, strlen(xmp));
    } else {
        add_segment(0xe2, "urn:iso:std:iso:ts:21496:-1", "\0\0\0\0", 4);
    }
    if (m.icc_size) {
        unsigned char part[4002] = {1, 1};
        memcpy(part + 2, m.icc, m.icc_size);
        add_segment(0xe2, "ICC_PROFILE", part, 2 + m.icc_size);
    }
    if (m.mpf) index = add_index(second_size);
    add_jpeg_rest(base, base_size);
    m.map_at = m.size;
    if (index) put32(m.file + index + 50 + 16 + 8, m.size + m.moved - index);
    memcpy(m.file + m.size, second, second_size);
    m.size += second_size;
    tjFree(base);
    tjFree(map);
    path = scratch_write_bytes("photo.jpg", m.file, m.size);
}

static struct photo read_hdr(void)
{
    struct photo p;
    struct photo_info info;
    struct err err = ERR_INIT;
    assert_ok(photo_read_hdr(&p, path, &err), err);
    assert_ok(photo_read_hdr_info(&info, path, &err), err);
    assert_memory_equal(&info, &p.info, sizeof info);
    return p;
}

/* The base picture in linear light, as a reader without gain maps has it. */
static struct image read_base(void)
{
    struct photo p;
    struct image linear;
    struct err err = ERR_INIT;
    assert_ok(photo_read_any(&p, path, &err), err);
    assert_int_equal(p.info.bits, 8);
    assert_ok(photo_to_linear(&linear, &p, &err), err);
    photo_release(&p);
    return linear;
}

static int block(int x, int y) { return y / BLOCK * (W / BLOCK) + x / BLOCK; }

/* The light of the picture: five decades over the blocks, other hues in each. */
static double true_light(int x, int y, int c)
{
    const int b = block(x, y);
    return 0.003 * pow(10, 3.6 * ((b * 7 + c * 13) % 48) / 47);
}

static void fill_base(void)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++) {
                const double light = true_light(x, y, c);
                m.base[3 * (y * W + x) + c] =
                    (unsigned char)lround(255.0 * srgb_from_linear((float)(light / (1 + light))));
            }
}

static const double low[3] = {-1, -0.5, 0}, high[3] = {4, 4.5, 5}, gamma_of[3] = {1, 2.2, 0.8};
static const char colours[] =
    RDF_OPEN "hdrgm:Version='1.0' hdrgm:OffsetSDR='0.015625' hdrgm:OffsetHDR='0.03125' hdrgm:HDRCapacityMax='5'>"
             "<hdrgm:GainMapMin><rdf:Seq><rdf:li>-1</rdf:li><rdf:li>-0.5</rdf:li><rdf:li>0</rdf:li></rdf:Seq>"
             "</hdrgm:GainMapMin><hdrgm:GainMapMax><rdf:Seq><rdf:li>4</rdf:li><rdf:li>4.5</rdf:li><rdf:li>5</rdf:li>"
             "</rdf:Seq></hdrgm:GainMapMax><hdrgm:Gamma><rdf:Seq><rdf:li>1</rdf:li><rdf:li>2.2</rdf:li>"
             "<rdf:li>0.8</rdf:li></rdf:Seq></hdrgm:Gamma></rdf:Description>" RDF_CLOSE;

/* The map that leads from the base, as it is read, to the light. */
static void fill_colour_map(void)
{
    m.grey = false;
    m.map_width = W;
    m.map_height = H;
    write_file();
    struct image base = read_base();
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++) {
                const double s = (double)image_at(&base, x, y)[c];
                const double gain = log2((true_light(x, y, c) + 0.03125) / (s + 0.015625));
                const double g = pow(fmin(fmax((gain - low[c]) / (high[c] - low[c]), 0), 1), gamma_of[c]);
                m.map[3 * (y * W + x) + c] = (unsigned char)lround(255 * g);
            }
    image_release(&base);
    write_file();
}

/* The largest error in levels of the map, each of which is a factor: half a level is that of rounding, and the map's
 * JPEG adds at most 1 1/2 of them. */
static double worst_levels(const struct photo *p)
{
    double worst = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++) {
                const double truth = true_light(x, y, c), found = (double)p->values[3 * (y * W + x) + c];
                const double g = m.map[3 * (y * W + x) + c] / 255.0;
                /* the slope of the gain in stops over levels, at the level that is farther */
                const double at = fmax(g - 2 / 255.0, 1 / 255.0), to = fmin(g + 2 / 255.0, 1);
                const double slope =
                    (high[c] - low[c]) * (pow(to, 1 / gamma_of[c]) - pow(at, 1 / gamma_of[c])) / (255 * (to - at));
                worst = fmax(worst, fabs(log2((found + 0.03125) / (truth + 0.03125))) / slope);
            }
    return worst;
}

static void fresh(void)
{
    m = (struct made){.mpf = true, .container = true, .map_data = colours};
    fill_base();
}

static void light_comes_back_within_eight_bits(void **state)
{
    (void)state;
    fresh();
    fill_colour_map();
    struct photo p = read_hdr();
    assert_true(p.info.bits == 32 && p.info.width == W && p.info.height == H && !p.samples && !p.space);
    assert_true(worst_levels(&p) < 2);
    double brightest = 0;
    for (int i = 0; i < 3 * W * H; i++) brightest = fmax(brightest, (double)p.values[i]);
    assert_true(brightest > 11.5 && brightest < 12.5); /* 12 times white */
    photo_release(&p);

    struct image base = read_base(); /* without gain maps the photo is what it was */
    for (int i = 0; i < 3 * W * H; i++) assert_true(base.data[i] <= 1);
    image_release(&base);
}

static void either_list_of_pictures_is_enough(void **state)
{
    (void)state;
    fresh();
    fill_colour_map();
    for (int i = 1; i <= 3; i++) {
        m.mpf = i & 1;
        m.container = i & 2;
        write_file();
        struct photo p = read_hdr();
        assert_true(p.info.bits == 32 && worst_levels(&p) < 2);
        photo_release(&p);
    }
}

/* A grey map without offsets multiplies all colours by one factor. */
static void a_grey_map_multiplies(void **state)
{
    static const char grey[] = RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMapMin='-1' hdrgm:GainMapMax='3' "
                                        "hdrgm:OffsetSDR='0' hdrgm:OffsetHDR='0' hdrgm:HDRCapacityMax='3'/>" RDF_CLOSE;
    (void)state;
    fresh();
    m.map_data = grey;
    m.grey = true;
    m.map_width = W;
    m.map_height = H;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) m.map[y * W + x] = (unsigned char)(5 * block(x, y));
    write_file();
    struct photo p = read_hdr();
    struct image base = read_base();
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++) {
                const double gain = exp2(-1 + 4 * 5 * block(x, y) / 255.0);
                const double wanted = gain * (double)image_at(&base, x, y)[c];
                assert_true(fabs((double)p.values[3 * (y * W + x) + c] - wanted) < 1e-5 * wanted + 1e-9);
            }
    image_release(&base);
    photo_release(&p);
}

/* A ramp stays one when it is enlarged: to half a sample from the border it goes on evenly. */
static void maps_of_other_sizes_cover_the_photo(void **state)
{
    static const int sizes[][2] = {{16, 12}, {24, 6}, {1, 1}, {5, 48}};
    static const char grey[] = RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMapMax='4' hdrgm:OffsetSDR='0' "
                                        "hdrgm:OffsetHDR='0' hdrgm:HDRCapacityMax='4'/>" RDF_CLOSE;
    (void)state;
    for (int k = 0; k < 4; k++) {
        fresh();
        m.map_data = grey;
        m.grey = true;
        m.map_width = sizes[k][0];
        m.map_height = sizes[k][1];
        for (int y = 0; y < m.map_height; y++)
            for (int x = 0; x < m.map_width; x++)
                m.map[y * m.map_width + x] = (unsigned char)lround(200 * (x + 0.5) / m.map_width);
        write_file();
        struct photo p = read_hdr();
        struct image base = read_base();
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const double half = 0.5 / m.map_width, at = (x + 0.5) / W, inside = fmin(fmax(at, half), 1 - half);
                const double found = log2((double)(p.values[3 * (y * W + x)] / image_at(&base, x, y)[0]));
                assert_true(fabs(found - 4 * 200 * inside / 255) < 2 * 4 / 255.0); /* two levels */
            }
        image_release(&base);
        photo_release(&p);
    }
}

static void put_fraction(double value, uint32_t below)
{
    put32(m.fractions + m.fractions_size, (uint32_t)(int32_t)lround(value * below));
    put32(m.fractions + m.fractions_size + 4, below);
    m.fractions_size += 8;
}

static void put_fractions(void)
{
    m.fractions_size = 5;
    m.fractions[4] = 0x80 | 0x40; /* three colours, in the photo's primaries */
    put_fraction(0, 1);
    put_fraction(5, 1);
    for (int c = 0; c < 3; c++) {
        put_fraction(low[c], 10);
        put_fraction(high[c], 10);
        put_fraction(gamma_of[c], 10);
        put_fraction(0.015625, 64);
        put_fraction(0.03125, 32);
    }
}

static void iso_fractions_say_the_same(void **state)
{
    (void)state;
    fresh();
    fill_colour_map();
    m.map_data = NULL;
    m.iso = true;
    put_fractions();
    for (int container = 0; container < 2; container++) {
        m.container = container;
        write_file();
        struct photo p = read_hdr();
        assert_true(p.info.bits == 32 && worst_levels(&p) < 2);
        photo_release(&p);
    }
    for (size_t size = 0; size < m.fractions_size; size++) { /* data that end too soon */
        struct gain_map_data data;
        struct err err = ERR_INIT;
        assert_int_equal(gain_map_from_iso(&data, m.fractions, size, "cut.jpg", &err), ST_DATA);
        assert_non_null(strstr(err.text, "cut.jpg: the ISO 21496-1 data of its gain map end too soon"));
    }
    struct gain_map_data data;
    struct err err = ERR_INIT;
    put32(m.fractions + 5 + 4, 0); /* the headroom is not used; this is the least gain's denominator: */
    put32(m.fractions + 5 + 16 + 4, 0);
    assert_int_equal(gain_map_from_iso(&data, m.fractions, m.fractions_size, "zero.jpg", &err), ST_DATA);
    assert_non_null(strstr(err.text, "zero.jpg: GainMapMin of its gain map is nan"));
}

/* A map for red alone leaves the other colours of the photo's own primaries as they are. */
static void gains_are_those_of_the_photos_primaries(void **state)
{
    static const char red[] = RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMapMax='2' hdrgm:OffsetSDR='0' "
                                       "hdrgm:OffsetHDR='0' hdrgm:HDRCapacityMax='2'/>" RDF_CLOSE;
    (void)state;
    fresh();
    cmsCIExyY white;
    const cmsCIExyYTRIPLE p3 = {{0.68, 0.32, 1}, {0.265, 0.69, 1}, {0.15, 0.06, 1}};
    const double srgb[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
    cmsToneCurve *curve = cmsBuildParametricToneCurve(NULL, 4, srgb), *curves[3] = {curve, curve, curve};
    cmsWhitePointFromTemp(&white, 6504);
    cmsHPROFILE profile = cmsCreateRGBProfile(&white, &p3, curves);
    m.icc_size = sizeof m.icc;
    assert_true(cmsSaveProfileToMem(profile, m.icc, &m.icc_size));
    cmsCloseProfile(profile);
    cmsFreeToneCurve(curve);

    m.map_data = red;
    m.map_width = W;
    m.map_height = H;
    for (int i = 0; i < W * H; i++) {
        memcpy(m.base + 3 * i, (unsigned char[]){255, 0, 0}, 3);
        memcpy(m.map + 3 * i, (unsigned char[]){255, 0, 0}, 3);
    }
    write_file();
    struct photo p = read_hdr();
    struct image base = read_base();
    assert_true(base.data[0] > 1.2f && base.data[1] < -0.03f); /* the red of P3 lies outside of Rec.709 */
    const double level = exp2(2 / 255.0) - 1;                  /* the map's JPEG is off by one at most */
    for (int c = 0; c < 3; c++)
        assert_true(fabs((double)p.values[c] - 4 * (double)base.data[c]) <= 4 * level * fabs((double)base.data[c]));
    assert_true(*p.info.colour && !p.space);
    image_release(&base);
    photo_release(&p);
}

/* What must be said of the file that was written. */
static void assert_refused(const char *words)
{
    struct photo p;
    struct photo_info info;
    struct err err = ERR_INIT, same = ERR_INIT, none = ERR_INIT;
    const enum status st = photo_read_hdr(&p, path, &err);
    if (st != ST_DATA || !strstr(err.text, path) || !strstr(err.text, words) || !strstr(err.text, "gain_map = no"))
        fail_msg("wanted \"%s\", not: %s", words, err.text);
    assert_true(!p.samples && !p.values);
    assert_int_equal(photo_read_hdr_info(&info, path, &same), ST_DATA);
    assert_ok(photo_read_any(&p, path, &none), none); /* which the ordinary picture does not mind */
    photo_release(&p);
}

static void damaged_data_are_refused(void **state)
{
    static const char *const cases[][2] = {
        {RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMapMax='4'>" RDF_CLOSE,
         "XMP data, which describe its gain map, are damaged"},
        {RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMap", "are damaged"},
        {RDF_OPEN "hdrgm:Version='1.0'/>" RDF_CLOSE, "GainMapMax of its gain map is missing"},
        {RDF_OPEN "hdrgm:GainMapMax='4'/>" RDF_CLOSE, "Version of its gain map is missing"},
        {RDF_OPEN "hdrgm:Version='2.0' hdrgm:GainMapMax='4'/>" RDF_CLOSE, "Version of its gain map is 2.0, wanted 1.0"},
        {RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMapMax='x'/>" RDF_CLOSE,
         "GainMapMax of its gain map is x, wanted a number"},
        {RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMapMax='400'/>" RDF_CLOSE,
         "GainMapMax of its gain map is 400, wanted 0 to 32"},
        {RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMapMin='3' hdrgm:GainMapMax='2'/>" RDF_CLOSE, "is 2, wanted 3 to 32"},
        {RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMapMax='2' hdrgm:Gamma='0'/>" RDF_CLOSE, "Gamma of its gain map is 0"},
    };
    (void)state;
    fresh();
    fill_colour_map();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        m.map_data = cases[i][0];
        write_file();
        assert_refused(cases[i][1]);
    }
    char deep[4000] = RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMapMax='4'>";
    for (int i = 0; i < 40; i++) strcat(deep, "<rdf:a>");
    for (int i = 0; i < 40; i++) strcat(deep, "</rdf:a>");
    m.map_data = strcat(deep, "</rdf:Description>" RDF_CLOSE);
    write_file();
    assert_refused("more than 32 nested elements");
}

static void a_map_that_is_not_there_is_refused(void **state)
{
    (void)state;
    fresh();
    fill_colour_map();
    const size_t whole = m.size;
    path = scratch_write_bytes("cut.jpg", m.file, m.map_at); /* a program dropped what follows the photo */
    assert_refused("none of the 0 places");
    path = scratch_write_bytes("cut.jpg", m.file, m.map_at + (whole - m.map_at) * 2 / 3);
    struct photo p;
    struct err err = ERR_INIT;
    assert_int_equal(photo_read_hdr(&p, path, &err), ST_DATA); /* its pixels end too soon */
    assert_non_null(strstr(err.text, "its gain map is damaged or cut off"));
    m.moved = 100; /* both lists lead astray, then out of the file */
    write_file();
    assert_refused("none of the 2 places");
    m.moved = 1 << 20;
    write_file();
    assert_refused("none of the 0 places");
}

static void photos_without_gains_stay_as_they_are(void **state)
{
    static const char hdr[] =
        RDF_OPEN "hdrgm:Version='1.0' hdrgm:GainMapMax='4' hdrgm:BaseRenditionIsHDR='True'/>" RDF_CLOSE;
    (void)state;
    fresh();
    fill_colour_map();
    m.map_data = hdr; /* the photo is the HDR picture */
    write_file();
    struct photo p = read_hdr();
    assert_true(p.info.bits == 8 && p.samples && !p.values);
    photo_release(&p);
    path = "tests/fuzz/corpus/photo/exif.jpg";
    p = read_hdr();
    assert_true(p.info.bits == 8 && p.samples && !p.values);
    photo_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_comes_back_within_eight_bits),
        cmocka_unit_test(either_list_of_pictures_is_enough),
        cmocka_unit_test(a_grey_map_multiplies),
        cmocka_unit_test(maps_of_other_sizes_cover_the_photo),
        cmocka_unit_test(iso_fractions_say_the_same),
        cmocka_unit_test(gains_are_those_of_the_photos_primaries),
        cmocka_unit_test(damaged_data_are_refused),
        cmocka_unit_test(a_map_that_is_not_there_is_refused),
        cmocka_unit_test(photos_without_gains_stay_as_they_are),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
