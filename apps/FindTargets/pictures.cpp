// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "io/images/image.h"

namespace axial::apps {
namespace {

constexpr int kSide = 192;  // of a picture [px]

// The surroundings of the target, enlarged; black beyond the photograph.
cv::Mat3b enlarged(const cv::Mat3b& pixels, const targets::Detection& target) {
  const double scale = kSide / (1.8 * target.width);
  // An affine map of OpenCV maps pixel centres, which are integers there.
  const Eigen::Vector2d centre = target.centre.pixel.array() - 0.5;
  const double middle = (kSide - 1) / 2.0;
  const cv::Matx23d map(scale, 0, middle - scale * centre.x(), 0, scale,
                        middle - scale * centre.y());
  cv::Mat3b picture;
  cv::warpAffine(pixels, picture, map, {kSide, kSide},
                 scale > 1 ? cv::INTER_NEAREST : cv::INTER_AREA);
  const cv::Point cross(kSide / 2, kSide / 2);
  cv::drawMarker(picture, cross, {0, 0, 255}, cv::MARKER_CROSS, kSide / 6);
  return picture;
}

std::string file_name(const std::string& image, const targets::Detection& target) {
  std::string name = std::filesystem::path(image).replace_extension().string();
  std::ranges::replace(name, '/', '_');
  name += "-" + target.label;
  std::ranges::replace(name, ' ', '-');
  return name + ".jpg";
}

}  // namespace

void write_pictures(const std::filesystem::path& folder, const cv::Mat3b& pixels,
                    const targets::Photograph& found) {
  for (const targets::Detection& target : found.targets)
    io::write_jpeg(folder / file_name(found.name, target), enlarged(pixels, target), 90);
}

}  // namespace axial::apps
