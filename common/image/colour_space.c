/* colour_space.c - see colour_space.h.
 *
 * Little CMS reads profiles [ICC 2010]. A profile of curves and a matrix is taken apart, because its matrix may give
 * components below 0, which are right, and because brackets are merged in the light of the camera's own colours. Both
 * its matrix and that of sRGB lead to colours under D50 (the profile connection space), so their quotient leads from
 * one to the other. Samples of a profile of tables become 16-bit samples of a space with wider primaries [ISO 2013], so
 * that they, too, have curves and a matrix.
 *
 * Curves of codes [ITU 2021] are exact at each level. The light of PQ is absolute: 203 cd/m^2 is white, as [ITU 2023]
 * recommends. The light of HLG is that of the scene, and white is where it recommends: at 75 % of the signal. */
#include "common/image/colour_space.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lcms2.h>

#include "common/base/parallel.h"
#include "common/image/image.h"

static const double SAME = 0.005;        /* of white; between a space and sRGB that are one */
static const double EXACT = 1e-4;        /* the same, of linear values */
static const double ADOBE = 563.0 / 256; /* the gamma of Adobe RGB (1998) */
static const double PQ_WHITE = 203;      /* cd/m^2 */
static const double HLG_WHITE = 0.75;    /* of the signal */

/* The space of samples that tables have converted. */
static const struct chromaticities wide = {{{0.7347, 0.2653}, {0.1596, 0.8404}, {0.0366, 0.0001}, {0.3457, 0.3585}}};
static const double WIDE_GAMMA = 2.2;

void colour_space_release(struct colour_space *s)
{
    if (!s) return;
    free(s->icc);
    free(s->light);
    free(s);
}

/* ---------------------------------------------------------------------------------------------- curves and matrices */

static bool colorants(double m[3][3], cmsHPROFILE profile)
{
    static const cmsTagSignature tags[] = {cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag};
    for (int c = 0; c < 3; c++) {
        const cmsCIEXYZ *xyz = cmsReadTag(profile, tags[c]);
        if (!xyz) return false;
        m[0][c] = xyz->X, m[1][c] = xyz->Y, m[2][c] = xyz->Z;
    }
    return true;
}

static bool inverse(double to[3][3], const double m[3][3])
{
    double det = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            to[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    for (int j = 0; j < 3; j++) det += m[0][j] * to[j][0];
    for (int i = 0; i < 9; i++) to[i / 3][i % 3] /= det;
    return fabs(det) > 1e-9;
}

/* The quotient of the profile's matrix and sRGB's. */
static bool matrix_of(double m[3][3], cmsHPROFILE profile)
{
    double from[3][3], srgb[3][3], to[3][3];
    cmsHPROFILE standard = cmsCreate_sRGBProfile();
    const bool known = standard && colorants(srgb, standard) && colorants(from, profile) && inverse(to, srgb);
    cmsCloseProfile(standard);
    for (int i = 0; known && i < 3; i++)
        for (int j = 0; j < 3; j++) {
            m[i][j] = 0;
            for (int k = 0; k < 3; k++) m[i][j] += to[i][k] * from[k][j];
        }
    return known;
}

static bool curves_of(struct colour_space *s, cmsHPROFILE profile, bool grey)
{
    static const cmsTagSignature tags[] = {cmsSigRedTRCTag, cmsSigGreenTRCTag, cmsSigBlueTRCTag};
    for (int c = 0; c < 3; c++) {
        const cmsToneCurve *curve = cmsReadTag(profile, grey ? cmsSigGrayTRCTag : tags[c]);
        if (!curve) return false;
        for (int i = 0; i < s->levels; i++)
            s->light[c * s->levels + i] = cmsEvalToneCurveFloat(curve, (float)i / (float)(s->levels - 1));
    }
    for (int i = 0; i < 3 * s->levels; i++)
        if (!(s->light[i] >= 0 && s->light[i] <= 4)) return false;
    return true;
}

static bool has_identity(const struct colour_space *s, double tolerance)
{
    for (int i = 0; i < 9; i++)
        if (!(fabs(s->matrix[i / 3][i % 3] - (i % 4 == 0)) < tolerance)) return false;
    return true;
}

static bool is_srgb(const struct colour_space *s)
{
    if (!s->light) return has_identity(s, EXACT);
    for (int i = 0; i < 3 * s->levels; i++) {
        const float srgb = linear_from_srgb((float)(i % s->levels) / (float)(s->levels - 1));
        if (!(fabs((double)(s->light[i] - srgb)) < SAME)) return false;
    }
    return has_identity(s, SAME);
}

static enum status keep_profile(struct colour_space *s, cmsHPROFILE profile, struct err *err)
{
    enum { DATE_AT = 24 };
    static const unsigned char date[12] = {0x07, 0xD0, 0, 1, 0, 1}; /* 2000-01-01 */
    cmsUInt32Number size = 0;
    if (!cmsSaveProfileToMem(profile, NULL, &size) || !(s->icc = malloc(size)) ||
        !cmsSaveProfileToMem(profile, s->icc, &size))
        return err_nomem(err, "a colour profile", size);
    memcpy(s->icc + DATE_AT, date, sizeof date); /* or a profile made here would have today's */
    s->icc_size = size;
    return ST_OK;
}

/* Without a curve: all is 0. The matrix is the identity. */
static struct colour_space *space_new(int bits, struct err *err)
{
    struct colour_space *s = calloc(1, sizeof *s);
    if (!s) {
        err_nomem(err, "a colour space", sizeof *s);
        return NULL;
    }
    s->levels = bits == 32 ? 1 : bits == 16 ? 65536 : 256;
    for (int i = 0; i < 3; i++) s->matrix[i][i] = 1;
    const size_t count = 3 * (size_t)s->levels;
    if (bits == 32 || (s->light = calloc(count, sizeof *s->light))) return s;
    err_nomem(err, "tone curves", count * sizeof *s->light);
    colour_space_release(s);
    return NULL;
}

/* Gives the space to the caller, unless it is sRGB or something failed. */
static enum status finish(struct colour_space **space, struct colour_space *s, const struct err *err)
{
    if (s && (err->status || is_srgb(s))) {
        colour_space_release(s);
        s = NULL;
    }
    *space = s;
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- profiles */

static void read_name(struct colour_space *s, cmsHPROFILE profile)
{
    char text[sizeof s->name] = "";
    size_t n = 0;
    cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text, sizeof text);
    for (const char *p = text; *p; p++)
        if (*p >= 32 && *p < 127) s->name[n++] = *p;
    while (n && s->name[n - 1] == ' ') n--;
    s->name[n] = 0;
    if (!n) strcpy(s->name, "a profile without a name");
}

static enum status not_convertible(const char *path, const char *why, struct err *err)
{
    return err_set(err, ST_DATA, "%s: its colour profile %s; save the photo as sRGB.", path, why);
}

static enum status open_profile(cmsHPROFILE *profile, const unsigned char *icc, size_t size, const char *path,
                                struct err *err)
{
    *profile = size <= UINT32_MAX ? cmsOpenProfileFromMem(icc, (cmsUInt32Number)size) : NULL;
    if (!*profile) return not_convertible(path, "is damaged", err);
    const cmsColorSpaceSignature kind = cmsGetColorSpace(*profile);
    if (kind == cmsSigRgbData || kind == cmsSigGrayData) return ST_OK;
    cmsCloseProfile(*profile);
    *profile = NULL;
    return not_convertible(path, "is not for RGB or grey", err);
}

static bool has_tables(cmsHPROFILE profile)
{
    return cmsGetColorSpace(profile) == cmsSigRgbData &&
           (!cmsIsMatrixShaper(profile) || cmsIsTag(profile, cmsSigAToB0Tag) || cmsIsTag(profile, cmsSigAToB1Tag));
}

enum status colour_space_from_icc(struct colour_space **space, bool *tables, const unsigned char *icc, size_t size,
                                  int bits, const char *path, struct err *err)
{
    cmsHPROFILE profile = NULL;
    struct colour_space *s = NULL;
    *space = NULL;
    *tables = false;
    if (open_profile(&profile, icc, size, path, err)) return err->status;
    *tables = has_tables(profile);
    if (*tables) /* of the samples that colour_space_widen() gives */
        colour_space_from_primaries(&s, &wide, WIDE_GAMMA, 16, "", err);
    else
        s = space_new(bits, err);
    if (s) {
        const bool grey = cmsGetColorSpace(profile) == cmsSigGrayData;
        read_name(s, profile);
        if (!*tables && !((!s->light || curves_of(s, profile, grey)) && (grey || matrix_of(s->matrix, profile))))
            not_convertible(path, "has no curves or no matrix", err);
        if (!*tables && !err->status) keep_profile(s, profile, err);
    }
    cmsCloseProfile(profile);
    return finish(space, s, err);
}

static bool set_name(cmsHPROFILE profile, const char *name)
{
    cmsMLU *text = cmsMLUalloc(NULL, 1);
    const bool set =
        text && cmsMLUsetASCII(text, "en", "US", name) && cmsWriteTag(profile, cmsSigProfileDescriptionTag, text);
    cmsMLUfree(text);
    return set;
}

/* The profile of primaries and a gamma; NULL: none. */
static cmsHPROFILE profile_of(const struct chromaticities *p, double gamma)
{
    const cmsCIExyY white = {p->xy[3][0], p->xy[3][1], 1};
    const cmsCIExyYTRIPLE primaries = {
        {p->xy[0][0], p->xy[0][1], 1}, {p->xy[1][0], p->xy[1][1], 1}, {p->xy[2][0], p->xy[2][1], 1}};
    static const cmsFloat64Number srgb[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
    for (int i = 0; i < 4; i++)
        if (!(fabs(p->xy[i][0]) < 2) || !(fabs(p->xy[i][1]) < 2) || (i == 3 && !(p->xy[i][1] > 0.01))) return NULL;
    cmsToneCurve *curve = gamma > 0 ? cmsBuildGamma(NULL, gamma) : cmsBuildParametricToneCurve(NULL, 4, srgb),
                 *curves[3] = {curve, curve, curve};
    cmsHPROFILE profile = curve ? cmsCreateRGBProfile(&white, &primaries, curves) : NULL;
    if (curve) cmsFreeToneCurve(curve);
    return profile;
}

static enum status wrong_primaries(const char *name, struct err *err)
{
    return err_set(err, ST_DATA, "the primaries %s are not those of a colour space; save the photo as sRGB.", name);
}

enum status colour_space_from_primaries(struct colour_space **space, const struct chromaticities *p, double gamma,
                                        int bits, const char *name, struct err *err)
{
    struct colour_space *s = space_new(bits, err);
    cmsHPROFILE profile = s ? profile_of(p, gamma) : NULL;
    if (s) {
        snprintf(s->name, sizeof s->name, "%s", name);
        if (!profile || !set_name(profile, name) || (s->light && !curves_of(s, profile, false)) ||
            !matrix_of(s->matrix, profile))
            wrong_primaries(name, err);
        else
            keep_profile(s, profile, err);
    }
    if (profile) cmsCloseProfile(profile);
    return finish(space, s, err);
}

enum status colour_space_adobe(struct colour_space **space, int bits, struct err *err)
{
    static const struct chromaticities adobe = {{{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, {0.3127, 0.3290}}};
    return colour_space_from_primaries(space, &adobe, ADOBE, bits, "Adobe RGB (1998)", err);
}

/* ------------------------------------------------------------------------------------------------------------ codes */

static double light_of_709(double v) { return v < 0.081 ? v / 4.5 : pow((v + 0.099) / 1.099, 1 / 0.45); }
static double light_of_240m(double v) { return v < 0.0913 ? v / 4 : pow((v + 0.1115) / 1.1115, 1 / 0.45); }
static double light_of_gamma22(double v) { return pow(v, 2.2); }
static double light_of_gamma28(double v) { return pow(v, 2.8); }
static double light_of_srgb(double v) { return (double)linear_from_srgb((float)v); }
static double light_of_linear(double v) { return v; }

static double light_of_pq(double v)
{
    const double m1 = 2610.0 / 16384, m2 = 2523.0 / 32, c1 = 3424.0 / 4096, c2 = 2413.0 / 128, c3 = 2392.0 / 128;
    const double root = pow(v, 1 / m2);
    return 10000 / PQ_WHITE * pow(fmax(root - c1, 0) / (c2 - c3 * root), 1 / m1);
}

static double hlg(double v)
{
    const double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * log(4 * a);
    return v <= 0.5 ? v * v / 3 : (exp((v - c) / a) + b) / 12;
}

static double light_of_hlg(double v) { return hlg(v) / hlg(HLG_WHITE); }

struct transfer {
    int code;
    double (*light)(double);
    const char *name;
};

/* 2 is "unspecified". */
static const struct transfer transfers[] = {
    {2, light_of_srgb, "sRGB curve"},
    {13, light_of_srgb, "sRGB curve"},
    {1, light_of_709, "BT.709 curve"},
    {6, light_of_709, "BT.709 curve"},
    {14, light_of_709, "BT.709 curve"},
    {15, light_of_709, "BT.709 curve"},
    {4, light_of_gamma22, "gamma 2.2"},
    {5, light_of_gamma28, "gamma 2.8"},
    {7, light_of_240m, "SMPTE 240M curve"},
    {8, light_of_linear, "linear"},
    {16, light_of_pq, "PQ"},
    {18, light_of_hlg, "HLG"},
};

struct primaries {
    int code;
    struct chromaticities xy;
    const char *name;
};

static const struct primaries primaries_of_codes[] = {
    {2, {{{0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}, {0.3127, 0.3290}}}, "BT.709"},
    {1, {{{0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}, {0.3127, 0.3290}}}, "BT.709"},
    {4, {{{0.670, 0.330}, {0.210, 0.710}, {0.140, 0.080}, {0.3100, 0.3160}}}, "BT.470 M"},
    {5, {{{0.640, 0.330}, {0.290, 0.600}, {0.150, 0.060}, {0.3127, 0.3290}}}, "BT.601 625"},
    {6, {{{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, {0.3127, 0.3290}}}, "BT.601 525"},
    {7, {{{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, {0.3127, 0.3290}}}, "SMPTE 240M"},
    {8, {{{0.681, 0.319}, {0.243, 0.692}, {0.145, 0.049}, {0.3100, 0.3160}}}, "generic film"},
    {9, {{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}}}, "BT.2020"},
    {11, {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3140, 0.3510}}}, "DCI P3"},
    {12, {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}}}, "Display P3"},
    {22, {{{0.630, 0.340}, {0.295, 0.605}, {0.155, 0.077}, {0.3127, 0.3290}}}, "EBU 3213"},
};

enum status colour_space_from_codes(struct colour_space **space, int primaries, int transfer, int bits,
                                    const char *path, struct err *err)
{
    const struct primaries *p = NULL;
    const struct transfer *t = NULL;
    *space = NULL;
    for (size_t i = 0; i < sizeof primaries_of_codes / sizeof *primaries_of_codes; i++)
        if (primaries_of_codes[i].code == primaries) p = &primaries_of_codes[i];
    for (size_t i = 0; i < sizeof transfers / sizeof *transfers; i++)
        if (transfers[i].code == transfer) t = &transfers[i];
    if (!p || !t)
        return err_set(err, ST_DATA,
                       "%s: its colour codes (primaries %d, transfer %d of ITU-T H.273) are none that is read here; "
                       "save the photo as sRGB.",
                       path, primaries, transfer);
    cmsHPROFILE profile = profile_of(&p->xy, 1);
    struct colour_space *s = space_new(bits, err);
    if (s) {
        s->primaries = primaries;
        s->transfer = transfer;
        snprintf(s->name, sizeof s->name, "%s, %s", p->name, t->name);
        if (!profile || !matrix_of(s->matrix, profile)) wrong_primaries(p->name, err);
        for (int i = 0; s->light && i < s->levels; i++) {
            const double light = t->light((double)i / (s->levels - 1));
            for (int c = 0; c < 3; c++) s->light[c * s->levels + i] = (float)light;
        }
    }
    if (profile) cmsCloseProfile(profile);
    return finish(space, s, err);
}

/* ------------------------------------------------------------------------------------------------------- conversion */

struct widen_job {
    cmsHTRANSFORM transform;
    uint16_t *samples;
    int bits;
};

static void widen_some(void *ctx, size_t begin, size_t end, int thread)
{
    enum { FEW = 256 };
    const struct widen_job *j = ctx;
    const float white = j->bits == 16 ? 65535.0f : 255.0f;
    float rgb[3 * FEW];
    (void)thread;
    for (size_t at = begin; at < end; at += FEW) {
        const size_t n = end - at < FEW ? end - at : FEW;
        uint16_t *samples = j->samples + 3 * at;
        for (size_t i = 0; i < 3 * n; i++) rgb[i] = (float)samples[i] / white;
        cmsDoTransform(j->transform, rgb, rgb, (cmsUInt32Number)n);
        for (size_t i = 0; i < 3 * n; i++) {
            const float v = rgb[i] > 0 ? rgb[i] < 1 ? rgb[i] : 1 : 0;
            samples[i] = (uint16_t)lrintf(v * 65535.0f);
        }
    }
}

enum status colour_space_widen(uint16_t *samples, size_t pixels, int bits, const unsigned char *icc, size_t size,
                               const char *path, struct err *err)
{
    cmsHPROFILE profile = NULL, to = NULL;
    struct widen_job job = {NULL, samples, bits};
    if (open_profile(&profile, icc, size, path, err)) return err->status;
    to = profile_of(&wide, WIDE_GAMMA);
    job.transform =
        to ? cmsCreateTransform(profile, TYPE_RGB_FLT, to, TYPE_RGB_FLT, INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE)
           : NULL;
    if (job.transform)
        parallel_for(pixels, 1 << 14, widen_some, &job);
    else
        not_convertible(path, "cannot be applied", err);
    if (job.transform) cmsDeleteTransform(job.transform);
    if (to) cmsCloseProfile(to);
    cmsCloseProfile(profile);
    return err->status;
}

bool colour_space_same(const struct colour_space *a, const struct colour_space *b)
{
    if (!a || !b) return a == b;
    return a->levels == b->levels && !memcmp(a->matrix, b->matrix, sizeof a->matrix) &&
           (!a->light || !memcmp(a->light, b->light, 3 * (size_t)a->levels * sizeof *a->light));
}

float colour_space_white(const struct colour_space *s)
{
    float white = 1;
    for (int c = 0; s && s->light && c < 3; c++) {
        const float last = s->light[(c + 1) * s->levels - 1];
        white = c && white < last ? white : last;
    }
    return white;
}

struct matrix_job {
    const struct colour_space *space;
    float *rgb;
};

static void apply_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct matrix_job *j = ctx;
    float m[3][3];
    (void)thread;
    for (int i = 0; i < 9; i++) m[i / 3][i % 3] = (float)j->space->matrix[i / 3][i % 3];
    for (float *p = j->rgb + 3 * begin; p < j->rgb + 3 * end; p += 3) {
        const float r = p[0], g = p[1], b = p[2];
        for (int c = 0; c < 3; c++) p[c] = m[c][0] * r + m[c][1] * g + m[c][2] * b;
    }
}

void colour_space_to_rec709(const struct colour_space *space, float *rgb, size_t pixels)
{
    struct matrix_job job = {space, rgb};
    parallel_for(pixels, 1 << 16, apply_some, &job);
}
