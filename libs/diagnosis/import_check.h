// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether a COLMAP model, its housing and its photographs belong together.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "axial/base.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"

namespace axial::diagnosis {

// Returns a warning of one line if the cameras of `model`, behind the ports of `housing`, do not
// fit the tracks or the photographs. `housing` has entries for the images of `model`
// (io::for_images) and is in the world frame of `model`. Returns nothing if everything fits or if
// the data cannot tell (port_check.h says when tracks can tell). The points of a bounded sample are
// triangulated anew. The result is the same for any number of threads.
//
// If the tracks fit cameras in air, they may come from photographs in air. In this case up to six
// photographs decide. Their paths are the image names of `model`, relative to `image_folder`. If
// `image_folder` is empty, there is no warning in this case. Exception: the tracks of a model whose
// cameras have ports (ColmapCamera::port) always come from photographs taken through these ports.
//
// A too large scale of the poses is not found here. Such a scale moves the images of points by
// about a pixel, and patches of photographs hardly show this movement. The depth maps of
// DensifyPointCloud show it (depth/agreement.h).
//
// Throws no Error. An unsupported lens, an image whose rays do not reach its port, or a photograph
// that cannot be read gives no warning. `context` gets the numbers that decide, as details.
std::optional<std::string> import_warning(const io::ColmapModel& model, const io::Housing& housing,
                                          const std::filesystem::path& image_folder,
                                          const Context& context = {});

}  // namespace axial::diagnosis
