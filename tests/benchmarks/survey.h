// SPDX-License-Identifier: GPL-3.0-or-later
// The scene of the matching benchmarks: a textured floor with a dome on it, imaged by a reference
// view and five source views, in air or behind a flat port, and hypotheses near its true surface.
#pragma once

#include <random>
#include <vector>

#include "depth/lane_matcher.h"
#include "depth/patch_match.h"
#include "depth/plane_map.h"

namespace axial::benchmarks {

inline constexpr int kSourceViews = 5;

struct Survey {
  std::vector<depth::MatchImage> views;  // the reference first
  std::vector<DepthMap> maps;            // the truth with typical noise
  std::vector<Eigen::Vector3f> points;   // sparse, world frame
  depth::PlaneMap truth;                 // of the reference
  std::vector<const depth::MatchImage*> sources;
  std::vector<const DepthMap*> source_maps;

  depth::MatchInput input() const { return {&views[0], sources, points}; }
};

// Made once and kept in memory. Images of 512 x 384 pixels.
const Survey& survey(bool behind_port);

// The true plane at a pixel, changed by at most `depth` (relative) and `turn` [rad].
depth::PlaneHypothesis near_truth(const Survey& survey, int x, int y, float depth, float turn,
                                  std::mt19937& random);

// The input of a LaneMatcher, with or without the sources' depth maps.
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
