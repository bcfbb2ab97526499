// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "base/order_statistics.h"
#include "evaluate/statistics.h"
#include "geometry/sampling.h"
#include "scene/decompositions.h"

namespace axial::evaluate {
namespace {

const cv::Scalar kInk(30, 30, 30);
const cv::Vec3b kNothing(60, 60, 60);

cv::Mat3b color_table(int map) {
  cv::Mat1b levels(1, 256);
  for (int i = 0; i < 256; ++i) levels(0, i) = static_cast<std::uint8_t>(i);
  cv::Mat3b table;
  cv::applyColorMap(levels, table, map);
  return table;
}

int level(double value, double low, double high) {
  const double part = high > low ? (value - low) / (high - low) : 0.0;
  return static_cast<int>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
}

cv::Mat3b colored(const cv::Mat1f& values, double low, double high, const cv::Mat3b& table) {
  cv::Mat3b picture(values.size(), kNothing);
  for (int v = 0; v < values.rows; ++v)
    for (int u = 0; u < values.cols; ++u)
      if (const float value = values(v, u); std::isfinite(value) && value != 0)
        picture(v, u) = table(0, level(static_cast<double>(value), low, high));
  return picture;
}

void write_text(cv::Mat3b& picture, const std::string& text, cv::Point at, double size) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

cv::Mat3b panel(const cv::Mat3b& picture, const std::string& caption, int width) {
  cv::Mat3b fitted = picture;
  if (picture.cols > width)
    cv::resize(picture, fitted, {width, std::max(1, picture.rows * width / picture.cols)}, 0, 0,
               cv::INTER_NEAREST);
  cv::Mat3b framed;
  cv::copyMakeBorder(fitted, framed, 28, 4, 4, 4, cv::BORDER_CONSTANT, cv::Scalar::all(255));
  write_text(framed, caption, {6, 19}, 0.45);
  return framed;
}

// Projects all points. x and y are pixels; z is the depth by which points hide each other.
std::vector<Eigen::Vector3f> project_all(std::span<const Eigen::Vector3f> positions,
                                         const Viewpoint& view) {
  std::vector<Eigen::Vector3f> images;
  images.reserve(positions.size());
  for (const Eigen::Vector3f& position : positions) {
    const Eigen::Vector3d x = view.pose.to_camera(position.cast<double>());
    const double w = view.orthographic ? 1.0 : x.z();
    const bool behind = !view.orthographic && !(x.z() > 1e-6);
    const double u = behind ? -1e6 : view.focal_x * x.x() / w + view.centre_x;
    const double v = behind ? -1e6 : view.focal_y * x.y() / w + view.centre_y;
    images.emplace_back(static_cast<float>(std::clamp(u, -1e6, 1e6)),
                        static_cast<float>(std::clamp(v, -1e6, 1e6)), static_cast<float>(x.z()));
  }
  return images;
}

int splat_side(std::span<const Eigen::Vector3f> images, const Viewpoint& view) {
  const auto inside = std::count_if(images.begin(), images.end(), [&](const Eigen::Vector3f& p) {
    return p.x() >= 0 && p.y() >= 0 && p.x() < static_cast<float>(view.width) &&
           p.y() < static_cast<float>(view.height);
  });
  const double area = static_cast<double>(view.width) * view.height;
  const double spacing = std::sqrt(area / static_cast<double>(inside + 1));
  return std::clamp(static_cast<int>(std::lround(1.5 * spacing)), 2, 7);
}

std::pair<double, double> inner_range(std::vector<float> values, double percent) {
  std::sort(values.begin(), values.end());
  return {interpolated_quantile<float>(values, percent / 100),
          interpolated_quantile<float>(values, (100 - percent) / 100)};
}

}  // namespace

std::vector<Rgb> error_colors(std::span<const float> errors, double upper) {
  const cv::Mat3b table = color_table(cv::COLORMAP_TURBO);
  std::vector<Rgb> colors(errors.size(), Rgb{0, 0, 0});
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!std::isfinite(errors[i])) continue;
    const cv::Vec3b& bgr = table(0, level(static_cast<double>(errors[i]), 0, upper));
    colors[i] = {bgr[2], bgr[1], bgr[0]};
  }
  return colors;
}

Rgb error_color(float error, double upper) {
  return error_colors(std::span(&error, 1), upper)[0];
}

Viewpoint viewpoint_of(const View& view, int width) {
  const int height =
      std::max(1, static_cast<int>(std::lround(static_cast<double>(width) * view.camera.height /
                                               view.camera.width)));
  const auto lens = view.camera.resized(width, height).lens;
  return {view.pose, width, height, lens.fx, lens.fy, lens.cx, lens.cy, false};
}

Viewpoint principal_viewpoint(std::span<const Eigen::Vector3f> positions,
                              std::span<const Eigen::Vector3f> normals, int width, int height) {
  const auto sampled = geometry::subsample(positions, 50000, 1);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& x : sampled) centre += x.cast<double>();
  centre /= static_cast<double>(std::max<std::size_t>(sampled.size(), 1));
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& x : sampled) {
    const Eigen::Vector3d d = x.cast<double>() - centre;
    spread += d * d.transpose();
  }
  const SymmetricEigen3 axes(spread);
  Eigen::Vector3d forward = axes.eigenvectors().col(0);
  Eigen::Vector3d mean_normal = Eigen::Vector3d::Zero();
  for (const auto& n : normals) mean_normal += n.cast<double>();
  if (forward.dot(mean_normal) > 0) forward = -forward;

  Viewpoint view{Pose{}, width, height, 0, 0, (width - 1) / 2.0, (height - 1) / 2.0, true};
  view.pose.rotation.row(2) = forward;
  view.pose.rotation.row(0) = axes.eigenvectors().col(2);
  view.pose.rotation.row(1) = forward.cross(Eigen::Vector3d(axes.eigenvectors().col(2)));
  std::vector<float> xs, ys;
  for (const auto& x : sampled) {
    const Eigen::Vector3d camera = view.pose.rotation * (x.cast<double>() - centre);
    xs.push_back(static_cast<float>(camera.x()));
    ys.push_back(static_cast<float>(camera.y()));
  }
  const auto [left, right] = inner_range(std::move(xs), 1);
  const auto [top, bottom] = inner_range(std::move(ys), 1);
  const double extent_x = std::max(right - left, 1e-9), extent_y = std::max(bottom - top, 1e-9);
  view.focal_x = view.focal_y = 0.95 * std::min(width / extent_x, height / extent_y);
  view.pose.centre = centre + view.pose.rotation.transpose() *
                                  Eigen::Vector3d((left + right) / 2, (top + bottom) / 2, 0);
  return view;
}

cv::Mat3b draw_cloud(std::span<const Eigen::Vector3f> positions, std::span<const Rgb> colors,
                     const Viewpoint& view) {
  cv::Mat3b picture(view.height, view.width, cv::Vec3b(255, 255, 255));
  cv::Mat1f nearest(picture.size(), std::numeric_limits<float>::infinity());
  const auto images = project_all(positions, view);
  const int side = splat_side(images, view);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const int u0 =
        static_cast<int>(std::floor(images[i].x() - static_cast<float>(side - 1) / 2 + 0.5f));
    const int v0 =
        static_cast<int>(std::floor(images[i].y() - static_cast<float>(side - 1) / 2 + 0.5f));
    const cv::Rect square = cv::Rect(u0, v0, side, side) & cv::Rect(0, 0, view.width, view.height);
    for (int v = square.y; v < square.y + square.height; ++v)
      for (int u = square.x; u < square.x + square.width; ++u)
        if (images[i].z() < nearest(v, u)) {
          nearest(v, u) = images[i].z();
          picture(v, u) = {colors[i][2], colors[i][1], colors[i][0]};
        }
  }
  return picture;
}

cv::Mat3b with_error_scale(const cv::Mat3b& picture, double upper) {
  constexpr int kHeight = 44;
  cv::Mat3b result(picture.rows + kHeight, picture.cols, cv::Vec3b(255, 255, 255));
  picture.copyTo(result(cv::Rect(0, 0, picture.cols, picture.rows)));
  const cv::Mat3b table = color_table(cv::COLORMAP_TURBO);
  const int left = 20, right = std::max(left + 1, picture.cols - 60);
  for (int u = left; u < right && u < picture.cols; ++u)
    result(cv::Rect(u, picture.rows + 6, 1, 14))
        .setTo(cv::Scalar(table(0, level(u, left, right - 1))));
  for (int tick = 0; tick <= 4; ++tick) {
    const double value = upper * tick / 4;
    const std::string text = fmt::format("{:.3g}{}", value * 1e3, tick == 4 ? " mm+" : "");
    write_text(result, text, {left + (right - left) * tick / 4 - 4, picture.rows + 36}, 0.42);
  }
  return result;
}

cv::Mat3b draw_depth_comparison(const cv::Mat1f& estimate, const DepthEvaluation& evaluation,
                                double upper, int panel_width) {
  std::vector<float> depths;
  for (const float depth : evaluation.truth)
    if (depth > 0) depths.push_back(depth);
  const auto [near, far] = inner_range(std::move(depths), 2);
  const cv::Mat3b depth_table = color_table(cv::COLORMAP_VIRIDIS);
  cv::Mat1f shown = evaluation.error.clone();
  // A pixel with error 0 is a result. Only missing pixels (NaN) stay grey.
  for (float& value : shown) value = std::max(std::abs(value), std::numeric_limits<float>::min());
  const std::array<cv::Mat3b, 3> panels{
      panel(colored(estimate, near, far, depth_table),
            fmt::format("estimate, {:.3g} (blue) to {:.3g} m (yellow)", near, far), panel_width),
      panel(colored(evaluation.truth, near, far, depth_table), "truth", panel_width),
      panel(colored(shown, 0, upper, color_table(cv::COLORMAP_TURBO)),
            fmt::format("error, 0 (blue) to {:.3g} mm (red)", upper * 1e3), panel_width)};
  cv::Mat3b row;
  cv::hconcat(panels.data(), panels.size(), row);
  return row;
}

}  // namespace axial::evaluate
