/* render_estimate.c - how long the pictures of a described scene take on this machine.
 *
 * A small picture from each camera, with few samples, gives the seconds per light path there; pixels times samples of
 * the full picture give the rest. Paths of the shell and of irradiance are taken to be as long as those of the
 * photo. */
#include "stages/simulate/render_estimate.h"

#include <math.h>
#include <string.h>

#include "common/base/clock.h"

#define PILOT_SIDE    64 /* px, of the longer side */
#define PILOT_SAMPLES 4

/* Seconds that the pixels of a camera take with one sample each. */
static enum status pilot(double *seconds, const struct picture_job *job, const struct world *w,
                         const struct shoot_photo *photo, struct err *err)
{
    struct camera_view view = render_view_make(job->shoot, photo);
    struct shoot_lens small = *view.lens;
    struct simulate_params params = *job->params;
    struct image image = {0};
    const double pixels = (double)small.width * small.height;
    const double scale = fmin(1, PILOT_SIDE / fmax(small.width, small.height));
    small.width = (int)fmax(1, small.width * scale), small.height = (int)fmax(1, small.height * scale);
    small.fx *= scale, small.fy *= scale, small.cx *= scale, small.cy *= scale;
    view.lens = &small;
    params.samples = PILOT_SAMPLES;
    const double started = clock_seconds();
    render_radiance(&image, w, &view, photo->name, &params, NULL, err);
    *seconds = (clock_seconds() - started) * pixels / ((double)small.width * small.height * PILOT_SAMPLES);
    image_release(&image);
    return err->status;
}

static void print_kind(FILE *to, const char *kind, int pictures, int samples, double seconds)
{
    if (pictures)
        fprintf(to, "%s: %d of them, %d samples: about %.2g minutes\n", kind, pictures, samples,
                seconds * samples / 60);
}

enum status estimate_print(FILE *to, const struct picture_job *job, const struct world *w, struct err *err)
{
    const struct simulate_params *params = job->params;
    const int truth = params->truth_samples ? params->truth_samples : params->samples;
    const bool twice = params->truth_samples && !strcmp(params->truth, "yes");
    double seconds[3] = {0, 0, 0};
    int count[3] = {0, 0, 0};
    for (int i = 0; i < job->shoot->photo_count; i++) {
        const struct shoot_photo *photo = &job->shoot->photos[i];
        double one = 0;
        if (pilot(&one, job, w, photo, err)) return err->status;
        seconds[photo->kind] += one;
        count[photo->kind]++;
    }
    const double all = seconds[SHOOT_PHOTO] + seconds[SHOOT_WITNESS];
    const int views = count[SHOOT_PHOTO] + count[SHOOT_WITNESS];
    print_kind(to, "photos", count[SHOOT_PHOTO], params->samples, seconds[SHOOT_PHOTO]);
    print_kind(to, "reference images", count[SHOOT_REFERENCE], params->samples, seconds[SHOOT_REFERENCE]);
    if (twice) print_kind(to, "radiance of photos", count[SHOOT_PHOTO], truth, seconds[SHOOT_PHOTO]);
    print_kind(to, "witnesses", count[SHOOT_WITNESS], truth, seconds[SHOOT_WITNESS]);
    print_kind(to, "pictures of the shell", views, truth, all);
    print_kind(to, "pictures of irradiance", views, truth, all);
    print_kind(to, "pictures of an edited scene", views, truth, all);
    return ST_OK;
}
