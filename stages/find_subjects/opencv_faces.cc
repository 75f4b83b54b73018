// opencv_faces.cc - faces by OpenCV's cascades of Haar features [Viola 2001].
#include "stages/find_subjects/opencv_faces.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>

#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

static const double scale_step = 1.1;
static const int min_windows = 4; // overlapping detections that make a face

// The first line of OpenCV's message: its what() has file names and line breaks.
static std::string reason(const std::exception &e)
{
    const auto *of_opencv = dynamic_cast<const cv::Exception *>(&e);
    std::string text = of_opencv ? of_opencv->err : e.what();
    return text.substr(0, text.find('\n'));
}

extern "C" const char *const face_cascades[] = {
    "haarcascade_frontalface_alt2.xml", "haarcascade_frontalface_default.xml", "haarcascade_profileface.xml", nullptr};
static const int profile = 2; // its faces look to one side; the mirrored picture finds the others

struct face_detector {
    std::vector<cv::CascadeClassifier> cascades;
};

extern "C" enum status face_detector_open(struct face_detector **detector, const char *folder, struct err *err)
{
    *detector = nullptr;
    std::string path;
    try {
        cv::setNumThreads(1); // makes the order of detections reproducible
        face_detector *d = *detector = new face_detector;
        for (int i = 0; face_cascades[i]; i++) {
            path = std::string(folder) + "/" + face_cascades[i];
            if (access(path.c_str(), R_OK)) throw std::runtime_error(std::strerror(errno));
            d->cascades.emplace_back();
            if (!d->cascades.back().load(path)) throw std::runtime_error("OpenCV finds no cascade in it");
        }
        return ST_OK;
    } catch (const std::exception &e) {
        face_detector_release(*detector);
        *detector = nullptr;
        return err_set(err, ST_IO, "cannot use the face cascade %s: %s; it is in Debian's package opencv-data.",
                       path.c_str(), reason(e).c_str());
    }
}

extern "C" void face_detector_release(struct face_detector *detector) { delete detector; }

extern "C" enum status face_detect(struct face_detector *detector, const unsigned char *grey, int width, int height,
                                   double min_width, double max_width, struct face_box **faces, int *count,
                                   struct err *err)
{
    *faces = nullptr;
    *count = 0;
    try {
        const cv::Mat stored(height, width, CV_8UC1, const_cast<unsigned char *>(grey));
        cv::Mat even, mirrored;
        cv::equalizeHist(stored, even);
        cv::flip(even, mirrored, 1);
        const int low = std::max(1, static_cast<int>(std::ceil(min_width)));
        const int high = std::max(low, static_cast<int>(std::floor(max_width)));
        std::vector<face_box> found;
        for (size_t i = 0; i <= detector->cascades.size(); i++) {
            const bool mirror = i == detector->cascades.size();
            std::vector<cv::Rect> places;
            std::vector<int> windows;
            detector->cascades[mirror ? static_cast<size_t>(profile) : i].detectMultiScale(
                mirror ? mirrored : even, places, windows, scale_step, min_windows - 1, 0, cv::Size(low, low),
                cv::Size(high, high));
            for (size_t k = 0; k < places.size(); k++) {
                const cv::Rect &p = places[k];
                const int x = mirror ? width - p.x - p.width : p.x;
                found.push_back({static_cast<double>(x), static_cast<double>(p.y), static_cast<double>(x + p.width),
                                 static_cast<double>(p.y + p.height), static_cast<double>(windows[k])});
            }
        }
        if (found.empty()) return ST_OK;
        *faces = static_cast<face_box *>(std::malloc(found.size() * sizeof **faces));
        if (!*faces) return err_nomem(err, "faces", found.size() * sizeof **faces);
        std::copy(found.begin(), found.end(), *faces);
        *count = static_cast<int>(found.size());
        return ST_OK;
    } catch (const std::exception &e) {
        return err_set(err, ST_INTERNAL, "OpenCV's face detection failed: %s.", reason(e).c_str());
    }
}
