// SPDX-License-Identifier: GPL-3.0-or-later
// Gives a mesh textures from photographs. The cameras of the photographs may be behind ports.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "axial/base.h"
#include "axial/geometry.h"
#include "axial/scene_images.h"

namespace axial::texture {

using View = geometry::PosedCamera;  // of a photograph, in the frame of the mesh

// The pixels of a photograph.
struct ViewImage {
  cv::Mat3b color;   // B G R, of the size of the view's camera
  cv::Mat1b usable;  // size of `color`; 0: the pixel must not be used. Empty: all may be used
};

// Returns the photograph of view `index`. The function is called concurrently, may be called more
// than once for each view, and must return the same image each time. The number of images in memory
// at the same time is at most the number of threads.
using ImageSource = std::function<ViewImage(std::size_t index)>;

// How faces are split that are too large for linear texture coordinates.
struct SplitOptions {
  double tolerance = 0.25;             // largest error of a linear image inside a face [px]
  std::size_t max_faces = 20'000'000;  // largest number of faces that splitting may give
};

// A view that sees a face, or only a part of the face.
struct Sight {
  std::uint32_t view = 0;  // index into the views of find_face_views()
  float quality = 0;       // higher is better; find_face_views() defines it
  // Mean colour of the face in this view, B G R. It has no meaning if `whole` is false.
  std::array<std::uint8_t, 3> color{};
  bool whole = true;  // the view sees all of the face
};

// The sights of all faces in one array. The sights of face f are at [begin[f], begin[f + 1]) of
// `sights`, in the order of the views. All sights of one face have the same Sight::whole.
struct FaceViews {
  std::vector<std::uint64_t> begin;
  std::vector<Sight> sights;

  std::size_t faces() const { return begin.size() - 1; }
  std::span<const Sight> of(std::size_t face) const {
    return std::span(sights).subspan(begin[face], begin[face + 1] - begin[face]);
  }
};

struct VisibilityOptions {
  // A face does not hide a point of the mesh if it crosses the path of light less than tolerance *
  // L from the point. L is the length of the path from the point to the place where the light
  // leaves the water. Range: 0 to 1. The default is the ratio of a pixel's width on the surface to
  // the distance, for a focal length of 1000 px.
  double tolerance = 1e-3;
};

// How each face gets the view of its colours.
struct LabelOptions {
  // The weight of the quality of a face, relative to the weight of a seam at one of its edges (see
  // the cost in choose_views()). With a ratio near 0 there are as few seams as possible. The larger
  // the ratio, the more faces get their best view.
  double cost_smoothness_ratio = 0.1;
  // At most this number of alpha expansions of each view. 0: each face gets its best view.
  int max_cycles = 3;
};

struct GlobalLevelingOptions {
  // Weight of the squared difference between the corrections of two neighbouring nodes of a chart.
  // An edge at the border of a chart has half of this weight. For comparison, the squared
  // difference at an end of a seam has the weight 1.
  double smoothness = 0.01;
  // Weight of the squared correction itself, above 0. This term keeps the corrections from drifting
  // along chains of charts.
  double smallness = 1e-4;
};

struct LevelingOptions {
  bool global = true;  // smooth corrections of whole charts
  bool local = true;   // corrections in a strip along the seams, see level_charts()
  GlobalLevelingOptions global_options;
  int strip = 20;  // width of the strip [px]; the local correction reaches zero at this distance
};

// How the charts are placed in textures.
struct PackingOptions {
  int max_size = 8192;  // largest side of a texture [px]; 0: 32768, the packer's limit
  int multiple = 0;     // sides are multiples of this number [px]; 0: powers of two
};

// The size of a textured mesh.
struct ResultSize {
  std::size_t vertices = 0, faces = 0;
  std::vector<cv::Size> textures;
};

struct Options {
  // The number of tiles of texture_tiles(), from 1 to 1000, and their
  // axes (rows) in the frame of the mesh.
  std::size_t tiles = 1;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  SplitOptions split;
  VisibilityOptions visibility;
  // `threshold` of the test of outliers: the larger, the more views of faces are removed
  // because of their colours. 0: keep all views.
  double outlier_threshold = 0.06;
  LabelOptions labels;
  LevelingOptions leveling;
  PackingOptions packing;
  double sharpness_weight = 0;    // amount of an unsharp mask; 0: none
  Rgb empty_color{255, 127, 39};  // R G B; for faces that no view sees, and between the charts
  // Takes the mesh after splitting and the views of its faces, as find_face_views() returns them,
  // before views are removed. Called only if `tiles` is 1. An empty function: nothing is called.
  std::function<void(const Mesh&, const FaceViews&)> take_views;
  // The largest memory [bytes] that `images` needs while it makes an image, with the image.
  std::uint64_t image_bytes = 0;
  // The memory [bytes] that the caller needs afterwards to write the result, besides the result. An
  // empty function: none.
  std::function<std::uint64_t(const ResultSize&)> bytes_to_write;
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
// as chosen by choose_views(). A face that no view sees, or that
// is marked (Mesh::unseen), gets Options::empty_color. Marks are kept. Faces
// stay in the same order, and the parts of a split face follow each other at the place of this
// face. Vertices keep their indices, and the vertices that splitting adds follow. `report`, if
// given, is filled. Options::tiles has no effect.
//
// Context::memory() is for the memory besides `mesh`. The limit affects the time, but not the
// result.
//
// Throws an Error if check_mesh() refuses the mesh, for example a mesh without faces. Throws an
// Error if no view sees any face, if pack() refuses the options, or if the memory does not suffice
// for a stage. Exceptions of `images` are passed on.
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
//   - The tiles divide space. A face with a chart is in the tile
//     that contains most of the chart's faces: charts are not cut. A face without chart is in the
//     tile that contains its middle.
//   - Views are chosen tile by tile, mostly the same as in one piece.
//   - Seams between tiles are levelled like all seams, because the corrections are those of the
//     whole mesh. With the same views of faces, the pixels of each chart are those of
//     one piece.
//
// Photographs are read three times instead of twice if there are seams. A photograph is read again
// for each tile that uses it. Errors as for texture_mesh(). Exceptions of `take` are passed on.
void texture_tiles(Mesh mesh, std::span<const View> views, const ImageSource& images,
                   const Options& options, const TileSink& take, Report* report = nullptr,
                   const Context& context = {});

}  // namespace axial::texture
