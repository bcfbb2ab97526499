// SPDX-License-Identifier: GPL-3.0-or-later
// The origin of a scene's coordinates: the file beside a scene that names it, and functions that
// move models and housings into the local frame. COLMAP models and housing files are always in
// world coordinates.
#pragma once

#include <filesystem>
#include <optional>

#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "scene/local_frame.h"

namespace axial::io {

// "<scene without extension>.geo.json".
std::filesystem::path geo_offset_beside(const std::filesystem::path& scene_path);

// Returns the frame that the file beside the scene names; nothing if there is no file. Error that
// names the file, the key and the value for an unknown key, a version other than 1, or an offset
// that is not three finite numbers.
std::optional<LocalFrame> read_geo_offset_beside(const std::filesystem::path& scene_path);

// Writes the file beside the scene. If `frame` is the world, an existing file is removed instead.
void write_geo_offset_beside(const std::filesystem::path& scene_path, const LocalFrame& frame);

// Returns the local frame of a scene that was read from `scene_path`. After the call the scene is
// in that frame. If there is a file beside the scene, the scene is in its frame already; a warning
// is given if the cameras are far from its origin. Otherwise the scene is in world coordinates. If
// it lies far from the origin it is moved into frame_of(scene), with a warning, because its sparse
// points are float and have lost digits.
LocalFrame enter_local_frame(Scene& scene, const std::filesystem::path& scene_path);

// Moves a model in world coordinates into the frame near its cameras (frame_of) and returns that
// frame.
LocalFrame enter_local_frame(ColmapModel& model);

// Moves a model from world coordinates into `frame` (enter) and back (leave).
void enter(const LocalFrame& frame, ColmapModel& model);
void leave(const LocalFrame& frame, ColmapModel& model);

// Returns `housing`, which is in world coordinates, for poses in `frame`. Only water surfaces
// change, because other ports have no position in the world.
Housing in_frame(const LocalFrame& frame, Housing housing);

}  // namespace axial::io
