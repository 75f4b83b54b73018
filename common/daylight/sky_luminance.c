/* sky_luminance.c - sky, ground and sun in absolute units.
 *
 * Overview. A sky is a shape, which says how luminance varies with direction, and a level, which follows from the
 * horizontal illuminance of the sky. That is given, or usual for a height of the sun, or it follows from irradiances
 * of a weather file. The sun is a disk beside it.
 *
 * Mathematics. [Perez 1990]: with the diffuse horizontal irradiance D, the direct normal irradiance B, the sun's angle
 * Z from the zenith (radians), the relative air mass m [Kasten 1965] and the extraterrestrial irradiance B0, weather
 * has a clearness ((D + B) / D + 1.041 Z^3) / (1 + 1.041 Z^3) and a brightness D m / B0. Clearness selects one of eight
 * classes, each with coefficients: of the efficacy of the sky's light, a + b W + c cos Z + d ln(brightness), and of the
 * sun's, a + b W + c exp(5.73 Z - 5) + d brightness, where W = exp(0.07 T - 0.075) is the water vapour in cm at the dew
 * point T. [Perez 1993]: the five numbers of the shape are x1 + x2 Z + brightness (x3 + x4 Z), in the class of the
 * cloudiest skies with two exceptions.
 *
 * [IESNA 2000]: with the sun at altitude h the sky gives A + B sin^C h klx on a horizontal surface, and the sun 127.5
 * exp(-c / sin h) klx, over the square of its distance, on one that faces it.
 *
 * What differs from the sources: brightness is 0.01 to 0.6, as in Radiance's gendaylit, since beyond the measured
 * skies the formulas give a needle around the sun, or negative light; dew points count up to 35 degrees; clearness
 * has no upper end; B0 follows from the sun's distance; a sun below the horizon counts as on it for the sky's shape. */
#include "common/daylight/sky_luminance.h"

#include "common/math/numbers.h"

enum { CLASSES = 8, SAMPLES = 4, SKY_PARTLY = 7 }; /* SAMPLES of a patch of Tregenza, in each direction */

static const double SOLAR_IRRADIANCE = 1367, SOLAR_ILLUMINANCE = 127.5e3; /* W/m2, lx, outside of the air */
static const double DARKEST = 0.01, BRIGHTEST = 0.6;                      /* what brightness counts */
static const double WETTEST = 35;                                         /* degrees Celsius, of dew points */
static const double clearness_from[CLASSES] = {1, 1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};

/* [Perez 1993, table 1]: x1 to x4 of a, b, c, d, e */
static const double shapes[CLASSES][5][4] = {
    {{1.3525, -0.2576, -0.2690, -1.4366},
     {-0.7670, 0.0007, 1.2734, -0.1233},
     {2.8000, 0.6004, 1.2375, 1.0000},
     {1.8734, 0.6297, 0.9738, 0.2809},
     {0.0356, -0.1246, -0.5718, 0.9938}},
    {{-1.2219, -0.7730, 1.4148, 1.1016},
     {-0.2054, 0.0367, -3.9128, 0.9156},
     {6.9750, 0.1774, 6.4477, -0.1239},
     {-1.5798, -0.5081, -1.7812, 0.1080},
     {0.2624, 0.0672, -0.2190, -0.4285}},
    {{-1.1000, -0.2515, 0.8952, 0.0156},
     {0.2782, -0.1812, -4.5000, 1.1766},
     {24.7219, -13.0812, -37.7000, 34.8438},
     {-5.0000, 1.5218, 3.9229, -2.6204},
     {-0.0156, 0.1597, 0.4199, -0.5562}},
    {{-0.5484, -0.6654, -0.2672, 0.7117},
     {0.7234, -0.6219, -5.6812, 2.6297},
     {33.3389, -18.3000, -62.2500, 52.0781},
     {-3.5000, 0.0016, 1.1477, 0.1062},
     {0.4659, -0.3296, -0.0876, -0.0329}},
    {{-0.6000, -0.3566, -2.5000, 2.3250},
     {0.2937, 0.0496, -5.6812, 1.8415},
     {21.0000, -4.7656, -21.5906, 7.2492},
     {-3.5000, -0.1554, 1.4062, 0.3988},
     {0.0032, 0.0766, -0.0656, -0.1294}},
    {{-1.0156, -0.3670, 1.0078, 1.4051},
     {0.2875, -0.5328, -3.8500, 3.3750},
     {14.0000, -0.9999, -7.1406, 7.5469},
     {-3.4000, -0.1078, -1.0750, 1.5702},
     {-0.0672, 0.4016, 0.3017, -0.4844}},
    {{-1.0000, 0.0211, 0.5025, -0.5119},
     {-0.3000, 0.1922, 0.7023, -1.6317},
     {19.0000, -5.0000, 1.2438, -1.9094},
     {-4.0000, 0.0250, 0.3844, 0.2656},
     {1.0468, -0.3788, -2.4517, 1.4656}},
    {{-1.0500, 0.0289, 0.4260, 0.3590},
     {-0.3250, 0.1156, 0.7781, 0.0025},
     {31.0625, -14.5000, -46.1148, 55.3750},
     {-7.2312, 0.4050, 13.3500, 0.6234},
     {1.5000, -0.6426, 1.8564, 0.5636}},
};

/* [Perez 1990, table 4]: a to d of the efficacy of the sky and of the sun, lm/W */
static const double sky_efficacy[CLASSES][4] = {
    {97.24, -0.46, 12.00, -8.91},   {107.22, 1.15, 0.59, -3.95},    {104.97, 2.96, -5.53, -8.77},
    {102.39, 5.59, -13.95, -13.90}, {100.71, 5.94, -22.75, -23.74}, {106.42, 3.83, -36.15, -28.83},
    {141.88, 1.90, -53.24, -14.03}, {152.23, 0.35, -45.27, -7.98},
};
static const double sun_efficacy[CLASSES][4] = {
    {57.20, -4.55, -2.98, 117.12}, {98.99, -3.46, -1.21, 12.38},  {109.83, -4.90, -1.71, -8.81},
    {110.34, -5.84, -1.99, -4.56}, {106.36, -3.97, -1.75, -6.16}, {107.19, -1.25, -1.51, -26.73},
    {105.75, 0.77, -1.26, -34.44}, {101.18, 1.58, -1.10, -8.29},
};

static struct sky_luminance finished(struct sky_luminance s, double albedo)
{
    const double of_shape = s.diffuse > 0 ? sky_shape_illuminance(&s.shape, s.to_sun) : 0;
    s.level = of_shape > 0 ? s.diffuse / of_shape : 0;
    if (!(s.to_sun.z > 0)) s.sun = 0;
    s.ground = albedo / PI * sky_horizontal_illuminance(&s);
    return s;
}

struct sky_luminance sky_of_type(int type, struct vec3 to_sun, double diffuse, double sun, double albedo)
{
    return finished((struct sky_luminance){sky_standard_shape(type), to_sun, 0, diffuse, sun, 0}, albedo);
}

static struct vec3 towards(const struct sun_position *sun, double north)
{
    return sky_compass_direction(north, sun->azimuth, sun->altitude);
}

struct sky_luminance sky_of_cover(enum sky_cover cover, const struct sun_position *sun, double north, double albedo)
{
    static const int type[3] = {SKY_CLEAR, SKY_PARTLY, SKY_TRADITIONAL};
    static const double a[3] = {800, 300, 300}, b[3] = {15.5e3, 45e3, 21e3}, c[3] = {0.5, 1, 1};
    static const double extinction[3] = {0.21, 0.80, INFINITY};
    const double height = sin(sun->altitude * DEGREE);
    double diffuse = 0, direct = 0;
    if (height > 0) {
        diffuse = a[cover] + b[cover] * pow(height, c[cover]);
        direct = SOLAR_ILLUMINANCE / (sun->distance * sun->distance) * exp(-extinction[cover] / height);
    }
    return sky_of_type(type[cover], towards(sun, north), diffuse, direct, albedo);
}

static struct sky_shape shape_of(int class, double zenith, double brightness)
{
    const double delta = class > 0 && class < 5 ? fmax(brightness, 0.2) : brightness;
    double p[5];
    for (int i = 0; i < 5; i++) {
        const double *x = shapes[class][i];
        p[i] = x[0] + x[1] * zenith + delta * (x[2] + x[3] * zenith);
    }
    if (class == 0) {
        const double *c = shapes[0][2], *d = shapes[0][3];
        p[2] = exp(pow(delta * (c[0] + c[1] * zenith), c[2])) - c[3];
        p[3] = -exp(delta * (d[0] + d[1] * zenith)) + d[2] + delta * d[3];
    }
    return (struct sky_shape){p[0], p[1], p[2], p[3], p[4], 0, false};
}

struct sky_luminance sky_from_weather(const struct sky_weather *w, const struct sun_position *sun, double north,
                                      double albedo)
{
    const double zenith_degrees = clamp(90 - sun->altitude, 0, 90), zenith = zenith_degrees * DEGREE;
    const double cubed = 1.041 * zenith * zenith * zenith;
    struct sky_luminance s = {.to_sun = towards(sun, north)};
    if (!(w->diffuse_horizontal > 0)) return s;
    const double mass = 1 / (cos(zenith) + 0.15 * pow(93.885 - zenith_degrees, -1.253));
    const double outside = SOLAR_IRRADIANCE / (sun->distance * sun->distance);
    const double brightness = clamp(w->diffuse_horizontal * mass / outside, DARKEST, BRIGHTEST);
    const double clearness = (1 + w->direct_normal / w->diffuse_horizontal + cubed) / (1 + cubed);
    int class = CLASSES - 1;
    while (class > 0 && clearness < clearness_from[class]) class --;
    const double water = exp(0.07 * fmin(w->dew_point, WETTEST) - 0.075), *d = sky_efficacy[class],
                 *b = sun_efficacy[class];
    const double of_sky = d[0] + d[1] * water + d[2] * cos(zenith) + d[3] * log(brightness);
    const double of_sun = b[0] + b[1] * water + b[2] * exp(5.73 * zenith - 5) + b[3] * brightness;
    s.shape = shape_of(class, zenith, brightness);
    s.diffuse = w->diffuse_horizontal * of_sky;
    s.sun = w->direct_normal * fmax(of_sun, 0);
    return finished(s, albedo);
}

double sky_luminance_at(const struct sky_luminance *s, struct vec3 direction)
{
    if (direction.z < 0) return s->ground;
    return s->level > 0 ? s->level * sky_shape_luminance(&s->shape, direction, s->to_sun) : 0;
}

double sky_horizontal_illuminance(const struct sky_luminance *s) { return s->diffuse + s->sun * fmax(s->to_sun.z, 0); }

double sky_sun_luminance(const struct sky_luminance *s)
{
    const double sine = sin(SUN_ANGULAR_RADIUS * DEGREE);
    return s->sun / (PI * sine * sine);
}

void sky_patch_luminances(double *luminance, const struct sky_patches *patches, const struct sky_luminance *s)
{
    const int n = patches->subdivision < SAMPLES ? SAMPLES / patches->subdivision : 1;
    double illuminance = 0;
    luminance[SKY_GROUND] = s->ground;
    for (int p = SKY_GROUND + 1; p < patches->count; p++) {
        double sum = 0;
        for (int k = 0; k < n * n; k++)
            sum += sky_luminance_at(s, sky_patch_point(patches, p, (k % n + 0.5) / n, (k / n + 0.5) / n));
        luminance[p] = sum / (n * n);
        illuminance += luminance[p] * sky_patch_projected(patches, p);
    }
    for (int p = SKY_GROUND + 1; p < patches->count && illuminance > 0; p++) luminance[p] *= s->diffuse / illuminance;
}
