// depth_sgbm.cc - see depth_sgbm.h.
#include "tests/bench/depth_sgbm.h"

#include <opencv2/calib3d.hpp>

static cv::Mat widened(const unsigned char *rgb, int width, int height, int by)
{
    cv::Mat wide, picture(height, width, CV_8UC3, const_cast<unsigned char *>(rgb));
    cv::copyMakeBorder(picture, wide, 0, 0, by, 0, cv::BORDER_REPLICATE);
    return wide;
}

extern "C" enum status sgbm_match(float *disparity, const unsigned char *left, const unsigned char *right, int width,
                                  int height, const struct sgbm_settings *s, struct err *err)
try {
    const int area = 3 * s->block * s->block;
    cv::Ptr<cv::StereoSGBM> matcher = cv::StereoSGBM::create(0, s->disparities, s->block, s->p1 * area, s->p2 * area,
                                                             -1, 63, s->uniqueness, 0, 0, cv::StereoSGBM::MODE_HH);
    const int margin = s->widen ? s->disparities : 0;
    cv::Mat sixteenths;
    cv::setNumThreads(1);
    matcher->compute(widened(left, width, height, margin), widened(right, width, height, margin), sixteenths);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const short d = sixteenths.at<short>(y, x + margin);
            disparity[y * width + x] = d > 0 ? static_cast<float>(d) / 16 : 0;
        }
    return ST_OK;
} catch (const std::exception &e) {
    return err_set(err, ST_INTERNAL, "OpenCV cannot match the pair: %s.", e.what());
}
