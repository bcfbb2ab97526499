// SPDX-License-Identifier: GPL-3.0-or-later
// The error of each warp of a patch, as in the paper's figures 3 and 4: a 9x9 window, every second
// pixel, mapped from one camera behind a flat port to another by a plane.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "experiments/setup.h"
#include "refractive/line_search.h"

namespace axial::experiments {

// In the order of the tables. Where a virtual camera replaces the reference camera, it is the exact
// one.
enum class Warp : std::size_t {
  // homography of virtual cameras with f_v = f; the source's virtual camera is looked up at the
  // pixel nearest to the result of Algorithm 1
  kPapers,
  kRounded,        // the same, looked up at the pixel nearest to the exact projection
  kExactCentre,    // the same, at the exact projection
  kScaledRounded,  // locally correct virtual scale, nearest pixel
  kScaled,         // locally correct virtual scale, exact projection
  kFirstOrder,     // exact centre and exact first derivative
  kPerTexel,       // exact projection of every texel, in float
};
inline constexpr std::size_t kWarps = 7;
inline constexpr std::array<const char*, kWarps> kWarpNames{
    "papers", "rounded", "exact_centre", "scaled_rounded", "scaled", "first_order", "per_texel"};

inline constexpr int kPatchReach = 4, kPatchStep = 2, kPatchSide = 5;
inline constexpr std::size_t kPatchTexels = 25;  // row by row
inline constexpr std::size_t kPatchCentre = 12;

// The error e_H [px] of every texel.
using TexelErrors = std::array<double, kPatchTexels>;
double mean_error(const TexelErrors& errors);  // the paper's e_BH

struct PatchErrors {
  std::array<TexelErrors, kWarps> warps;
  const TexelErrors& operator[](Warp warp) const { return warps[static_cast<std::size_t>(warp)]; }
};

class WarpStudy {
 public:
  // Images of size x size pixels, whose middle `fov_size` pixels span the field of view (0: all
  // pixels).
  WarpStudy(const StereoSetup& setup, int size, int fov_size = 0);

  // The errors of the patch at `centre` [px]. Empty if the plane's point is not visible, or if the
  // true image of a texel is outside the second image.
  std::optional<PatchErrors> errors(const Vector2<double>& centre) const;

  int size() const { return size_; }

 private:
  struct Warps;
  std::optional<Warps> make_warps(const Vector2<double>& centre) const;
  std::optional<Vector2<double>> true_image(const Vector2<double>& q) const;
  Vector2<double> single_image(const Vector2<double>& q) const;

  int size_;
  refractive::LineSearchCamera<double> papers_;
  FlatPortCamera<double> camera_;
  FlatPortCamera<float> single_;
  Vector3<double> source_, plane_point_, plane_normal_;
};

// Statistics of the centres whose patch lies in both images.
struct WarpStatistics {
  double mean = 0;            // of e_BH [px]
  double largest = 0;         // of e_BH
  double mean_at_centre = 0;  // of e_H of the middle texel
};

struct StudyStatistics {
  std::int64_t centres = 0;
  std::array<WarpStatistics, kWarps> warps;
  // Shares of the centres. The warp's part of the error is e_BH with an exact centre. The part of
  // rounding is e_H of the middle texel, where the homography has no other error.
  double rounding_over_warp = 0;         // rounding causes the larger part, nearest pixel
  double papers_rounding_over_warp = 0;  // the same, with the result of Algorithm 1
  double middle_not_least = 0;  // paper's warp: another texel has less error than the middle one

  const WarpStatistics& operator[](Warp w) const { return warps[static_cast<std::size_t>(w)]; }
};

// Statistics over every `step`-th centre in each direction.
StudyStatistics study_statistics(const WarpStudy& study, int step);

// e_BH [px] of one warp for every centre from kPatchReach to size - 1 - kPatchReach, row by row. -1
// where errors() is empty.
std::vector<double> patch_error_map(const WarpStudy& study, Warp warp);

// e_H [px] of every texel of every centre from `border` to size - 1 - border. Patches lie side by
// side, so that the map is kPatchSide times as wide as the range of centres. -1 where errors() is
// empty.
std::vector<double> exploded_error_map(const WarpStudy& study, Warp warp, int border = kPatchReach);

}  // namespace axial::experiments
