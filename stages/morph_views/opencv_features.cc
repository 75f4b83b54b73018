/* opencv_features.cc - matched features of two pictures, and two-view geometry by OpenCV; see opencv_features.h. */
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

extern "C" {
#include "common/capture/mutual_matches.h"
#include "common/capture/opencv_sift.h"
#include "stages/morph_views/opencv_features.h"
}

namespace
{

const int MOST_FEATURES = 8000;           /* the largest */
const double CONTRAST = 0.015, EDGE = 10; /* limits of features */
const int MIN_MATCHES = 16;

/* Features of both pictures that match, without saying which are inliers. */
status find_matches(two_view *out, const unsigned char *const pictures[2], int width, int height, err *err)
{
    const match_limits limits = MATCH_LIMITS;
    const sift_limits features = {width + height, CONTRAST, EDGE};
    feature_list lists[2] = {};
    nearest_descriptors descriptors[2] = {};
    matched_pair pair = {};
    for (int i = 0; !err->status && i < 2; i++) {
        if (sift_find(&lists[i], pictures[i], width, height, &features, err)) break;
        lists[i].count = std::min(lists[i].count, MOST_FEATURES);
        nearest_descriptors_init(&descriptors[i], &lists[i], err);
    }
    if (!err->status && !mutual_matches_find(&pair, &descriptors[0], &descriptors[1], &limits, err)) {
        out->matches = static_cast<feature_match *>(std::calloc(size_t(pair.count) + 1, sizeof *out->matches));
        if (!out->matches) err_nomem(err, "matches", size_t(pair.count) * sizeof *out->matches);
    }
    for (int i = 0; !err->status && i < pair.count; i++) {
        const feature &p = lists[0].features[pair.matches[i].first], &q = lists[1].features[pair.matches[i].second];
        out->matches[out->count++] = {double(p.x), double(p.y), double(q.x), double(q.y), false};
    }
    std::free(pair.matches);
    for (int i = 0; i < 2; i++) {
        nearest_descriptors_release(&descriptors[i]);
        feature_list_release(&lists[i]);
    }
    return err->status;
}

cv::UsacParams usac(double tolerance)
{
    cv::UsacParams p;
    p.confidence = 0.9999;
    p.isParallel = false;
    p.loMethod = cv::LOCAL_OPTIM_SIGMA;
    p.maxIterations = 10000;
    p.randomGeneratorState = 1;
    p.sampler = cv::SAMPLING_UNIFORM;
    p.score = cv::SCORE_METHOD_MAGSAC;
    p.threshold = tolerance;
    return p;
}

void find_geometry(two_view *out, const std::vector<cv::Point2d> &a, const std::vector<cv::Point2d> &b, int width,
                   int height, double focal, double tolerance)
{
    cv::Mat mask, rotation, translation;
    const cv::Mat plane = cv::findHomography(a, b, mask, usac(tolerance));
    out->plane_inliers = plane.empty() ? 0 : cv::countNonZero(mask);
    cv::Mat f = cv::findFundamentalMat(a, b, mask, usac(tolerance));
    if (f.rows != 3 || f.cols != 3) return;
    f.convertTo(f, CV_64F);
    out->inliers = cv::countNonZero(mask);
    for (int i = 0; i < out->count; i++) out->matches[i].inlier = mask.at<unsigned char>(i) != 0;
    for (int i = 0; i < 9; i++) out->fundamental[i] = f.at<double>(i / 3, i % 3);
    const cv::Matx33d k(focal, 0, width / 2.0, 0, focal, height / 2.0, 0, 0, 1);
    const cv::Mat essential = cv::Mat(k.t() * cv::Matx33d(f) * k);
    if (cv::recoverPose(essential, a, b, cv::Mat(k), rotation, translation, mask) < MIN_MATCHES) return;
    for (int i = 0; i < 9; i++) out->rotation[i] = rotation.at<double>(i / 3, i % 3);
    for (int i = 0; i < 3; i++) out->translation[i] = translation.at<double>(i);
}

void find(two_view *out, const unsigned char *const pictures[2], int width, int height, double focal, double tolerance,
          err *err)
{
    std::vector<cv::Point2d> a, b;
    if (find_matches(out, pictures, width, height, err)) return;
    for (int i = 0; i < out->count; i++) {
        a.emplace_back(out->matches[i].x1, out->matches[i].y1);
        b.emplace_back(out->matches[i].x2, out->matches[i].y2);
    }
    if (out->count >= MIN_MATCHES) find_geometry(out, a, b, width, height, focal, tolerance);
    if (out->inliers < MIN_MATCHES) out->inliers = 0;
}

} // namespace

extern "C" enum status features_find(struct two_view *out, const unsigned char *first, const unsigned char *second,
                                     int width, int height, double focal, double tolerance, struct err *err)
{
    std::memset(out, 0, sizeof *out);
    try {
        const unsigned char *const pictures[2] = {first, second};
        find(out, pictures, width, height, focal, tolerance, err);
        if (err->status) features_release(out);
        return err->status;
    } catch (const std::bad_alloc &) {
        features_release(out);
        return err_nomem(err, "features of two pictures", size_t(width) * size_t(height));
    } catch (const std::exception &e) {
        features_release(out);
        return err_set(err, ST_INTERNAL, "OpenCV could not match two pictures of %d x %d pixels: %.300s.", width,
                       height, e.what());
    }
}

extern "C" void features_release(struct two_view *v)
{
    if (!v) return;
    std::free(v->matches);
    std::memset(v, 0, sizeof *v);
}
