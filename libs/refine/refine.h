// SPDX-License-Identifier: GPL-3.0-or-later
// Photometric refinement of a triangle mesh: moves the vertices along their normals so that the
// photographs, projected onto the mesh by the exact cameras, agree with each other.
//
// The two views of a pair are compared at every pixel of one of them, the reference view. The
// pixel's point on the mesh is projected into the other one, the source view. The grey level there,
// after a local correction of brightness and contrast (in windows of 7 x 7 pixels, as by zero-mean
// normalised cross-correlation), differs from that of the reference view by a residual e. If corner
// k of the pixel's face moves by t_k along its normal, the residual changes by sum_k g_k t_k, where
// g follows from the image gradient, from the source camera's d(pixel)/dX and from the face. A
// Gauss-Newton step minimises over the displacements t of all vertices at once
//
//       sum over pairs and pixels of w (e + sum_k g_k t_k)^2
//     + sum over vertices of a_v (t_v + o_v)^2
//     + smoothness * integral of s (curvature of the displaced surface)^2
//     + the squares of the slopes between displacements of neighbours (system.h).
//
// w: the inverse of the variance of the residuals in the window, so that occluded and otherwise
// different windows count little. o_v: the distance that the vertex has come from its first
// position, which is a measurement, too; its weight a_v is proportional to the information of the
// photographs on the vertex, and small where they contradict the first position (anchor.h). s: less
// than one at edges of the surface.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "base/progress.h"
#include "base/setting_names.h"
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

// Which of the two views of a pair is the reference view.
enum class References {
  both,         // each of them once
  alternating,  // the first one and the second one by turns, from step to step
  first,        // the view with the smaller index
  second
};

struct Options {
  unsigned scales = 2;      // resolutions, from coarse to fine; at least 1
  double scale_step = 0.5;  // size of the image relative to the next finer resolution
  unsigned max_views = 8;   // partners of a view that the view chooses; others may choose it, too
  References references = References::both;
  double smoothness = 1000;  // 0: none
  double anchor = 0.25;      // factor of a_v; 0: the first position does not count
  // Before the first step, faces are split until no face is larger than this area [px^2] in the
  // second best of the views that see it. 0: no face is split.
  double max_face_area = 32;
  // The memory [bytes] that refine() may use besides the mesh it is given and `pictures`. It
  // affects the time, but not the result. 0: no limit.
  std::uint64_t max_bytes = 0;
  // How errors name the field max_bytes ("max_memory").
  SettingNames name_of = own_name;
};

// What was done.
struct Report {
  std::size_t split_faces = 0;  // number of faces that splitting has added
  std::size_t pairs = 0;        // of views
  std::size_t measured = 0;     // number of vertices that the last step measured
  unsigned steps = 0;
  // Of the measured vertices: median distance to their first positions [mesh units].
  double moved = 0;
};

// Refines `mesh`. Folds narrower than the noise are flattened first (displace.h). Then, vertices
// that no pair measures stay, except near measured ones, where the surface stays smooth. Faces may
// intersect each other afterwards. A vertex that splitting adds has the mean colour of its edge.
//
// Error if the mesh has no faces, a face has an index out of range, a coordinate is not finite, no
// two views see the same surface, or max_bytes is not enough. The result does not depend on the
// number of threads.
Report refine(Mesh& mesh, std::span<const View> views, const Pictures& pictures,
              const Options& options = {}, const ProgressSink& progress = {});

}  // namespace axial::refine
