// opencv_lines.cc - see opencv_lines.h.
#include "stages/find_lines/opencv_lines.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <vector>

static const int tiles = 8; // of local contrast, in each direction

extern "C" enum status lines_detect(struct picture_line **lines, int *count, const unsigned char *grey, int width,
                                    int height, double min_length, double contrast, struct err *err)
{
    *lines = nullptr;
    *count = 0;
    try {
        cv::setNumThreads(1); // the order of lines is reproducible
        const cv::Mat picture(height, width, CV_8U, const_cast<unsigned char *>(grey));
        cv::Mat equal = picture;
        std::vector<cv::Vec4f> found;
        if (contrast > 0) cv::createCLAHE(contrast, cv::Size(tiles, tiles))->apply(picture, equal);
        cv::createLineSegmentDetector(cv::LSD_REFINE_STD)->detect(equal, found);
        *lines = static_cast<struct picture_line *>(std::malloc((found.size() + 1) * sizeof **lines));
        if (!*lines) return err_nomem(err, "lines", found.size() * sizeof **lines);
        for (const cv::Vec4f &l : found) {
            const double u0 = static_cast<double>(l[0]), v0 = static_cast<double>(l[1]), u1 = static_cast<double>(l[2]),
                         v1 = static_cast<double>(l[3]);
            if (std::hypot(u1 - u0, v1 - v0) >= min_length)
                (*lines)[(*count)++] = {u0 + 0.5, v0 + 0.5, u1 + 0.5, v1 + 0.5};
        }
        return ST_OK;
    } catch (const std::exception &e) {
        return err_set(err, ST_INTERNAL, "OpenCV cannot find lines: %s", e.what());
    }
}
