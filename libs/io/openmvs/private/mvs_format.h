// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the records of the .mvs interchange format, without interpretation
// (docs/formats.md).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bytes/private/only_for_io.h"
#include "scene/scene.h"

namespace axial::io {

inline constexpr std::uint32_t kMvsVersion = 7;  // the newest version read; the version written

// Sizes in the file [bytes]. A string or a list starts with its length.
namespace mvs_bytes {
inline constexpr std::size_t kLength = 8, kVector3f = 3 * 4, kColor = 3;
inline constexpr std::size_t kPose = 12 * 8;      // rotation and centre
inline constexpr std::size_t kView = 4 + 4;       // of a point: image and confidence
inline constexpr std::size_t kViewScore = 6 * 4;  // of an image
}  // namespace mvs_bytes

struct MvsPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
};

struct MvsCamera {
  std::uint32_t width = 0, height = 0;  // both 0: `k` is normalised
  Eigen::Matrix3d k = Eigen::Matrix3d::Identity();
  MvsPose on_platform;
};

struct MvsPlatform {
  std::vector<MvsCamera> cameras;
  std::vector<MvsPose> poses;
};

struct MvsImage {
  std::string name, mask_name;
  std::uint32_t platform = kNoId, camera = kNoId, pose = kNoId;
  std::uint32_t id = kNoId;
  float min_depth = 0, average_depth = 0, max_depth = 0;
  std::vector<ViewScore> view_scores;
};

struct MvsBox {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d min = Eigen::Vector3d::Zero();
  Eigen::Vector3d max = Eigen::Vector3d::Zero();
};

// The contents of a file, without the lists of lines and the transform, which neither AxialMVS nor
// OpenMVS 2.3 uses.
struct MvsFile {
  std::vector<MvsPlatform> platforms;
  std::vector<MvsImage> images;
  std::vector<SparsePoint> points;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Rgb> colors;
  MvsBox box;
};

// Parses the bytes of a file. Error that names `file` for a native project, an unknown version, or
// too few or too many bytes.
MvsFile parse_mvs(std::string_view bytes, const std::string& file);

// Returns the bytes of a file of version 7. `room`: the expected number of bytes. With more bytes,
// the memory grows while the bytes are collected.
std::string format_mvs(const MvsFile& mvs, std::size_t room = 0);

}  // namespace axial::io
