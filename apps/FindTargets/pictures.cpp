// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "base/atomic_file.h"
#include "io/images/image.h"

namespace axial::apps {
namespace {

constexpr int kSide = 192;  // of a picture [px]

// The surroundings of the target, enlarged; black beyond the photograph.
cv::Mat3b enlarged(const cv::Mat3b& photograph, const targets::Detection& target) {
  const int half = static_cast<int>(std::ceil(0.9 * target.width));
  const Eigen::Vector2d centre = target.centre.pixel.array() - 0.5;  // OpenCV's convention
  const cv::Rect around(static_cast<int>(std::lround(centre.x())) - half,
                        static_cast<int>(std::lround(centre.y())) - half, 2 * half + 1,
                        2 * half + 1);
  const cv::Rect there = around & cv::Rect(0, 0, photograph.cols, photograph.rows);
  cv::Mat3b cut(around.size(), cv::Vec3b(0, 0, 0));
  photograph(there).copyTo(cut(there - around.tl()));
  cv::Mat3b picture;
  cv::resize(cut, picture, {kSide, kSide}, 0, 0,
             cut.cols < kSide ? cv::INTER_NEAREST : cv::INTER_AREA);
  const auto place = [&](double at, int low) {
    return static_cast<int>((at + 0.5 - low) * kSide / around.width);
  };
  cv::drawMarker(picture, {place(centre.x(), around.x), place(centre.y(), around.y)}, {0, 0, 255},
                 cv::MARKER_CROSS, kSide / 6);
  return picture;
}

}  // namespace

void write_pictures(const std::filesystem::path& folder, const cv::Mat3b& photograph,
                    const targets::Photograph& found) {
  const std::filesystem::path own = folder / found.name;
  std::map<std::string, int> shown;
  for (const targets::Detection& target : found.targets) {
    make_folder(own);
    std::string name = target.label;
    std::ranges::replace(name, ' ', '-');
    if (const int again = ++shown[target.label]; again > 1) name += fmt::format("-{}", again);
    io::write_jpeg(own / (name + ".jpg"), enlarged(photograph, target), 90);
  }
}

}  // namespace axial::apps
