// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: functions that the text and the binary readers of COLMAP models share.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/colmap/colmap.h"
#include "private/only_for_io.h"

namespace axial::io {

// The program whose files are read or written: COLMAP, or COLMAP-Underwater, whose cameras may have
// ports.
enum class Dialect { colmap, underwater };

// Returns the name of the camera model that has the number `id` in binary files; empty if the
// number is unknown. The number 11 stands for a different model in each dialect.
std::string_view colmap_model_name(int id, Dialect dialect);
// Returns the number of the camera model `name` in binary files; -1 if the dialect does not have
// the model.
int colmap_model_id(std::string_view name, Dialect dialect);

// Quaternion (w, x, y, z) and translation of the transformation from world to camera.
using ColmapPose = std::array<double, 7>;

// Convert a pose from and to this form. Quaternions that are read are normalised. Reading gives an
// Error that starts with `where` for values that are not finite, a quaternion of (almost) zero
// length, or a translation whose camera centre is not finite.
Pose pose_from_colmap(const ColmapPose& values, const std::string& where);
ColmapPose pose_to_colmap(const Pose& pose);

// Error that starts with `where` for an image size outside 1 to 1,000,000, an unknown model, a
// wrong number of parameters, a focal length that is not positive, or a parameter that is not
// finite.
void check_colmap_camera(const ColmapCamera& camera, const std::string& where);

// Read one part of a model from a file. Error that names the file and the record for malformed or
// truncated data. References between the parts are not checked.
std::vector<ColmapCamera> read_cameras_text(const std::filesystem::path& path);
std::vector<ColmapImage> read_images_text(const std::filesystem::path& path);
std::vector<ColmapPoint3D> read_points_text(const std::filesystem::path& path);
std::vector<ColmapCamera> read_cameras_binary(const std::filesystem::path& path);
std::vector<ColmapImage> read_images_binary(const std::filesystem::path& path);
std::vector<ColmapPoint3D> read_points_binary(const std::filesystem::path& path);

}  // namespace axial::io
