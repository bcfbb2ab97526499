// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and writes the file beside a scene that states the origin of the scene's coordinates. Moves
// scenes, COLMAP models and housings into the local frame. A local frame has its origin near the
// scene, and its axes are parallel to those of the world (LocalFrame). The files of COLMAP models
// and housings are always in world coordinates.
#pragma once

#include <filesystem>
#include <optional>

#include "axial/base.h"
#include "io/cameras/housing.h"
#include "scene/decompositions.h"
#include "scene/local_frame.h"

namespace axial::io {

// Returns the path "<scene without extension>.geo.json".
std::filesystem::path geo_offset_beside(const std::filesystem::path& scene_path);

// Returns the frame whose origin the file beside the scene states; nothing if there is no file.
// Error that names the file if it cannot be read or is no JSON, and if it has an unknown, missing
// or repeated key, a version other than 1, or an offset that is not three finite numbers.
std::optional<LocalFrame> read_geo_offset_beside(const std::filesystem::path& scene_path);

// Writes the origin of `frame` to the file beside the scene. If `frame` is the world, no file is
// written and an existing file is removed, which a line of `context` tells. Error if the file
// cannot be written. A failure to remove it is ignored.
void write_geo_offset_beside(const std::filesystem::path& scene_path, const LocalFrame& frame,
                             const Context& context = {});

// Moves a scene that was read from `scene_path` into its local frame and returns this frame.
//
// If there is a file beside the scene, the scene is already in the frame that the file states and
// stays unchanged. Warns through `context` if the cameras are more than 1e5 m from the origin of
// this frame. If there is no file, the scene is in world coordinates and is moved into
// frame_of(scene). If frame_of(scene) is not the world, a warning of `context` states that the
// sparse points, which are float, have lost digits. Errors as for read_geo_offset_beside().
LocalFrame enter_local_frame(Scene& scene, const std::filesystem::path& scene_path,
                             const Context& context = {});

// Converts `housing` from world coordinates to `frame` and returns the result. Only water surfaces
// change, because other ports have no position in the world.
Housing in_frame(const LocalFrame& frame, Housing housing);

// Returns the housing that fits the poses after they have been moved by `similarity`, which maps
// world coordinates to world coordinates. `housing` is in world coordinates before and after. Water
// surfaces are moved by `similarity`. Other ports are fixed to the camera, so that only their
// lengths (distance, radius, thickness) can change. If `scale_ports` is true, the lengths are
// multiplied by the scale, so that every moved point keeps its pixel. Otherwise the lengths stay.
Housing moved(const Similarity& similarity, Housing housing, bool scale_ports);

}  // namespace axial::io
