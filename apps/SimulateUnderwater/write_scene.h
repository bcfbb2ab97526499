// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the data of the simulator in the file formats of the project.
#pragma once

#include <filesystem>
#include <span>

#include "simulate/presets/presets.h"
#include "simulate/presets/survey_change.h"
#include "simulate/render.h"
#include "simulate/sparse_points.h"
#include "simulate/triangle_mesh.h"

namespace axial::apps {

// Returns the name of a view's files without extension: "0007", or with two cameras "left/0007" and
// "right/0007". The view's image in the sparse model has this name, too, with the extension .jpg.
std::string view_name(const simulate::Preset& preset, std::size_t view);

// Writes a COLMAP model with one or two cameras, the true poses and the true observations:
// cameras.txt, images.txt and points3D.txt in `folder`.
void write_sparse_model(const std::filesystem::path& folder, const simulate::Preset& preset,
                        std::span<const simulate::SparsePoint> points);

// Writes a housing file with one port, "main", for every image: the preset's port, or the water
// surface. With two cameras, the ports are "left" and "right", by COLMAP's cameras 1 and 2.
void write_port(const std::filesystem::path& file, const simulate::Preset& preset);

// Writes the change before a second survey: the volumes and areas of `change`, their sum, and the
// places of the boulder and of the patch in `preset` [world, m].
void write_change(const std::filesystem::path& file, const simulate::Preset& preset,
                  const simulate::ChangeTruth& change);

// Writes a PLY file. If the mesh has thicknesses, they are the vertex property `thickness` [m].
void write_mesh(const std::filesystem::path& file, const simulate::TriangleMesh& mesh);

// Writes the true distances to <folder>/<name>.distance.tiff, and the true normals to
// <folder>/<name>.normal.tiff.
void write_truth(const std::filesystem::path& folder, const std::string& name,
                 const simulate::Truth& truth);

}  // namespace axial::apps
