// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/refine_corners.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "base/order_statistics.h"

namespace axial::calibrate {

int window_for(double spacing) {
  // A third of the spacing to each side.
  return static_cast<int>(std::clamp(spacing / 3, 2.0, 11.0));
}

bool holds_window(const cv::Mat1b& photograph, int half, const Eigen::Vector2d& corner) {
  return corner.x() >= half && corner.y() >= half && corner.x() <= photograph.cols - 1 - half &&
         corner.y() <= photograph.rows - 1 - half;
}

void move_to_edges(const cv::Mat1b& photograph, int half, std::vector<cv::Point2f>& corners) {
  cv::cornerSubPix(photograph, corners, {half, half}, {-1, -1},
                   {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-3});
}

double asymmetry(const cv::Mat1b& photograph, int half, const Eigen::Vector2d& corner) {
  cv::Mat1b window;
  cv::getRectSubPix(photograph, {2 * half + 1, 2 * half + 1},
                    cv::Point2f(static_cast<float>(corner.x()), static_cast<float>(corner.y())),
                    window);
  cv::Mat1f smooth, opposite;
  window.convertTo(smooth, CV_32F);
  // Averages the noise of pixels, over more of them in larger windows.
  cv::GaussianBlur(smooth, smooth, {}, 1 + half / 8.0, 0, cv::BORDER_REPLICATE);
  cv::flip(smooth, opposite, -1);
  const double difference = cv::norm(smooth, opposite, cv::NORM_L1);
  const double contrast = 2 * cv::norm(smooth - cv::mean(smooth)[0], cv::NORM_L1);
  return contrast > 0 ? difference / contrast : 0;
}

double hidden_above(std::span<const double> asymmetries, double least) {
  return std::max(least,
                  3 * upper_median(std::vector<double>(asymmetries.begin(), asymmetries.end())));
}

}  // namespace axial::calibrate
