// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "colmap/private/colmap_parts.h"

namespace axial::io {
namespace {

struct Model {
  int id;  // in binary files; -1: text files only
  std::string_view name;
  int parameters;
  int focal_lengths;  // the first parameters that must be positive
};

constexpr std::array<Model, 19> kModels{{
    {0, "SIMPLE_PINHOLE", 3, 1},
    {1, "PINHOLE", 4, 2},
    {2, "SIMPLE_RADIAL", 4, 1},
    {3, "RADIAL", 5, 1},
    {4, "OPENCV", 8, 2},
    {5, "OPENCV_FISHEYE", 8, 2},
    {6, "FULL_OPENCV", 12, 2},
    {7, "FOV", 5, 2},
    {8, "SIMPLE_RADIAL_FISHEYE", 4, 1},
    {9, "RADIAL_FISHEYE", 5, 1},
    {10, "THIN_PRISM_FISHEYE", 12, 2},
    {11, "RAD_TAN_THIN_PRISM_FISHEYE", 16, 2},
    {12, "SIMPLE_DIVISION", 4, 1},
    {13, "DIVISION", 5, 2},
    {14, "SIMPLE_FISHEYE", 3, 1},
    {15, "FISHEYE", 4, 2},
    {16, "EUCM", 6, 2},
    {17, "EQUIRECTANGULAR", 2, 2},
    // COLMAP-Underwater's own model: number 11, the last one, in its binary files.
    {-1, "METASHAPE_FISHEYE", 10, 2},
}};
constexpr int kSharedId = 11;
constexpr std::string_view kUnderwaterModel = "METASHAPE_FISHEYE";

const Model* find_model(std::string_view name) {
  const auto found = std::ranges::find(kModels, name, &Model::name);
  return found == kModels.end() ? nullptr : &*found;
}

Eigen::Matrix3d rotation_from(double w, double x, double y, double z) {
  Eigen::Matrix3d r;
  r << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  return r;
}

}  // namespace

std::string_view colmap_model_name(int id, Dialect dialect) {
  if (dialect == Dialect::underwater && id >= kSharedId)
    return id == kSharedId ? kUnderwaterModel : std::string_view();
  const auto found = std::ranges::find(kModels, id, &Model::id);
  return id < 0 || found == kModels.end() ? std::string_view() : found->name;
}

int colmap_model_id(std::string_view name, Dialect dialect) {
  const Model* model = find_model(name);
  if (!model) return -1;
  if (dialect == Dialect::colmap) return model->id;
  if (name == kUnderwaterModel) return kSharedId;
  return model->id < kSharedId ? model->id : -1;
}

int colmap_parameter_count(std::string_view name) {
  const Model* model = find_model(name);
  return model ? model->parameters : -1;
}

int colmap_focal_count(std::string_view name) {
  const Model* model = find_model(name);
  return model ? model->focal_lengths : -1;
}

Pose pose_from_colmap(const ColmapPose& values, const std::string& where) {
  for (const double value : values)
    if (!std::isfinite(value)) fail_in(where, "the pose contains {}", value);
  const Eigen::Vector4d q = Eigen::Vector4d(values[0], values[1], values[2], values[3]);
  const double norm = q.stableNorm();
  if (!(norm > 1e-6) || !std::isfinite(norm))
    fail_in(where, "the quaternion {} {} {} {} is not a rotation", q[0], q[1], q[2], q[3]);
  const Eigen::Vector4d unit = q / norm;
  Pose pose;
  pose.rotation = rotation_from(unit[0], unit[1], unit[2], unit[3]);
  pose.centre = -pose.rotation.transpose() * Eigen::Vector3d(values[4], values[5], values[6]);
  if (!pose.centre.allFinite())
    fail_in(where, "the translation {} {} {} is too long", values[4], values[5], values[6]);
  return pose;
}

ColmapPose pose_to_colmap(const Pose& pose) {
  const Eigen::Matrix3d& r = pose.rotation;
  // The largest component is computed with a square root, the others by dividing by it. This avoids
  // cancellation near half turns. The array holds 4 q_i^2 for w, x, y, z:
  const std::array<double, 4> squares{
      1 + r(0, 0) + r(1, 1) + r(2, 2), 1 + r(0, 0) - r(1, 1) - r(2, 2),
      1 - r(0, 0) + r(1, 1) - r(2, 2), 1 - r(0, 0) - r(1, 1) + r(2, 2)};
  const auto largest =
      static_cast<std::size_t>(std::distance(squares.begin(), std::ranges::max_element(squares)));
  const double twice = std::sqrt(squares[largest]);
  // products[i][j] = 4 q_i q_j for i != j
  const double wx = r(2, 1) - r(1, 2), wy = r(0, 2) - r(2, 0), wz = r(1, 0) - r(0, 1);
  const double xy = r(0, 1) + r(1, 0), xz = r(0, 2) + r(2, 0), yz = r(1, 2) + r(2, 1);
  const std::array<std::array<double, 4>, 4> products{{{squares[0], wx, wy, wz},
                                                       {wx, squares[1], xy, xz},
                                                       {wy, xy, squares[2], yz},
                                                       {wz, xz, yz, squares[3]}}};
  ColmapPose values{};
  const double sign = products[largest][0] < 0 ? -1 : 1;  // w >= 0
  for (std::size_t i = 0; i < 4; ++i) values[i] = sign * products[largest][i] / (2 * twice);
  const Eigen::Vector3d t = -r * pose.centre;
  for (std::size_t i = 0; i < 3; ++i) values[4 + i] = t[static_cast<Eigen::Index>(i)];
  return values;
}

void check_colmap_camera(const ColmapCamera& camera, const std::string& where) {
  constexpr std::uint64_t kLargestSide = 1'000'000;
  if (camera.width < 1 || camera.width > kLargestSide)
    fail_in(where, "camera {} has width {}", camera.id, camera.width);
  if (camera.height < 1 || camera.height > kLargestSide)
    fail_in(where, "camera {} has height {}", camera.id, camera.height);
  const Model* model = find_model(camera.model);
  if (!model) fail_in(where, "camera {} has the unknown model '{}'", camera.id, camera.model);
  const auto expected = static_cast<std::size_t>(model->parameters);
  if (camera.params.size() != expected)
    fail_in(where, "camera {} ({}) has {} parameters, expected {}", camera.id, camera.model,
            camera.params.size(), expected);
  for (std::size_t i = 0; i < expected; ++i) {
    const bool focal = i < static_cast<std::size_t>(model->focal_lengths);
    if (!std::isfinite(camera.params[i]) || (focal && !(camera.params[i] > 0)))
      fail_in(where, "camera {} ({}): parameter {} is {}", camera.id, camera.model, i,
              camera.params[i]);
  }
}

}  // namespace axial::io
