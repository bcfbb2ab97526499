// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh in tiles (mesh/tiled.h), with its files beside the output.
#pragma once

#include <filesystem>

#include "base/context.h"
#include "io/openmvs/scene_with_cameras.h"
#include "mesh/cloud_source.h"
#include "options.h"
#include "scene/mesh.h"

namespace axial::apps {

// The cloud to use. As in OpenMVS, the cloud beside the scene is taken if none is named. Empty: the
// points of the scene.
std::filesystem::path cloud_file(const Options& options);

// Reads the cloud to use. `scene`, `options` and `context` must outlive the result.
mesh::CloudSource source_of(const io::SceneWithCameras& scene, const Options& options,
                            const Context& context);

// Makes tile Options::tile, and writes its files into the folder <output>.tilesN.
void make_tile(const io::SceneWithCameras& scene, const Options& options, const Context& context);

// Makes the tiles whose files are missing, and returns the mesh of all tiles.
Mesh join_tiles(const io::SceneWithCameras& scene, const Options& options, const Context& context);

// Removes the intermediate files of tiles beside the output, those of other numbers of tiles, too.
// Other files in their folders stay.
void remove_tiles(const Options& options);

}  // namespace axial::apps
