// SPDX-License-Identifier: GPL-3.0-or-later
#include "belong/coverage.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace axial::belong {
namespace {

constexpr double kPartsOfCell = 12;
constexpr double kFinest = 32;  // cells along the longer side
constexpr std::size_t kFewestParts = 100;

cv::Point cell_at(const Eigen::Vector2d& pixel, double cell) {
  return {static_cast<int>(std::floor((pixel.x() + 0.5) / cell)),
          static_cast<int>(std::floor((pixel.y() + 0.5) / cell))};
}

}  // namespace

bool Coverage::contains(const Eigen::Vector2d& pixel) const {
  if (cell <= 0) return false;
  const cv::Point at = cell_at(pixel, cell);
  return at.x >= 0 && at.y >= 0 && at.x < covered.cols && at.y < covered.rows && covered(at) != 0;
}

Coverage coverage_of(const Scene& scene, SceneCameras& cameras, std::uint32_t image,
                     const Shape& shape, std::span<const std::size_t> parts) {
  std::vector<Eigen::Vector2d> pixels;
  for (const std::size_t part : parts)
    if (const auto pixel = cameras.pixel(image, shape.middle(part))) pixels.push_back(*pixel);
  Coverage result;
  result.in_image = pixels.size();
  if (pixels.size() < kFewestParts) return result;
  const CameraModel& camera = scene.images[image].camera;
  const double width = camera.width, height = camera.height;
  result.cell =
      std::max(std::sqrt(kPartsOfCell * width * height / static_cast<double>(pixels.size())),
               std::max(width, height) / kFinest);
  cv::Mat1b marked(static_cast<int>(std::ceil(height / result.cell)),
                   static_cast<int>(std::ceil(width / result.cell)), std::uint8_t{0});
  for (const Eigen::Vector2d& pixel : pixels) {
    const cv::Point at = cell_at(pixel, result.cell);
    marked(std::min(at.y, marked.rows - 1), std::min(at.x, marked.cols - 1)) = 255;
  }
  const double area = cv::countNonZero(marked) * result.cell * result.cell;
  result.spacing =
      std::sqrt(area / static_cast<double>(pixels.size()) * static_cast<double>(parts.size()) /
                static_cast<double>(shape.parts()));
  // Beyond the border of the image, cells count as marked (OpenCV's default).
  cv::erode(marked, result.covered, cv::Mat());
  return result;
}

}  // namespace axial::belong
