// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the simulator's data as the project's files.
#pragma once

#include <filesystem>
#include <span>

#include "simulate/presets.h"
#include "simulate/render.h"
#include "simulate/sparse_points.h"
#include "simulate/triangle_mesh.h"

namespace axial::apps {

// "0007": the common name of an image, its truth and its entry in the sparse model.
std::string view_name(std::size_t view);

// <folder>/{cameras,images,points3D}.txt: one camera, the true poses and observations.
void write_sparse_model(const std::filesystem::path& folder, const simulate::Lens& lens,
                        std::span<const simulate::View> views,
                        std::span<const simulate::SparsePoint> points);

// One port, "main", for every image, or the water surface.
void write_port(const std::filesystem::path& file, const simulate::Preset& preset);

// With a vertex property `thickness` [m] if the mesh has thicknesses.
void write_mesh(const std::filesystem::path& file, const simulate::TriangleMesh& mesh);

// <folder>/<name>.{distance,normal}.tiff
void write_truth(const std::filesystem::path& folder, const std::string& name,
                 const simulate::Truth& truth);

}  // namespace axial::apps
