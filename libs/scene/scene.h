// SPDX-License-Identifier: GPL-3.0-or-later
// A scene as plain data: calibrated images and a sparse cloud. Lengths are in the unit of the
// poses: metres if a camera is behind the port of a housing.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera_model.h"
#include "scene/pose.h"

namespace axial {

inline constexpr std::uint32_t kNoId = 0xFFFFFFFFu;  // SceneImage::id of an image without an id

// How suitable another image (the neighbour) is as a source view of this image. The fields are
// those of ViewScore in the OpenMVS scene format. score_neighbours() (view_selection.h) defines
// scale, area and score.
struct ViewScore {
  std::uint32_t image = 0;   // index into Scene::images
  std::uint32_t points = 0;  // number of sparse points that both images see
  float scale = 1;           // mean of (footprint in this image / footprint in the neighbour)
  float angle = 0;           // mean triangulation angle [rad]
  float area = 0;            // fraction of this image that the shared points cover
  float score = 0;           // higher is better
};

struct SceneImage {
  std::string path;          // of the photograph; absolute or relative to the working folder
  std::string mask_path;     // empty: no mask
  std::uint32_t id = kNoId;  // global id; the name of the depth map file contains it
  bool calibrated = true;    // false: camera and pose are invalid, skip the image
  CameraModel camera;        // at the resolution that the scene file records
  std::string port_name;     // name of camera.port in the housing file; empty: no port
  Pose pose;
  float min_depth = 0, average_depth = 0, max_depth = 0;  // z-depths of sparse points
  std::vector<ViewScore> neighbours;                      // by decreasing score
};

// An observation of a sparse point by one image.
struct SparseView {
  std::uint32_t image = 0;  // index into Scene::images
  float confidence = 0;     // higher is better; 0: not available
};

struct SparsePoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  // world
  std::vector<SparseView> views;  // sorted by image; repeated images are tolerated
};

// A box: the points X with |rotation * (X - centre)| <= half_extent in each component.
struct OrientedBox {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // rows: the box axes in the world
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();        // world
  Eigen::Vector3d half_extent = Eigen::Vector3d::Zero();   // along the box axes

  // True if the point x [world] lies inside the box or on its surface. False for NaN.
  bool contains(const Eigen::Vector3d& x) const {
    return ((rotation * (x - centre)).cwiseAbs().array() <= half_extent.array()).all();
  }
};

using Rgb = std::array<std::uint8_t, 3>;  // red, green, blue

struct Scene {
  std::vector<SceneImage> images;
  std::vector<SparsePoint> points;
  std::vector<Eigen::Vector3f> point_normals;  // empty or one per point: unit, world
  std::vector<Rgb> point_colors;               // empty or one per point
  std::optional<OrientedBox> region;           // region of interest
};

}  // namespace axial
