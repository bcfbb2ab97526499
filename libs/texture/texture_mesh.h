// SPDX-License-Identifier: GPL-3.0-or-later
// Gives a mesh textures from photographs. The cameras of the photographs may be behind ports.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "base/setting_names.h"
#include "scene/textured_mesh.h"
#include "texture/face_views.h"
#include "texture/labels.h"
#include "texture/leveling.h"
#include "texture/packing.h"
#include "texture/split_faces.h"

namespace axial::texture {

// The size of a textured mesh.
struct ResultSize {
  std::size_t vertices = 0, faces = 0;
  std::vector<cv::Size> textures;
};

struct Options {
  SplitOptions split;
  VisibilityOptions visibility;
  // `threshold` of remove_outliers() (outliers.h): the larger, the more views of faces are removed
  // because of their colours. 0: keep all views.
  double outlier_threshold = 0.06;
  LabelOptions labels;
  LevelingOptions leveling;
  PackingOptions packing;
  double sharpness_weight = 0;    // amount of an unsharp mask (paint() in atlas.h); 0: none
  Rgb empty_color{255, 127, 39};  // R G B; for faces that no view sees, and between the charts
  // The memory [bytes] that texture_mesh() may use besides `mesh`. The need is estimated by
  // functions of the stages' headers. This limit affects the time, but not the result. 0: no limit.
  std::uint64_t max_bytes = 0;
  // The largest memory [bytes] that `images` needs while it makes an image, with the image.
  std::uint64_t image_bytes = 0;
  // The memory [bytes] that the caller needs afterwards to write the result, besides the result. An
  // empty function: none.
  std::function<std::uint64_t(const ResultSize&)> bytes_to_write;
  // Errors name the field max_bytes by name_of("max_memory").
  SettingNames name_of = own_name;
};

// The numbers that texture_mesh() reports.
struct Report {
  std::size_t new_faces = 0;     // faces that splitting has added
  std::size_t unseen_faces = 0;  // faces that no view sees, after splitting
  std::size_t outliers = 0;      // removed sights: a sight is a pair of a face and a view
  std::size_t charts = 0;        // charts: connected faces with colours from one view
  std::size_t scaled_down = 0;   // charts that were larger than a texture
};

// Returns the ProgressSink for a stage with the given name. texture_mesh() calls the function at
// the start of each stage that takes long.
using StageProgress = std::function<ProgressSink(const std::string& stage)>;

// Returns `mesh` with textures. Each face gets the colours of one of the views that see the face,
// as chosen by choose_views() (labels.h). A face that no view sees gets Options::empty_color. Faces
// stay in the same order, and the parts of a split face follow each other at the place of this
// face. Vertices keep their indices, and the vertices that splitting adds follow. `report`, if
// given, is filled.
//
// Throws an Error if check_mesh() refuses the mesh (scene/check_mesh.h), for example a mesh without
// faces. Throws an Error if no view sees any face, if pack() refuses the options (packing.h), or if
// max_bytes does not suffice for a stage. Exceptions of `images` are passed on.
TexturedMesh texture_mesh(Mesh mesh, std::span<const View> views, const ImageSource& images,
                          const Options& options = {}, Report* report = nullptr,
                          const StageProgress& progress = {});

}  // namespace axial::texture
