// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: functions that the readers and the writers of COLMAP models share.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "axial/base.h"
#include "bytes/private/only_for_io.h"
#include "io/colmap/colmap.h"
#include "refractive/port.h"

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

// Which files in a folder hold its model.
enum class ModelForm { text, binary };

// Returns the path of the file that holds one part of a model in `form`. `part` is "cameras",
// "images" or "points3D".
std::filesystem::path part_file(const std::filesystem::path& folder, const std::string& part,
                                ModelForm form);

// Read one part of a model from a file. Error that names the file and the record for malformed or
// truncated data. References between the parts are not checked. `context` gets the warnings of
// port_from().
std::vector<ColmapCamera> read_cameras_text(const std::filesystem::path& path,
                                            const Context& context);
std::vector<ColmapImage> read_images_text(const std::filesystem::path& path);
std::vector<ColmapPoint3D> read_points_text(const std::filesystem::path& path);
std::vector<ColmapCamera> read_cameras_binary(const std::filesystem::path& path,
                                              const Context& context);
std::vector<ColmapImage> read_images_binary(const std::filesystem::path& path);
std::vector<ColmapPoint3D> read_points_binary(const std::filesystem::path& path);

// A part of a model: its name, and its reader for each form.
template <class T>
struct ModelPart {
  const char* name;
  std::vector<T> (*text)(const std::filesystem::path& path, const Context& context);
  std::vector<T> (*binary)(const std::filesystem::path& path, const Context& context);

  std::vector<T> read(const std::filesystem::path& folder, ModelForm form,
                      const Context& context) const {
    return (form == ModelForm::text ? text : binary)(part_file(folder, name, form), context);
  }
};

// A reader that sends no lines, in the form of ModelPart.
template <auto read>
auto without_lines(const std::filesystem::path& path, const Context&) {
  return read(path);
}

inline constexpr ModelPart<ColmapCamera> kCameras{"cameras", read_cameras_text,
                                                  read_cameras_binary};
inline constexpr ModelPart<ColmapImage> kImages{"images", without_lines<read_images_text>,
                                                without_lines<read_images_binary>};
inline constexpr ModelPart<ColmapPoint3D> kPoints{"points3D", without_lines<read_points_text>,
                                                  without_lines<read_points_binary>};

// A port in the form of COLMAP-Underwater and Calibmar: a word and eight numbers in the order
// below. Directions and points are in the camera frame. Lengths are in metres.
//
//     FLATPORT  Nx Ny Nz distance thickness n_air n_glass n_water
//     DOMEPORT  Cx Cy Cz inner_radius thickness n_air n_glass n_water
inline constexpr std::size_t kPortNumbers = 8;
using PortNumbers = std::array<double, kPortNumbers>;

// The kind of a port is a word in text files and a number in binary files: "FLATPORT" is 0 and
// "DOMEPORT" is 1. The number -1 in a binary file means no port.
std::string_view port_word(const refractive::Port<double>& port);
std::string_view port_word(int number);  // empty for an unknown number
bool is_port_word(std::string_view word);
int port_number(const refractive::Port<double>& port);

PortNumbers port_numbers(const refractive::Port<double>& port);

// Returns the port of a word and its numbers. A normal that is not of unit length is normalised,
// with a warning of `context` if its length differs from 1 by more than 1e-6. Error that starts
// with `where` for an unknown word or for values that are not possible (check_port).
refractive::Port<double> port_from(std::string_view word, const PortNumbers& numbers,
                                   const std::string& where, const Context& context);

// True if the part's file exists in `form` and is a regular file.
bool has_part(const std::filesystem::path& folder, const std::string& part, ModelForm form);

// True if the folder holds all three parts in `form`.
bool holds_model(const std::filesystem::path& folder, ModelForm form);

// Returns the form in which a model is read, as COLMAP chooses it: binary if the binary model is
// complete, otherwise text if the text model is complete. All files of a model are read in one
// form. Error that names the missing files of both forms if no model is complete.
ModelForm model_form(const std::filesystem::path& folder);

// Returns the form in which the cameras are read. If a model is complete, this is
// model_form(folder). Otherwise it is the form of the cameras file that exists, or binary if
// cameras files exist in both forms. Error if there is no cameras file.
ModelForm cameras_form(const std::filesystem::path& folder);

// Warn through `context`, in one line, of files that were ignored although their contents differ
// from `model` or `cameras`. `read` is the form that was read. The ignored files are the files in
// the other form. A file that cannot be read counts as different. The order of cameras, images and
// points does not matter. Numbers a and b count as equal if |a - b| <= 1e-9 max(1, |a|, |b|).
void warn_of_ignored_files(const std::filesystem::path& folder, ModelForm read,
                           const ColmapModel& model, const Context& context);
void warn_of_ignored_cameras(const std::filesystem::path& folder, ModelForm read,
                             const std::vector<ColmapCamera>& cameras, const Context& context);

// warn_of_port_values() (cameras/private/port_values.h) for the ports of `cameras`, once for each
// distinct port. Warnings start with "`file`: camera ID: port".
void warn_of_port_values(std::span<const ColmapCamera> cameras, const std::string& file,
                         const Context& context);

}  // namespace axial::io
