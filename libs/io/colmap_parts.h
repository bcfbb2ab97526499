// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the pieces that COLMAP's text and binary readers share.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/colmap.h"

namespace axial::io {

// COLMAP's own files, and those of COLMAP-Underwater, whose cameras may have ports.
enum class Dialect { colmap, underwater };

// Name of a camera model by its number in binary files; empty if unknown. Number 11 is another
// model in each dialect.
std::string_view colmap_model_name(int id, Dialect dialect);
// The number by name; -1 for a model that the dialect does not have.
int colmap_model_id(std::string_view name, Dialect dialect);

// Quaternion w, x, y, z and translation, of camera from world.
using ColmapPose = std::array<double, 7>;

// Error, starting with `where`, for values that are not finite or a zero quaternion.
Pose pose_from_colmap(const ColmapPose& values, const std::string& where);
ColmapPose pose_to_colmap(const Pose& pose);

// Error, starting with `where`, for a size, a focal length or any parameter that no camera has.
void check_colmap_camera(const ColmapCamera& camera, const std::string& where);

std::vector<ColmapCamera> read_cameras_text(const std::filesystem::path& path);
std::vector<ColmapImage> read_images_text(const std::filesystem::path& path);
std::vector<ColmapPoint3D> read_points_text(const std::filesystem::path& path);
std::vector<ColmapCamera> read_cameras_binary(const std::filesystem::path& path);
std::vector<ColmapImage> read_images_binary(const std::filesystem::path& path);
std::vector<ColmapPoint3D> read_points_binary(const std::filesystem::path& path);

}  // namespace axial::io
