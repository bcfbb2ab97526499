// SPDX-License-Identifier: GPL-3.0-or-later
// The scene of the matching benchmarks: a textured floor with a dome on it, imaged by a reference
// view and five source views, in air or behind a flat port, and hypotheses near its true surface.
#pragma once

#include <random>
#include <vector>

#include "depth/patch_match.h"
#include "depth/plane_map.h"
#include "depth/sweep/lane_matcher.h"

namespace axial::benchmarks {

inline constexpr int kSourceViews = 5;

struct Survey {
  std::vector<depth::MatchImage> views;  // the reference view, then the source views
  std::vector<DepthMap> maps;            // of `views`: true depths with typical noise
  std::vector<Eigen::Vector3f> points;   // sparse points in the world frame
  depth::PlaneMap truth;                 // true planes of the reference view
  std::vector<const depth::MatchImage*> sources;
  std::vector<const DepthMap*> source_maps;

  depth::MatchInput input() const { return {&views[0], sources, points}; }
};

// Returns the survey, with images of 512 x 384 pixels. The survey is made by the first call and
// kept in memory.
const Survey& survey(bool behind_port);

// Returns the true plane at pixel (x, y) with random changes: the depth changes by at most the
// fraction `depth`, and the normal turns by at most `turn` [rad].
depth::PlaneHypothesis near_truth(const Survey& survey, int x, int y, float depth, float turn,
                                  std::mt19937& random);

// A LaneMatcher for the survey, with its input. `geometric`: whether the input includes the depth
// maps of the source views.
template <class Camera>
class Bench {
 public:
  Bench(const Survey& survey, bool geometric, depth::lanes::InstructionSet set);

  const depth::LaneMatcher<Camera>& matcher() const { return matcher_; }

 private:
  std::vector<depth::QuadImage> quads_;
  depth::LaneMatcher<Camera> matcher_;
};

}  // namespace axial::benchmarks
