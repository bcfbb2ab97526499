// SPDX-License-Identifier: GPL-3.0-or-later
// The files of a scene from the arguments of Python.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "axial/io.h"

namespace axial::python {

// Paths become absolute. The default of `working_folder` is the folder of the scene. Error that
// names the setting "ports" if it is not one of automatic, ignored, required and flat.
io::SceneFiles scene_files(const std::filesystem::path& scene,
                           const std::optional<std::filesystem::path>& working_folder,
                           const std::optional<std::filesystem::path>& housing,
                           const std::string& ports, bool allow_missing);

// The frame in which float positions of a file of a mesh or cloud are exact: its own, or for
// doubles in the world a frame near its first vertex.
LocalFrame frame_of_file(const std::filesystem::path& path);

}  // namespace axial::python
