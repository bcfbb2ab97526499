// SPDX-License-Identifier: GPL-3.0-or-later
// Gives a mesh textures from photographs. The cameras of the photographs may be behind ports.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "base/context.h"
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
  // The number of tiles of texture_tiles(), from 1 to kMostTiles (base/tiling.h), and their
  // axes (rows) in the frame of the mesh.
  std::size_t tiles = 1;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
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
  // Takes the mesh after splitting and the views of its faces, as find_face_views() returns them,
  // before views are removed. Called only if `tiles` is 1. An empty function: nothing is called.
  std::function<void(const Mesh&, const FaceViews&)> take_views;
  // The largest memory [bytes] that `images` needs while it makes an image, with the image.
  std::uint64_t image_bytes = 0;
  // The memory [bytes] that the caller needs afterwards to write the result, besides the result. An
  // empty function: none.
  std::function<std::uint64_t(const ResultSize&)> bytes_to_write;
  // Errors name the field `tiles` by name_of("tiles").
  SettingNames name_of = own_name;
};

// The numbers that texturing reports.
struct Report {
  std::size_t new_faces = 0;     // faces that splitting has added
  std::size_t unseen_faces = 0;  // faces that no view sees, after splitting
  std::size_t outliers = 0;      // removed sights: a sight is a pair of a face and a view
  std::size_t charts = 0;        // charts: connected faces with colours from one view
  std::size_t scaled_down = 0;   // charts that were larger than a texture
};

// Returns `mesh` with textures. Each face gets the colours of one of the views that see the face,
// as chosen by choose_views() (labels.h). A face that no view sees, or that
// is marked (Mesh::unseen), gets Options::empty_color. Marks are kept. Faces
// stay in the same order, and the parts of a split face follow each other at the place of this
// face. Vertices keep their indices, and the vertices that splitting adds follow. `report`, if
// given, is filled. Options::tiles has no effect.
//
// Context::memory() is for the memory besides `mesh`. The need is estimated by functions of the
// stages' headers. The limit affects the time, but not the result.
//
// Throws an Error if check_mesh() refuses the mesh (scene/check_mesh.h), for example a mesh without
// faces. Throws an Error if no view sees any face, if pack() refuses the options (packing.h), or if
// the memory does not suffice for a stage. Exceptions of `images` are passed on.
TexturedMesh texture_mesh(Mesh mesh, std::span<const View> views, const ImageSource& images,
                          const Options& options = {}, Report* report = nullptr,
                          const Context& context = {});

// Takes the textured mesh of a tile. `tile`: its index.
using TileSink = std::function<void(std::size_t tile, TexturedMesh mesh)>;

// Textures `mesh` as Options::tiles meshes, so that the views of faces and the textures of only one
// tile are in memory at the same time. `take` gets the meshes one after the other. For one tile
// this is the mesh of texture_mesh(). For more tiles:
//
//   - Each face is in one of the meshes. Faces and vertices keep their order. A mesh has only the
//     vertices of its faces, so that a vertex at a border is in several meshes, at the same
//     position. A mesh without faces has no textures.
//   - The tiles divide space (divide_faces() in mesh_tiles.h). A face with a chart is in the tile
//     that contains most of the chart's faces: charts are not cut. A face without chart is in the
//     tile that contains its middle.
//   - Views are chosen tile by tile, mostly the same as in one piece (face_labels.h).
//   - Seams between tiles are levelled like all seams, because the corrections are those of the
//     whole mesh (leveling.h). With the same views of faces, the pixels of each chart are those of
//     one piece.
//
// Photographs are read three times instead of twice if there are seams. A photograph is read again
// for each tile that uses it. Errors as for texture_mesh(). Exceptions of `take` are passed on.
void texture_tiles(Mesh mesh, std::span<const View> views, const ImageSource& images,
                   const Options& options, const TileSink& take, Report* report = nullptr,
                   const Context& context = {});

}  // namespace axial::texture
