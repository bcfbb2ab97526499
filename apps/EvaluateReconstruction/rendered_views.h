// SPDX-License-Identifier: GPL-3.0-or-later
// Renders the input mesh into views, and compares the pictures with photographs.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "evaluate/views.h"
#include "geometry/surface.h"
#include "inputs.h"

namespace axial::apps {

// A view to render. Paths are empty where a picture is not written or compared.
struct RenderTask {
  evaluate::View view;
  std::filesystem::path picture;     // the mesh with its own colours
  std::filesystem::path errors;      // the mesh coloured by error
  std::filesystem::path photograph;  // from this view
};

// Finds the views that Options::rendered_views names, their photographs and the paths of their
// pictures. `has_truth`: errors are known. Error if a view does not exist, a photograph is missing
// or has another size than its camera, a picture cannot be written or would replace an input or
// another picture, or the mesh has no colours that could be rendered.
std::vector<RenderTask> plan_rendering(const Options& options, const Input& input,
                                       std::span<const evaluate::View> views, bool has_truth);

// Renders the views, writes the pictures, prints the table and returns its content for the JSON
// file. `truth` is null or the true surface; then only pixels that the truth covers are compared.
// `error_colors`: colours of the vertices; empty without truth.
nlohmann::ordered_json render(const Options& options, const Input& input,
                              std::span<const RenderTask> tasks, const geometry::Surface* truth,
                              std::span<const Rgb> error_colors);

}  // namespace axial::apps
