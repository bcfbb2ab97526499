// SPDX-License-Identifier: GPL-3.0-or-later
// Converts a COLMAP model and its images to a scene.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "scene/scene.h"

namespace axial::io {

// Where the images of a model are, and what becomes of distorted images.
struct ColmapImport {
  std::filesystem::path model_folder;        // messages name it; it is not read
  std::filesystem::path image_folder;        // image names are relative to this folder
  std::filesystem::path undistorted_folder;  // for undistorted images; created if needed
  bool undistort = true;  // false: undistort only where rule 2 below does not apply
};

// Removes the images of `model` whose files are not in `image_folder`, their observations, and the
// points that are left with fewer than two observations. Returns the files of the removed images,
// in the model's order.
std::vector<std::filesystem::path> remove_missing_images(ColmapModel& model,
                                                         const std::filesystem::path& image_folder);

// Returns the scene of `model`, with the images in the model's order. For each camera, the first
// rule that applies is used:
// 1. Images of pinhole cameras are used as they are.
// 2. If `import.undistort` is false and the matcher can model the lens (lens::lens_distortion), the
//    camera keeps its distorted lens and its images are used as they are.
// 3. Otherwise the camera is replaced by a pinhole (pinhole_inside in colmap_lens.h). Its images,
//    and the masks that find_masks() finds beside them, are resampled into
//    `import.undistorted_folder`. JPEG files with 8 bits and no transparency stay JPEG. Other files
//    become PNG.
//
// The id of an image is COLMAP's id minus one. Exception: if a COLMAP id is 0, all ids are COLMAP's
// ids. The views of a sparse point are sorted by image and have confidence 0. If an image occurs
// more than once in a track, it counts once. A line of `context` states how many observations are
// ignored for this reason. Ports of the cameras are not used.
//
// `undistorting` gets the number of images undistorted so far, `preparing_cameras` the number of
// cameras for which a rule has been chosen, and `checking_images` the number of images whose header
// was compared with the camera.
//
// Memory: one image for each thread is undistorted at a time. The undistortion map of a camera
// stays in memory from the first to the last image of the camera.
//
// Error that names the file, the field and the value, before any file is written, if the model has
// fewer than two images, a lens is not supported, an image file is missing or has another size than
// its camera, two images would be undistorted to the same file, or an undistorted image would
// replace a photograph.
Scene import_colmap_scene(const ColmapModel& model, const ColmapImport& import,
                          const ProgressSink& undistorting = {},
                          const ProgressSink& preparing_cameras = {},
                          const ProgressSink& checking_images = {}, const Context& context = {});

// Returns a housing with the ports of `cameras` (ColmapCamera::port), by camera id. The port of the
// camera with the id 1 is named "camera_1", and so on. Cameras without a port get the default port
// "none".
Housing housing_of(std::span<const ColmapCamera> cameras);

// Reads a housing file (read_housing() in housing.h) and resolves its entries for the images of
// `model` (for_images() in housing.h): port_of() of the result finds the right port of each image,
// also if the whole name of one image is the end of another name. Warnings and errors as for these
// two functions.
Housing read_housing(const std::filesystem::path& path, const ColmapModel& model,
                     const Context& context = {});

// Returns a housing that gives every image the same port as `housing`, but has only entries by
// image and no entries by camera id. attach_ports needs this form, because a scene does not contain
// COLMAP's camera ids. An image that gets the default port has no entry unless another entry would
// match it. Precondition: `scene` is the result of import_colmap_scene() for `model` and `import`.
// Readers assign a port to an image by the end of the image's path. Error if this rule would give
// an image a wrong port.
Housing housing_by_image(const Housing& housing, const ColmapModel& model, const Scene& scene,
                         const ColmapImport& import);

// Returns the entries of `housing` that are used for no image of the model, for example
// "images.a.jpg" and "cameras.2": entries that are the longest match (Housing::entry_of) of no
// image, and entries of cameras that no image has. Entries by image come first.
std::vector<std::string> unused_entries(const Housing& housing, const ColmapModel& model);

}  // namespace axial::io
