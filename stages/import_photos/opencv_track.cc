// opencv_track.cc - points of a key frame followed through a clip.
//
// Corners are followed from the key frame itself, not from the frame before, so that errors do not add up and a blurred
// frame in between does no harm; where a point was found last is where its search begins. A point counts if following
// it back ends where it began. Points that are still hardly moved relative to each other by anything but turns and
// zooms obey one homography; what is left is parallax.
#include "stages/import_photos/opencv_track.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

namespace
{
const int MAX_CORNERS = 300, LEVELS = 4, MAX_TRIALS = 500;
const double MIN_QUALITY = 0.005;
const size_t MIN_POINTS = 24;
const float MAX_RETURN = 0.7f; // px between a point and where following it back leads
const double PLANE = 1.5;      // px; points this near to their places by a homography support it
const double MOST = 0.8;       // the percentile that stands for parallax
const cv::Size WINDOW(15, 15);

// From the key frame to `to`, and back.
std::vector<uchar> follow(const std::vector<cv::Mat> &key, const std::vector<cv::Mat> &now,
                          const std::vector<cv::Point2f> &from, std::vector<cv::Point2f> &to)
{
    const cv::TermCriteria end(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.02);
    std::vector<uchar> found, back_found;
    std::vector<float> error;
    std::vector<cv::Point2f> back = from;
    cv::calcOpticalFlowPyrLK(key, now, from, to, found, error, WINDOW, LEVELS, end, cv::OPTFLOW_USE_INITIAL_FLOW);
    cv::calcOpticalFlowPyrLK(now, key, to, back, back_found, error, WINDOW, LEVELS, end, cv::OPTFLOW_USE_INITIAL_FLOW);
    for (size_t i = 0; i < from.size(); i++) {
        const cv::Point2f d = back[i] - from[i];
        found[i] = found[i] && back_found[i] && std::hypot(d.x, d.y) <= MAX_RETURN;
    }
    return found;
}
} // namespace

struct track {
    int width, height;
    std::vector<cv::Mat> pyramid;
    std::vector<cv::Point2f> points, last;
};

static cv::Mat picture_of(const unsigned char *grey, int width, int height)
{
    return cv::Mat(height, width, CV_8U, const_cast<unsigned char *>(grey));
}

extern "C" enum status track_begin(struct track **t, const unsigned char *grey, int width, int height, struct err *err)
{
    try {
        cv::setNumThreads(1);
        track_release(*t);
        *t = new track{width, height, {}, {}, {}};
        const cv::Mat picture = picture_of(grey, width, height).clone();
        cv::goodFeaturesToTrack(picture, (*t)->points, MAX_CORNERS, MIN_QUALITY, std::max(width, height) / 64.0);
        cv::buildOpticalFlowPyramid(picture, (*t)->pyramid, WINDOW, LEVELS);
        (*t)->last = (*t)->points;
        return ST_OK;
    } catch (const std::bad_alloc &) {
        *t = nullptr;
        return err_nomem(err, "a key frame", 0);
    } catch (const std::exception &e) {
        return err_set(err, ST_INTERNAL, "OpenCV cannot find points to follow: %s", e.what());
    }
}

extern "C" enum status track_measure(struct track_motion *m, struct track *t, const unsigned char *grey,
                                     struct err *err)
{
    *m = {};
    try {
        std::vector<cv::Mat> now;
        std::vector<cv::Point2f> to = t->last, a, b, all;
        std::vector<double> distances;
        if (t->points.size() < MIN_POINTS) return ST_OK;
        cv::buildOpticalFlowPyramid(picture_of(grey, t->width, t->height), now, WINDOW, LEVELS);
        const std::vector<uchar> found = follow(t->pyramid, now, t->points, to);
        for (size_t i = 0; i < found.size(); i++)
            if (found[i]) {
                a.push_back(t->points[i]);
                b.push_back(to[i]);
            }
        if (a.size() < MIN_POINTS) return ST_OK;
        const cv::Mat h = cv::findHomography(a, b, cv::RANSAC, PLANE, cv::noArray(), MAX_TRIALS);
        if (h.empty()) return ST_OK;
        cv::perspectiveTransform(a, all, h);
        for (size_t i = 0; i < a.size(); i++) distances.push_back(std::hypot(all[i].x - b[i].x, all[i].y - b[i].y));
        cv::perspectiveTransform(t->points, all, h);
        size_t inside = 0;
        for (size_t i = 0; i < all.size(); i++) {
            inside += all[i].x >= 0 && all[i].y >= 0 && all[i].x <= static_cast<float>(t->width) &&
                      all[i].y <= static_cast<float>(t->height);
            t->last[i] = found[i] ? to[i] : all[i]; // where the search begins next time
        }
        const auto at = distances.begin() + static_cast<std::ptrdiff_t>(MOST * static_cast<double>(a.size() - 1));
        std::nth_element(distances.begin(), at, distances.end());
        m->known = std::isfinite(*at);
        m->parallax = *at / std::max(t->width, t->height);
        m->overlap = static_cast<double>(inside) / static_cast<double>(all.size());
        return ST_OK;
    } catch (const std::bad_alloc &) {
        return err_nomem(err, "points to follow", 0);
    } catch (const std::exception &e) {
        return err_set(err, ST_INTERNAL, "OpenCV cannot follow points: %s", e.what());
    }
}

extern "C" void track_release(struct track *t) { delete t; }
