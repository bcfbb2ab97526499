// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/fits/corner_fit.h"

#include <algorithm>
#include <vector>

#include "targets/fits/edge_fit.h"

namespace axial::targets {
namespace {

// A wedge: its corner, and the angles of the inward normals of its sides. The product is exact for
// a right angle, and differs little for others.
struct WedgeShare {
  template <class T>
  T operator()(const T* shape, double x, double y, const T& per_blur) const {
    const T dx = x - shape[0], dy = y - shape[1];
    const T first = cos(shape[2]) * dx + sin(shape[2]) * dy;
    const T second = cos(shape[3]) * dx + sin(shape[3]) * dy;
    return inside_share(T(first * per_blur)) * inside_share(T(second * per_blur));
  }
};

// The angle of the normal of the side along `direction` that points towards `inner`.
double inward(const Eigen::Vector2d& direction, const Eigen::Vector2d& inner) {
  Eigen::Vector2d normal(-direction.y(), direction.x());
  if (normal.dot(inner) < 0) normal = -normal;
  return std::atan2(normal.y(), normal.x());
}

// The pixels near the sides.
std::vector<cv::Point> pixels_of(const Eigen::Vector4d& wedge, double reach, double band) {
  const auto low = [&](double at) { return static_cast<int>(std::floor(at - reach)); };
  const auto high = [&](double at) { return static_cast<int>(std::ceil(at + reach)); };
  const Eigen::Vector2d first(std::cos(wedge[2]), std::sin(wedge[2]));
  const Eigen::Vector2d second(std::cos(wedge[3]), std::sin(wedge[3]));
  std::vector<cv::Point> pixels;
  for (int y = low(wedge.y()); y <= high(wedge.y()); ++y)
    for (int x = low(wedge.x()); x <= high(wedge.x()); ++x) {
      const Eigen::Vector2d offset = Eigen::Vector2d(x, y) - wedge.head<2>();
      const double inside = std::min(first.dot(offset), second.dot(offset));
      if (offset.norm() < reach && std::abs(inside) < band) pixels.emplace_back(x, y);
    }
  return pixels;
}

EdgeFit<4> start_of(const cv::Mat1f& picture, const Eigen::Vector4d& wedge,
                    std::span<const cv::Point> pixels) {
  const auto [low, high] =
      std::ranges::minmax(pixels, {}, [&](const cv::Point& p) { return picture(p); });
  EdgeFit<4> start;
  start.shape = wedge;
  start.inside = static_cast<double>(picture(low));
  start.outside = static_cast<double>(picture(high));
  start.blur = 0.7;
  return start;
}

}  // namespace

std::optional<CornerFit> fit_corner(const cv::Mat1f& picture, const Eigen::Vector2d& before,
                                    const Eigen::Vector2d& corner, const Eigen::Vector2d& after,
                                    double cell) {
  const Eigen::Vector2d first = before - corner, second = after - corner;
  const double reach = std::min({40.0, first.norm() / 2, second.norm() / 2});
  const Eigen::Vector4d wedge(corner.x(), corner.y(), inward(first, second), inward(second, first));
  const std::vector<cv::Point> pixels = pixels_of(wedge, reach, std::clamp(cell - 1.4, 1.1, 6.0));
  const cv::Rect whole(0, 0, picture.cols, picture.rows);
  const auto inside = [&](const cv::Point& p) { return whole.contains(p); };
  if (pixels.empty() || !std::ranges::all_of(pixels, inside)) return std::nullopt;
  const auto fit = fit_edge<4>(picture, pixels, start_of(picture, wedge, pixels), WedgeShare{});
  if (!fit || (fit->shape.head<2>() - corner).norm() > std::max(1.0, cell)) return std::nullopt;
  return CornerFit{fit->shape.head<2>(), fit->covariance.topLeftCorner<2, 2>(), fit->blur};
}

}  // namespace axial::targets
