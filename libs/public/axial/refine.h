// SPDX-License-Identifier: GPL-3.0-or-later
// Photometric refinement of a triangle mesh: moves the vertices along their normals so that the
// photographs, projected onto the mesh by the exact cameras, agree with each other.
//
// A pair consists of a reference view and a source view. The two views are compared at every pixel
// of the reference view. The pixel's point on the mesh is projected into the source view. The grey
// level of the source view at the projected point is corrected in brightness and contrast, so that
// mean and variance in windows of 7 x 7 pixels agree with those of the reference view (as in
// zero-mean normalised cross-correlation). The residual e is the corrected grey level minus the
// grey level of the reference view. If each corner k of the pixel's face moves by t_k along its
// vertex normal, e changes by sum_k g_k t_k. The factors g_k follow from the gradient of the source
// image, from the source camera's derivative of the pixel by the point, and from the normals of the
// face and its corners. A Gauss-Newton step minimises, over the displacements t of all vertices at
// once,
//
//       sum over pairs and pixels of w (e + sum_k g_k t_k)^2
//     + sum over vertices of a_v (t_v + o_v)^2
//     + smoothness * integral of s (curvature of the displaced surface)^2
//     + the squares of the slopes between displacements of neighbours.
//
// w: the inverse of the variance of the residuals in the window. So windows that look different in
// the two views, for example because of occlusion, count little.
// o_v: the signed distance along the normal from the vertex's first position to its position before
// the step. The first position is the vertex's position before the first step. It counts as a
// measurement.
// a_v: the weight of the first position. The weight grows with the information of the photographs
// on the vertex, and is small where the photographs contradict the first position.
// s: a factor that is less than one at edges of the surface.
// curvature: half of the mean curvature.
#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <span>
#include <utility>
#include <vector>

#include "axial/base.h"
#include "axial/geometry.h"
#include "axial/scene.h"

namespace axial::refine {

// A view at the resolution at which it is compared, in the frame of the mesh. A camera of the width
// 0: the view is not used.
using geometry::PosedCamera;

// The pixels of a view, in the size of its camera.
struct Picture {
  cv::Mat1b grey;
  cv::Mat1b mask;  // empty, or 0 where pixels are not used
};

// Returns the pixels of the view with the index `view`. Called by one thread at a time, several
// times for each view. It must return the same pixels each time.
using Pictures = std::function<Picture(std::size_t view)>;

// Which of the two views of a pair is the reference view.
enum class References {
  both,         // each view once, so that a pair is compared twice
  alternating,  // `first` in the first step, `second` in the next step, and so on
  first,        // the view with the smaller index
  second        // the view with the larger index
};

struct Options {
  unsigned scales = 2;      // resolutions, from coarse to fine; at least 1
  double scale_step = 0.5;  // image width of a resolution / width of the next finer resolution
  // The number of partners that a view chooses. More views may choose this view as their partner.
  unsigned max_views = 8;
  References references = References::both;
  double smoothness = 1000;  // factor of the smoothness term in the sum above; 0: none
  double anchor = 0.25;      // factor of a_v; 0: the first position does not count
  // Before the first step, a face is split if its area in the image is larger than this value
  // [px^2] in at least two views that see all three corners. The parts of a face are tested in the
  // same way, in at most six rounds of splitting. 0: no face is split.
  double max_face_area = 32;
  // The memory [bytes] for each vertex that the caller needs afterwards for the refined mesh, when
  // the memory of refine() is free again. The need is checked before the first step.
  std::uint64_t bytes_afterwards = 0;
};

// The result of refine(), besides the mesh.
struct Report {
  std::size_t split_faces = 0;  // number of faces that splitting has added
  std::size_t pairs = 0;        // number of pairs of views
  // Number of vertices that the last step measured: their position affects a residual.
  std::size_t measured = 0;
  unsigned steps = 0;  // number of Gauss-Newton steps at all resolutions
  // The median distance of the measured vertices from their positions before the first step [mesh
  // units].
  double moved = 0;
};

// The state of a refinement between two resolutions.
struct State {
  Mesh mesh;
  unsigned done = 0;  // number of resolutions that are done
  // The rest is empty if `done` is 0.
  std::vector<Eigen::Vector3f> first;  // positions of the vertices before the first step
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  // views that are compared
  Report report;
};

// Called after each resolution. The state is valid during the call.
using Checkpoint = std::function<void(const State& state)>;

// Refines `state.mesh`. First, large faces are split (Options::max_face_area). A vertex that
// splitting adds has the mean colour of the two ends of its edge. Second, folds are flattened.
// Third, Gauss-Newton steps move the vertices. The steps do not move vertices that no pair
// measures, unless measured vertices are near: there, the smoothness term moves them with the
// surface. Faces of the result may intersect each other. The result does not depend on the number
// of threads.
//
// `state`: a mesh alone, or a state that `checkpoint` received in a call with the same views,
// pictures and options. From such a state, the refinement goes on to the same result.
// `views`: all views. `pictures` is called with indices into `views`. The progress of the stage
// "Refined" never falls: it is the part of the expected work of this call, in which a resolution
// counts in proportion to its pixels.
//
// Throws an Error if check_mesh() refuses the mesh, for example a mesh without faces. Throws an
// Error if no two views see the same surface, or if the limit of Context::memory() is not enough
// for the memory besides the mesh and the images of `pictures`. The limit affects the time, but not
// the result. After the last two errors, faces of `state.mesh` may have been split.
void refine(State& state, std::span<const PosedCamera> views, const Pictures& pictures,
            const Options& options = {}, const Checkpoint& checkpoint = {},
            const Context& context = {});

// The same for a mesh alone, which is refined in place.
Report refine(Mesh& mesh, std::span<const PosedCamera> views, const Pictures& pictures,
              const Options& options = {}, const Context& context = {});

}  // namespace axial::refine
