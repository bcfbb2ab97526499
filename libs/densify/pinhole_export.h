// SPDX-License-Identifier: GPL-3.0-or-later
// Exports the finished reconstruction for OpenMVS's later programs and for trainers of splats.
// Every photograph with a depth map, and its depth map, are resampled to a pinhole camera.
#pragma once

#include "densify/existing_maps.h"
#include "densify/project.h"

namespace axial::densify {

// An upper bound of the memory [bytes] for resampling one image and its depth map in
// export_pinholes(). `view`: the image.
std::uint64_t bytes_needed_to_resample(const View& view);

// Writes the folder OutputOptions::pinhole_export by write_folder() (base/atomic_file.h) and
// removes the files of an earlier export from it (remove_earlier_export() in pinhole_folder.h). The
// folder contains
//   images/NAME                         for every image with a depth map (Project::references): the
//                                       resampled photograph; NAME: see exported_name()
//   images/NAME.mask.png                its labels (cloud::PinholeImage); NAME without extension
//   colmap/images/NAME                  the resampled photograph again, as a hard link if possible
//   colmap/masks/NAME.png               NAME without extension: the usable pixels
//                                       (cloud::PinholeImage), without those that a mask of the run
//                                       leaves out
//   colmap/sparse/0/*.bin               the model of these images (write_pinhole_model())
//   depthNNNN.dmap                      depth maps of the pinhole cameras
//   scene.mvs                           all images in the scene's order; images without a depth map
//                                       are uncalibrated. It has the sparse points that
//                                       calibrated images see
//   scene.ply                           the cloud of the run, as float in the scene's frame
//   pinhole_export.json                 facts about the resampling, and the list of written files
// and the offset of the scene if it has one. Moves the sparse points out of the project's scene,
// which has no points afterwards. The colours are those of View::colors if the views have such
// files. `maps`: the result of find_existing_maps(). Resamples `at_once` images at the same time.
// Precondition: check_pinhole_export() (pinhole_folder.h) has returned and the cloud is complete.
// Throws an Error if an input cannot be read or a file cannot be written.
void export_pinholes(Project& project, const OutputOptions& output, const ExistingMaps& maps,
                     std::size_t at_once, const Context& context);

}  // namespace axial::densify
