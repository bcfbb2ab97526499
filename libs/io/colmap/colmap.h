// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and writes COLMAP sparse models in text and binary form. The formats are those of COLMAP
// 3.8 to 4.1 (docs/formats.md).
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
  // Only the files of COLMAP-Underwater and Calibmar contain ports. If there is a port, `params`
  // describes the lens in air.
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

// Returns the folder that holds the model of `folder`. The candidates are `folder`/sparse,
// `folder`/sparse/0 and `folder`, in this order. The result is the first candidate with a complete
// model, or if no model is complete, the first candidate with a cameras file. The log names other
// complete models. Error that lists the candidates if no candidate has a cameras file.
std::filesystem::path find_colmap_model(const std::filesystem::path& folder);

// Reads the cameras, images and points3D of COLMAP or COLMAP-Underwater. A binary cameras file does
// not state which of the two programs wrote it. The program is determined from the length of the
// file. As in COLMAP, the binary model in the folder is read if it is complete, otherwise the text
// model. If the folder also holds files in the other form, a warning names those whose contents
// differ from the model that is read. All camera models of COLMAP are accepted.
//
// Error for an unknown camera model, a wrong number of parameters, a value that is not finite, a
// reference to a camera, image or point that does not exist, an id that occurs twice, two images
// with the same name, a truncated file, or a folder without a complete model.
ColmapModel read_colmap_model(const std::filesystem::path& folder);

// Reads only the cameras. `path` is the folder of a model, a text file or a .bin file with COLMAP's
// cameras, or a file of Calibmar with its port (calibmar.h). Errors as for read_colmap_model.
std::vector<ColmapCamera> read_colmap_cameras(const std::filesystem::path& path);

// Error if `folder` holds a complete binary model, because readers would read the binary model
// instead of a text model in the same folder.
void require_no_binary_model(const std::filesystem::path& folder);

// Write a model for COLMAP. Ports are left out because COLMAP cannot read them. The text writer
// gives an Error if the folder holds a complete binary model (require_no_binary_model). Both
// writers give an Error for an image name that the format cannot hold.
void write_colmap_text(const std::filesystem::path& folder, const ColmapModel& model);
void write_colmap_binary(const std::filesystem::path& folder, const ColmapModel& model);

// Write a model for COLMAP-Underwater, with the ports of the cameras. Errors as for the writers
// above. The binary writer also gives an Error for a camera model that COLMAP-Underwater does not
// have.
void write_underwater_text(const std::filesystem::path& folder, const ColmapModel& model);
void write_underwater_binary(const std::filesystem::path& folder, const ColmapModel& model);

// The number of focal lengths among the parameters of a camera model; the focal lengths come first.
// -1 if the model is unknown.
int colmap_focal_count(std::string_view model);

// The number of parameters of a camera model; -1 if the model is unknown.
int colmap_parameter_count(std::string_view model);

}  // namespace axial::io
