// SPDX-License-Identifier: GPL-3.0-or-later
// A scene as plain data: calibrated images and a sparse cloud; and dense clouds and meshes. Lengths
// are in the unit of the poses: metres if a camera is behind the port of a housing. "World" is the
// frame of the poses.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "refractive/lens_distortion.h"
#include "refractive/pinhole_camera.h"
#include "refractive/port.h"

namespace axial {

// The pose of a camera in the world: x_in_camera = rotation * (x_in_world - centre). Camera axes: x
// right, y down, z forward. Both frames have one unit: metres if a camera is behind the port of a
// housing.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // from the world to the camera
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();        // camera centre in the world

  // Convert a point between the frames of the world and of the camera.
  Eigen::Vector3d to_camera(const Eigen::Vector3d& x_in_world) const {
    return rotation * (x_in_world - centre);
  }
  Eigen::Vector3d to_world(const Eigen::Vector3d& x_in_camera) const {
    return rotation.transpose() * x_in_camera + centre;
  }
};

// The lens in air, its distortion and the port. The unit of the lens is the pixel of an image of
// width x height pixels, with pixel centres at integers.
struct CameraModel {
  int width = 0;                                     // [px]
  int height = 0;                                    // [px]
  refractive::PinholeLens<double> lens{0, 0, 0, 0};  // the lens without its distortion
  std::optional<refractive::Port<double>> port;      // empty: no port
  std::optional<refractive::LensDistortion<double>> distortion = {};  // empty: no distortion

  // The camera for the image resized to new_width x new_height pixels. Each axis of the lens is
  // scaled by its own factor. The corner of the image at (-0.5, -0.5) stays fixed. Distortion and
  // port do not change. Precondition: width and height are not 0.
  CameraModel resized(int new_width, int new_height) const;
};

// A frame whose axes are parallel to those of the world: world = local + origin. With a zero origin
// the frame is the world.
struct LocalFrame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // [world]

  bool is_world() const { return origin.isZero(0); }
  Eigen::Vector3d to_local(const Eigen::Vector3d& world) const { return world - origin; }
  Eigen::Vector3d to_world(const Eigen::Vector3d& local) const { return local + origin; }
};

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

// A dense point cloud. An array is empty or as long as `positions`, unless the comment on the array
// says otherwise. The views of all points are stored in one array: the views of point i have the
// indices [view_begin[i], view_begin[i + 1]).
struct PointCloud {
  std::vector<Eigen::Vector3f> positions;  // world frame
  std::vector<Eigen::Vector3f> normals;    // world frame, unit
  std::vector<Rgb> colors;
  std::vector<std::size_t> view_begin;     // empty, or size() + 1 entries
  std::vector<std::uint32_t> view_images;  // indices into Scene::images
  std::vector<float> view_weights;         // empty, or one per entry of view_images
  std::vector<float> errors;               // expected distance to the true surface [m]; 0: unknown
  std::vector<float> confidences;          // probability that the distance is at most 3 * error

  std::size_t size() const { return positions.size(); }
  // The images that see point i. Precondition: view_begin is not empty.
  std::span<const std::uint32_t> views_of(std::size_t i) const {
    return std::span(view_images).subspan(view_begin[i], view_begin[i + 1] - view_begin[i]);
  }
};

// The sparse points of `scene` as a cloud, in the order of Scene::points, with their views, and
// with normals and colours if `scene` has them. The weight of a view is its SparseView::confidence.
// `errors` and `confidences` are empty.
PointCloud cloud_of(const Scene& scene);

// A triangle mesh in the frame and unit of the scene. Seen from outside, the corners of a face are
// in counter-clockwise order. check_mesh() tests the rules below.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;            // finite
  std::vector<Rgb> colors;                          // empty or one per vertex
  std::vector<std::array<std::uint32_t, 3>> faces;  // indices into `vertices`
  // Marks of the faces, empty or one per face: 1 if the place of the face was not seen by two
  // cameras, so that the face only closes a gap (mesh/unseen.h); otherwise 0.
  std::vector<std::uint8_t> unseen{};
};

}  // namespace axial
