/* opencv_features.cc - SIFT features, matching and two-view geometry by OpenCV; see opencv_features.h. */
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

extern "C" {
#include "stages/morph_views/opencv_features.h"
}

namespace
{

const int MAX_FEATURES = 8000;
const float RATIO = 0.8f;      /* max ratio of the distances of the best and the second best match [Lowe 2004] */
const double CONTRAST = 0.015; /* threshold, lower than SIFT's default so that dim surfaces get features, too */
const int MIN_MATCHES = 16;

struct features {
    std::vector<cv::KeyPoint> points;
    cv::Mat descriptors;
};

features find_features(const unsigned char *grey, int width, int height)
{
    features f;
    cv::SIFT::create(MAX_FEATURES, 3, CONTRAST)
        ->detectAndCompute(cv::Mat(height, width, CV_8U, const_cast<unsigned char *>(grey)), cv::noArray(), f.points,
                           f.descriptors);
    return f;
}

/* For each feature of a its match in b, or -1. */
std::vector<int> best_matches(const features &a, const features &b)
{
    std::vector<int> best(a.points.size(), -1);
    std::vector<std::vector<cv::DMatch>> found;
    if (a.points.empty() || b.points.size() < 2) return best;
    cv::BFMatcher(cv::NORM_L2).knnMatch(a.descriptors, b.descriptors, found, 2);
    for (const auto &m : found)
        if (m.size() == 2 && m[0].distance < RATIO * m[1].distance) best[size_t(m[0].queryIdx)] = m[0].trainIdx;
    return best;
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

void find(two_view *out, const unsigned char *first, const unsigned char *second, int width, int height, double focal,
          double tolerance)
{
    cv::setNumThreads(1); /* makes the order of features deterministic */
    const features a = find_features(first, width, height), b = find_features(second, width, height);
    const std::vector<int> to_b = best_matches(a, b), to_a = best_matches(b, a);
    std::vector<cv::Point2d> pa, pb;
    for (size_t i = 0; i < to_b.size(); i++) {
        if (to_b[i] < 0 || to_a[size_t(to_b[i])] != int(i)) continue;
        const cv::Point2f p = a.points[i].pt, q = b.points[size_t(to_b[i])].pt;
        pa.emplace_back(p.x + 0.5, p.y + 0.5);
        pb.emplace_back(q.x + 0.5, q.y + 0.5);
    }
    out->matches = static_cast<feature_match *>(std::calloc(pa.size() + 1, sizeof *out->matches));
    if (!out->matches) throw std::bad_alloc();
    out->count = int(pa.size());
    for (size_t i = 0; i < pa.size(); i++) out->matches[i] = {pa[i].x, pa[i].y, pb[i].x, pb[i].y, false};
    if (out->count >= MIN_MATCHES) find_geometry(out, pa, pb, width, height, focal, tolerance);
    if (out->inliers < MIN_MATCHES) out->inliers = 0;
}

} // namespace

extern "C" enum status features_find(struct two_view *out, const unsigned char *first, const unsigned char *second,
                                     int width, int height, double focal, double tolerance, struct err *err)
{
    std::memset(out, 0, sizeof *out);
    try {
        find(out, first, second, width, height, focal, tolerance);
        return ST_OK;
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
