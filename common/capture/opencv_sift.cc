// opencv_sift.cc - see opencv_sift.h.
#include "common/capture/opencv_sift.h"

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <vector>

// OpenCV doubles the picture first, so that pixel i of it is between pixels of the double one, and takes it for pixel
// 2 i: features lie a quarter of a pixel too far. The centre of its first pixel is at 0, ours at 0.5.
static const float pixel_centre = 0.5f - 0.25f;

static void set_descriptor(uint8_t *to, const float *histogram)
{
    float sum = 0;
    for (int k = 0; k < DESCRIPTOR_SIZE; k++) sum += histogram[k];
    for (int k = 0; k < DESCRIPTOR_SIZE; k++) {
        const float root = sum > 0 ? std::sqrt(histogram[k] / sum) : 0;
        to[k] = static_cast<uint8_t>(std::min(255.f, std::nearbyint(static_cast<float>(DESCRIPTOR_LENGTH) * root)));
    }
}

extern "C" enum status sift_find(struct feature_list *list, const unsigned char *grey, int width, int height,
                                 const struct sift_limits *limits, struct err *err)
{
    *list = {};
    try {
        cv::setNumThreads(1); // the order of features is reproducible
        cv::Mat picture(height, width, CV_8U, const_cast<unsigned char *>(grey)), descriptors;
        std::vector<cv::KeyPoint> points;
        const int longer = std::max(width, height);
        if (longer > limits->longest) {
            const double scale = static_cast<double>(limits->longest) / longer;
            cv::resize(
                picture, picture,
                cv::Size(static_cast<int>(std::lround(scale * width)), static_cast<int>(std::lround(scale * height))),
                0, 0, cv::INTER_AREA);
        }
        const float to_x = static_cast<float>(width) / static_cast<float>(picture.cols),
                    to_y = static_cast<float>(height) / static_cast<float>(picture.rows);
        cv::SIFT::create(0, 3, limits->contrast, limits->edge)
            ->detectAndCompute(picture, cv::noArray(), points, descriptors);
        std::vector<size_t> order(points.size());
        std::iota(order.begin(), order.end(), size_t(0));
        std::sort(order.begin(), order.end(), [&points](size_t i, size_t j) {
            const auto key = [](const cv::KeyPoint &p) {
                return std::make_tuple(-p.size, -p.response, p.pt.y, p.pt.x, p.angle);
            };
            return key(points[i]) < key(points[j]);
        });
        list->features = static_cast<struct feature *>(std::malloc((order.size() + 1) * sizeof *list->features));
        if (!list->features) return err_nomem(err, "features", order.size() * sizeof *list->features);
        list->count = static_cast<int>(std::min(order.size(), static_cast<size_t>(MAX_FEATURES)));
        for (int i = 0; i < list->count; i++) {
            const cv::KeyPoint &p = points[order[static_cast<size_t>(i)]];
            struct feature *f = &list->features[i];
            f->x = (p.pt.x + pixel_centre) * to_x;
            f->y = (p.pt.y + pixel_centre) * to_y;
            f->scale = p.size / 2 * to_x;
            f->angle = p.angle * static_cast<float>(CV_PI / 180);
            set_descriptor(f->descriptor, descriptors.ptr<float>(static_cast<int>(order[static_cast<size_t>(i)])));
        }
        return ST_OK;
    } catch (const std::exception &e) {
        feature_list_release(list);
        return err_set(err, ST_INTERNAL, "OpenCV cannot find features: %s", e.what());
    }
}
