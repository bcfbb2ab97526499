// SPDX-License-Identifier: GPL-3.0-or-later
// Refractive bundle adjustment.
#pragma once

#include <functional>

#include "base/context.h"
#include "pose/bundle/adjust_options.h"

namespace axial::pose {

// The state of an adjustment after an iteration of the solver.
struct AdjustIteration {
  int number = 0;      // 0: the evaluation of the start
  double cost = 0;     // half the cost of adjust()
  double seconds = 0;  // that the iteration took
};

// Receives the state after each iteration, in the thread of the caller.
using AdjustSink = std::function<void(const AdjustIteration&)>;

// How the solver ended.
struct AdjustReport {
  // False: it stopped at max_iterations, and the last one lowered half the cost by
  // AdjustOptions::gain_of_outliers or more.
  bool converged = false;
  int iterations = 0;                       // including the evaluation of the start
  double initial_cost = 0, final_cost = 0;  // half the cost of adjust()
};

// Refractive bundle adjustment: changes the poses, the points and the free numbers of the cameras
// (BundleCamera::change) to minimize the cost, from their present values. The cost is the sum of
// the squared reprojection errors of the exact projection (with Huber loss, in units of
// `pixel_sigma` times Observation::sigma) and of the squared deviations from known distances,
// positions, places, measured numbers and stated poses in rigs (in their standard deviations).
// Positions and places have a Huber loss, too: deviations of more than three standard deviations
// count linearly. The deviation of the photographs of a frame from their rig (rig.h) has Cauchy's
// loss with the scale 4.1, so that a photograph of another frame counts little.
//
// Without knowledge of positions, places, points or poses, the cost does not depend on where the
// model is in the world. The pose of one image therefore stays constant: of the first image with an
// observation or with a known distance or position. Exceptions: with three or more known positions
// or with known points, this pose is adjusted like all others, and with known poses, all poses stay
// constant. With known places, no pose stays constant, but motions of the whole model that change
// no known coordinate (free_motions.h) are excluded: the pose of this image does not follow them.
// Poses of images and positions of points that do not enter the cost stay unchanged. The solver
// runs in one thread, because sums over several threads would depend on the order of the threads.
//
// The solver factorises the normal equations with the points eliminated. Its memory and the time of
// an iteration depend on the pairs of images with common points. AdjustOptions::many_images says
// how bundles of many images are solved in fewer iterations. `sink` may be empty.
//
// A measured distance of a flat port does not become negative, and a measured index of the water
// not less than that of the air.
//
// Throws an Error if a number of a port is free for a camera in air, if a known length, a standard
// deviation of known values or `pixel_sigma` is not positive, if a known distance names a point
// that the bundle does not have, if the bundle has no observations, or if the solver fails. After
// an Error, or after a stop, the bundle is unchanged. Precondition: all indices are in their range.
AdjustReport adjust(Bundle& bundle, const AdjustOptions& options, const AdjustSink& sink = {},
                    const Context& context = {});

}  // namespace axial::pose
