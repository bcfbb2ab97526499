// SPDX-License-Identifier: GPL-3.0-or-later
// COLMAP sparse models, text and binary, as COLMAP 3.8 to 4.1 write them (see docs/formats.md).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "refractive/port.h"
#include "scene/pose.h"
#include "scene/scene.h"

namespace axial::io {

inline constexpr std::uint64_t kNoPoint3D = ~std::uint64_t{0};

struct ColmapCamera {
  std::uint32_t id = 0;
  std::string model;  // "PINHOLE", "OPENCV", ...
  std::uint64_t width = 0, height = 0;
  std::vector<double> params;  // pixel centres at 0.5, as in the file
  // COLMAP-Underwater's files carry a port with the camera; `params` are then the lens in air.
  std::optional<refractive::Port<double>> port = std::nullopt;
};

struct ColmapPoint2D {
  double x = 0, y = 0;  // pixel centres at 0.5
  std::uint64_t point3d = kNoPoint3D;
};

struct ColmapImage {
  std::uint32_t id = 0;
  std::uint32_t camera = 0;
  std::string name;
  Pose pose;
  std::vector<ColmapPoint2D> points;
};

struct ColmapTrackElement {
  std::uint32_t image = 0;
  std::uint32_t point2d = 0;
};

struct ColmapPoint3D {
  std::uint64_t id = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Rgb color{};
  double error = 0;
  std::vector<ColmapTrackElement> track;
};

struct ColmapModel {
  std::vector<ColmapCamera> cameras;  // file order, unique ids
  std::vector<ColmapImage> images;
  std::vector<ColmapPoint3D> points;
};

// The folder that holds the model: DIR/sparse, DIR/sparse/0 or DIR itself, the first with a whole
// model, or else with a cameras file. A line names other models there. Error listing the places
// looked in.
std::filesystem::path find_colmap_model(const std::filesystem::path& folder);

// Reads cameras, images and points3D, COLMAP's and COLMAP-Underwater's: binary cameras of the two
// differ in length. As in COLMAP the folder's binary model is read if it is whole, else its text
// model; a warning names the files of the other form that differ. All of COLMAP's camera models are
// parsed; Error for an unknown model, a wrong number of parameters, a NaN, a reference to a camera,
// image or point that does not exist, two images of one name, a truncated file, a folder without a
// whole model.
ColmapModel read_colmap_model(const std::filesystem::path& folder);

// The cameras alone: of a model's folder, or a file cameras.txt or cameras.bin by any name with
// that extension, or Calibmar's, with its port (calibmar.h).
std::vector<ColmapCamera> read_colmap_cameras(const std::filesystem::path& path);

// Error if `folder` holds a whole binary model: readers would take it before a text model there.
void require_no_binary_model(const std::filesystem::path& folder);

// For COLMAP: ports are left out, which its readers cannot read. Error if a text model would go
// into a folder that holds a binary one, which readers take first.
void write_colmap_text(const std::filesystem::path& folder, const ColmapModel& model);
void write_colmap_binary(const std::filesystem::path& folder, const ColmapModel& model);

// For COLMAP-Underwater: cameras with their ports. Error for a camera whose model it lacks.
void write_underwater_text(const std::filesystem::path& folder, const ColmapModel& model);
void write_underwater_binary(const std::filesystem::path& folder, const ColmapModel& model);

// How many of a camera model's parameters, the first ones, are focal lengths; -1 if unknown.
int colmap_focal_count(std::string_view model);

// Number of parameters of a camera model by name; -1 if unknown.
int colmap_parameter_count(std::string_view model);

}  // namespace axial::io
