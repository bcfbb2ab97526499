// SPDX-License-Identifier: GPL-3.0-or-later
// Photometric refinement of a triangle mesh: moves the vertices along their normals so that the
// photographs, projected onto the mesh by the exact cameras, agree with each other.
//
// Every ordered pair of a reference view and a source view is compared pixel by pixel. The pixel's
// point on the mesh is projected into the source view. The grey levels there, after a local
// correction of brightness and contrast (windows of 7 x 7 pixels, as in the zero-mean normalised
// cross-correlation), differ from those of the reference view by a residual e. If vertex k of the
// pixel's face moves by t_k along its normal, the residual changes by sum_k g_k t_k, where g
// follows from the image gradient, the camera's derivative d(pixel)/dX and the geometry of the
// face. One Gauss-Newton step minimises
//
//     sum over pairs and pixels of w (e + sum_k g_k t_k)^2
//       + lambda * integral of (mean curvature of the displaced surface)^2
//
// over all t at once, a sparse linear system. The weight w is the inverse of the variance that the
// residuals of the window show, so that occluded and badly matching windows hardly count.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "base/progress.h"
#include "scene/camera_model.h"
#include "scene/mesh.h"
#include "scene/pose.h"

namespace axial::refine {

// A view at the resolution at which it is compared.
struct View {
  CameraModel camera;  // a width of 0: the view is not used
  Pose pose;           // in the frame of the mesh
};

// The pixels of a view, in the size of its camera.
struct Picture {
  cv::Mat1b grey;
  cv::Mat1b mask;  // empty, or 0 where pixels are not used
};

// Returns the pixels of a view. Called by one thread at a time.
using Pictures = std::function<Picture(std::size_t view)>;

// Which ordered pairs (reference view, source view) of an unordered pair are compared.
enum class PairDirections { both, alternating, first_as_reference, second_as_reference };

struct Options {
  unsigned scales = 2;      // resolutions, from coarse to fine; at least 1
  double scale_step = 0.5;  // factor of the image size from a resolution to the next coarser one
  unsigned steps = 4;       // Gauss-Newton steps at each resolution
  // lambda, relative to the built-in value. 0: no smoothing.
  double smoothness = 1;
  PairDirections directions = PairDirections::both;
  // Before the first step, faces are split until no face is larger than this area [px^2] in the
  // second best of the views that see it. 0: no face is split.
  double max_face_area = 32;
  // Bounds of the work [bytes] besides the mesh; affects the time, but not the result.
  std::uint64_t cache_bytes = 256'000'000;
};

// What was done.
struct Report {
  std::size_t split_faces = 0;  // faces added by splitting
  std::size_t pairs = 0;        // ordered pairs that were compared
  std::size_t seen = 0;         // vertices with a measurement
  struct Step {
    double residual = 0;  // root of the mean weighted squared residual [standard deviations]
    double moved = 0;     // median displacement of the vertices with a measurement [mesh units]
  };
  std::vector<Step> steps;
};

// Refines `mesh`. `sources[i]` lists the source views of view i; a view without sources is no
// reference. Vertices that no pair measures and vertices on borders follow the smoothness of the
// surface around them or stay. Colours of new vertices are the mean of their edge's.
//
// Error (names no file) if the mesh has no faces, a face has an index out of range, a coordinate is
// not finite, or no view has sources. The result does not depend on the number of threads.
Report refine(Mesh& mesh, std::span<const View> views,
              const std::vector<std::vector<std::uint32_t>>& sources, const Pictures& pictures,
              const Options& options = {}, const ProgressSink& progress = {});

}  // namespace axial::refine
