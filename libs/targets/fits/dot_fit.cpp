// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/fits/dot_fit.h"

#include <Eigen/Eigenvalues>
#include <numbers>
#include <vector>

#include "targets/fits/edge_fit.h"

namespace axial::targets {
namespace {

constexpr double kReach = 1.6;  // the blurred ring begins at 2 radii

// The distance from the ellipse is taken to first order: the level of its equation by the gradient.
struct EllipseShare {
  template <class T>
  T operator()(const T* shape, double x, double y, const T& per_blur) const {
    const T dx = x - shape[0], dy = y - shape[1];
    const T u = shape[2] * dx + shape[3] * dy;
    const T v = shape[3] * dx + shape[4] * dy;
    const T gx = shape[2] * u + shape[3] * v;
    const T gy = shape[3] * u + shape[4] * v;
    using std::sqrt;
    const T radius = sqrt(u * u + v * v);
    return inside_share(T((1.0 - radius) * radius / sqrt(gx * gx + gy * gy) * per_blur));
  }
};

// The pixels between 0.3 and kReach radii: the model of the distance has no gradient at the centre.
std::vector<cv::Point> pixels_around(const Ellipse& ellipse, const cv::Rect& box) {
  std::vector<cv::Point> pixels;
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x) {
      const double radius = (ellipse.to_circle * (Eigen::Vector2d(x, y) - ellipse.centre)).norm();
      if (radius > 0.3 && radius < kReach) pixels.emplace_back(x, y);
    }
  return pixels;
}

EdgeFit<5> start_of(const cv::Mat1f& picture, const Ellipse& ellipse,
                    std::span<const cv::Point> pixels) {
  EdgeFit<5> start;
  const Eigen::Matrix2d& m = ellipse.to_circle;
  start.shape << ellipse.centre, m(0, 0), m(0, 1), m(1, 1);
  double inside = 0, outside = 0;
  int inner = 0, outer = 0;
  for (const cv::Point& p : pixels) {
    const double radius = (m * (Eigen::Vector2d(p.x, p.y) - ellipse.centre)).norm();
    if (radius < 0.8) inside += static_cast<double>(picture(p)), ++inner;
    if (radius > 1.3) outside += static_cast<double>(picture(p)), ++outer;
  }
  start.inside = inner ? inside / inner : static_cast<double>(picture(pixels.front()));
  start.outside = outer ? outside / outer : 0;
  start.blur = 0.7;
  return start;
}

}  // namespace

Ellipse ellipse_of(const cv::RotatedRect& box) {
  const double angle = static_cast<double>(box.angle) * std::numbers::pi / 180;
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  const Eigen::Vector2d scale(2 / std::max(1e-3, static_cast<double>(box.size.width)),
                              2 / std::max(1e-3, static_cast<double>(box.size.height)));
  return {{static_cast<double>(box.center.x), static_cast<double>(box.center.y)},
          turn * scale.asDiagonal() * turn.transpose()};
}

Eigen::Vector2d half_axes(const Ellipse& ellipse) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(ellipse.to_circle);
  const Eigen::Vector2d axes = solver.eigenvalues().cwiseAbs().cwiseInverse();
  return {axes.minCoeff(), axes.maxCoeff()};
}

cv::Rect box_of(const Ellipse& ellipse, double reach) {
  const Eigen::Matrix2d spread = (ellipse.to_circle * ellipse.to_circle).inverse();
  const Eigen::Vector2d half = reach * spread.diagonal().cwiseSqrt();
  const cv::Point low(static_cast<int>(std::floor(ellipse.centre.x() - half.x())),
                      static_cast<int>(std::floor(ellipse.centre.y() - half.y())));
  const cv::Point high(static_cast<int>(std::ceil(ellipse.centre.x() + half.x())) + 1,
                       static_cast<int>(std::ceil(ellipse.centre.y() + half.y())) + 1);
  return {low, high};
}

std::optional<DotFit> fit_dot(const cv::Mat1f& picture, const Ellipse& start) {
  const cv::Rect box = box_of(start, kReach), whole(0, 0, picture.cols, picture.rows);
  if ((box & whole) != box) return std::nullopt;
  const std::vector<cv::Point> pixels = pixels_around(start, box);
  if (pixels.empty()) return std::nullopt;
  const auto fit = fit_edge<5>(picture, pixels, start_of(picture, start, pixels), EllipseShare{});
  if (!fit) return std::nullopt;
  Ellipse dot{fit->shape.head<2>(), Eigen::Matrix2d::Identity()};
  dot.to_circle << fit->shape[2], fit->shape[3], fit->shape[3], fit->shape[4];
  if (dot.to_circle.determinant() <= 0 || dot.to_circle.trace() <= 0) return std::nullopt;
  if ((start.to_circle * (dot.centre - start.centre)).norm() > 0.5) return std::nullopt;
  const double growth = std::sqrt(start.to_circle.determinant() / dot.to_circle.determinant());
  if (growth < 0.5 || growth > 2) return std::nullopt;
  return DotFit{
      dot, fit->covariance.topLeftCorner<2, 2>(), fit->outside, fit->inside, fit->blur, fit->noise};
}

}  // namespace axial::targets
