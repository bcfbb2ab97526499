// SPDX-License-Identifier: GPL-3.0-or-later
// Gives a mesh textures from photographs, whose cameras may be behind ports.
#pragma once

#include <cstddef>
#include <span>

#include "scene/textured_mesh.h"
#include "texture/face_views.h"
#include "texture/labels.h"
#include "texture/leveling.h"
#include "texture/packing.h"
#include "texture/split_faces.h"

namespace axial::texture {

struct Options {
  SplitOptions split;
  VisibilityOptions visibility;
  double outlier_threshold = 0.06;  // see remove_outliers(); 0: keep all views
  LabelOptions labels;
  LevelingOptions leveling;
  PackingOptions packing;
  double sharpness_weight = 0;    // see paint()
  Rgb empty_color{255, 127, 39};  // of faces that no view sees, and between the charts
};

struct Report {
  std::size_t new_faces = 0;  // by splitting
  std::size_t unseen_faces = 0;
  std::size_t outliers = 0;  // pairs of a face and a view
  std::size_t charts = 0;
  std::size_t scaled_down = 0;  // charts that were larger than a texture
};

// The names of the stages for progress, which is called for stages that take long.
using StageProgress = std::function<ProgressSink(const std::string& stage)>;

// Textures `mesh`. Its faces get the colours of the view that labels.h chooses among those that see
// them, and are in the result in the same order, with the parts of a split face in its place.
// Vertices keep their indices. Error for a mesh without faces, with a face index out of range or a
// coordinate that is not finite, for a mesh of which no view sees a face, and an Error of `images`.
TexturedMesh texture_mesh(Mesh mesh, std::span<const View> views, const ImageSource& images,
                          const Options& options = {}, Report* report = nullptr,
                          const StageProgress& progress = {});

}  // namespace axial::texture
