// SPDX-License-Identifier: GPL-3.0-or-later
// Where a scene's coordinates count from: the file beside a scene that says so, and the way of
// models and housings into such a frame. COLMAP models and housing files are always in world
// coordinates.
#pragma once

#include <filesystem>
#include <optional>

#include "io/colmap.h"
#include "io/housing.h"
#include "scene/local_frame.h"

namespace axial::io {

// "<scene without extension>.geo.json".
std::filesystem::path geo_offset_beside(const std::filesystem::path& scene_path);

// The frame that the file beside the scene names; nothing without a file. Error that names file,
// key and value for unknown keys, a version other than 1, an offset of not three finite numbers.
std::optional<LocalFrame> read_geo_offset_beside(const std::filesystem::path& scene_path);

// Writes the file beside the scene. In the world itself none is left.
void write_geo_offset_beside(const std::filesystem::path& scene_path, const LocalFrame& frame);

// The frame of a scene read from `scene_path`, which is in it afterwards. A scene with a file
// beside it is in that file's frame already. One without is in the world, and if that is far away
// it enters the frame_of() it, with a warning: its sparse points are float and have lost digits.
LocalFrame enter_local_frame(Scene& scene, const std::filesystem::path& scene_path);

// The frame of a model in world coordinates, which enters it.
LocalFrame enter_local_frame(ColmapModel& model);

// A model in world coordinates into `frame`, and back.
void enter(const LocalFrame& frame, ColmapModel& model);
void leave(const LocalFrame& frame, ColmapModel& model);

// A housing in world coordinates, for poses in `frame`: of it, only water surfaces have a place.
Housing in_frame(const LocalFrame& frame, Housing housing);

}  // namespace axial::io
