// SPDX-License-Identifier: GPL-3.0-or-later
// The files that belong to a scene. Programs read them, and never write over them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "axial/base.h"
#include "io/openmvs/scene_with_cameras.h"

namespace axial::io {

// Returns the path "<scene without extension>.ply": the dense cloud, or the mesh, of a scene.
std::filesystem::path cloud_beside(const std::filesystem::path& scene);

// Returns the name of the depth map of the image with the global id `id`: "depth0003.dmap".
std::string depth_map_name(std::uint32_t id);

// Returns the files that belong to a scene and that are known before it is read: the scene, its
// cloud, its housing (the file that is given and the one beside the scene), its lenses and its
// offset. A file need not exist.
std::vector<std::filesystem::path> files_of_scene(const SceneFiles& files);

// Returns the same files, and those of the images of `scene`: photographs, masks, and depth maps
// with their side files in the working folder and in the folder of the scene.
std::vector<std::filesystem::path> files_of_scene(const SceneFiles& files, const Scene& scene);

// The path of a mesh that is made from a scene. OpenMVS's users name the mesh after the scene
// ("-o scene_dense.mvs"), and would overwrite the scene's cloud. `given`: the value of the option
// -o, as a path; empty: it was not given. `ending`: "_mesh", "_refine" or "_texture".
//
// Returns `given` without a known extension (base/program/output_name.h). If `given` is empty, or
// if it names the scene, with the extension .mvs or without extension, and the mesh is a PLY file
// (`is_ply`), the result is "<scene without extension><ending>". In the latter case a line of
// `context` says so.
std::filesystem::path mesh_beside(const std::filesystem::path& scene,
                                  const std::filesystem::path& given, const std::string& ending,
                                  bool is_ply, const Context& context);

}  // namespace axial::io
