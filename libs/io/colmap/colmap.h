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

#include "axial/base.h"
#include "axial/scene.h"
#include "refractive/port.h"
#include "scene/scene.h"

namespace axial::io {

// The value of ColmapPoint2D::point3d for an observation that belongs to no 3D point.
inline constexpr std::uint64_t kNoPoint3D = ~std::uint64_t{0};

// A camera: a lens in air, and in some files its port.
struct ColmapCamera {
  std::uint32_t id = 0;
  std::string model;                    // "PINHOLE", "OPENCV", ...
  std::uint64_t width = 0, height = 0;  // of its images [px]
  std::vector<double> params;  // in the order of the model; pixel centres at 0.5, as in the file
  // In metres and the camera frame; empty: no port. Only the files of COLMAP-Underwater and
  // Calibmar contain ports. If there is a port, `params` describes the lens in air.
  std::optional<refractive::Port<double>> port = std::nullopt;
  // Standard deviation of the focal lengths, divided by the focal length; empty: not stated. Only
  // text files state it, in a comment (docs/formats.md).
  std::optional<double> focal_sigma = std::nullopt;
};

// An observation: an image point, and the 3D point that it shows.
struct ColmapPoint2D {
  double x = 0, y = 0;                 // [px], pixel centres at 0.5
  std::uint64_t point3d = kNoPoint3D;  // id of a 3D point of the model
  float size = 0;                      // scale of the feature [px]; 0: not known, as in all models
};

// An image that COLMAP has registered.
struct ColmapImage {
  std::uint32_t id = 0;
  std::uint32_t camera = 0;           // id of its camera
  std::string name;                   // path relative to the image folder
  Pose pose;                          // world frame of the model, in the unit of the model
  std::vector<ColmapPoint2D> points;  // all image points, in the order of the file
};

// An observation of a 3D point.
struct ColmapTrackElement {
  std::uint32_t image = 0;    // id of the image
  std::uint32_t point2d = 0;  // index into ColmapImage::points
};

// A sparse point with its observations.
struct ColmapPoint3D {
  std::uint64_t id = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // in the frame of the poses
  Rgb color{};
  double error = 0;  // mean reprojection error [px], as the file states it
  std::vector<ColmapTrackElement> track;
};

// A sparse model. Cameras, images and points have the order of the files. Ids are unique within
// each list.
struct ColmapModel {
  std::vector<ColmapCamera> cameras;
  std::vector<ColmapImage> images;
  std::vector<ColmapPoint3D> points;
};

// Returns the folder that holds the model of `folder`. The candidates are `folder`/sparse,
// `folder`/sparse/0 and `folder`, in this order. The result is the first candidate with a complete
// model (cameras, images and points3D, all .bin or all .txt), or if no model is complete, the first
// candidate with a cameras file. A line of `context` names other complete models. Error that lists
// the candidates if no candidate has a cameras file.
std::filesystem::path find_colmap_model(const std::filesystem::path& folder,
                                        const Context& context = {});

// Reads the cameras, images and points3D of COLMAP or COLMAP-Underwater. A binary cameras file does
// not state which of the two programs wrote it. It is read as a file of COLMAP, and if this fails,
// as a file of COLMAP-Underwater. As in COLMAP, the binary model in the folder is read if it is
// complete, otherwise the text model. If the folder also holds files in the other form, a warning
// names those whose contents differ from the model that is read. All camera models of COLMAP are
// accepted, and METASHAPE_FISHEYE of COLMAP-Underwater. Unusual values of ports give warnings
// (PortValues in housing.h). Warnings go through `context`.
//
// Error that names the file or the folder for an unknown camera model, a wrong number of
// parameters, a value that is not finite, a reference to a camera, image or point that does not
// exist, an id that occurs twice, two images with the same name, a focal_sigma that is not possible
// or belongs to no camera, a truncated file, or a folder without a complete model.
ColmapModel read_colmap_model(const std::filesystem::path& folder, const Context& context = {});

// Reads only the cameras. `path` is the folder of a model, a text file or a .bin file with the
// cameras of COLMAP or COLMAP-Underwater, or a file of Calibmar (is_calibmar in calibmar.h), with
// its port. In a folder, the form of a complete model is read, binary before text. A folder without
// a complete model needs only a cameras file. Warnings and errors as for read_colmap_model.
std::vector<ColmapCamera> read_colmap_cameras(const std::filesystem::path& path,
                                              const Context& context = {});

// Error if `folder` holds a complete binary model, because readers would read the binary model
// instead of a text model in the same folder.
void require_no_binary_model(const std::filesystem::path& folder);

// Write the three files of a model for COLMAP into `folder` and replace existing ones. Ports are
// left out because COLMAP cannot read them. Both writers give an Error for an image name that the
// format cannot hold, and for a file that cannot be written. The text writer gives an Error if the
// folder holds a complete binary model (require_no_binary_model). The binary writer gives an Error
// for a camera model that COLMAP does not have.
void write_colmap_text(const std::filesystem::path& folder, const ColmapModel& model);
void write_colmap_binary(const std::filesystem::path& folder, const ColmapModel& model);

// Writes cameras for COLMAP into the text file `file`, as write_colmap_text() does.
void write_colmap_cameras(const std::filesystem::path& file,
                          const std::vector<ColmapCamera>& cameras);

// Write a model for COLMAP-Underwater, with the ports of the cameras. Errors as for the writers
// above, with two differences. The binary writer gives an Error for a camera model that
// COLMAP-Underwater does not have. The text writer does not check whether the folder holds a binary
// model: callers call require_no_binary_model().
void write_underwater_text(const std::filesystem::path& folder, const ColmapModel& model);
void write_underwater_binary(const std::filesystem::path& folder, const ColmapModel& model);

// The number of focal lengths (1 or 2) among the parameters of the camera model of this name. The
// focal lengths are the first parameters. -1 if the model is unknown.
int colmap_focal_count(std::string_view model);

// The number of all parameters of the camera model of this name. -1 if the model is unknown.
int colmap_parameter_count(std::string_view model);

}  // namespace axial::io
