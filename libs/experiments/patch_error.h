// SPDX-License-Identifier: GPL-3.0-or-later
// The errors of warps of a patch, as in the paper's figures 3 and 4. The patch contains every
// second pixel (texel) of a 9x9 window, and shows a plane. A warp maps the patch from the image of
// the first camera of a StereoSetup, the reference, to the image of the second camera, the source.
// The true image of a texel is the exact projection, in double, of the point of the plane that the
// texel shows. The error e_H of a texel is the distance [px] between the warped texel and its true
// image. The error e_BH of a patch is the mean of e_H over its texels. "Algorithm 1" is the paper's
// projection (refractive/line_search.h).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "experiments/setup.h"
#include "refractive/line_search.h"

namespace axial::experiments {

// The warps, in the order of the tables. The first five are homographies between virtual cameras.
// The virtual camera of the reference belongs to the centre of the patch. The five differ in the
// scale (focal length f_v) of the virtual cameras, and in the pixel to which the virtual camera of
// the source belongs. Their comments name the scale, then this pixel.
enum class Warp : std::size_t {
  kPapers,         // f_v = f; the pixel nearest to the result of Algorithm 1
  kRounded,        // f_v = f; the pixel nearest to the exact projection
  kExactCentre,    // f_v = f; the exact projection, not rounded
  kScaledRounded,  // locally correct scale; the pixel nearest to the exact projection
  kScaled,         // locally correct scale; the exact projection, not rounded
  kFirstOrder,     // affine warp: exact projection of the centre and exact first derivative
  kPerTexel,       // exact projection of every texel, in float
};
// The number of warps, and their names in the results of experiments, in the order of Warp.
inline constexpr std::size_t kWarps = 7;
inline constexpr std::array<const char*, kWarps> kWarpNames{
    "papers", "rounded", "exact_centre", "scaled_rounded", "scaled", "first_order", "per_texel"};

// The distance from the centre of the patch to its outermost rows and columns of texels [px], the
// distance between neighbouring texels [px], and the number of texels in a row.
inline constexpr int kPatchReach = 4, kPatchStep = 2, kPatchSide = 5;
// The number of texels, and the index of the middle texel. Texels are in the order row by row.
inline constexpr std::size_t kPatchTexels = 25;
inline constexpr std::size_t kPatchCentre = 12;

// The error e_H [px] of every texel, row by row.
using TexelErrors = std::array<double, kPatchTexels>;
double mean_error(const TexelErrors& errors);  // e_BH [px]

// The errors of one patch by each warp.
struct PatchErrors {
  std::array<TexelErrors, kWarps> warps;  // in the order of Warp
  const TexelErrors& operator[](Warp warp) const { return warps[static_cast<std::size_t>(warp)]; }
};

// Measures the errors of all warps in one stereo setup.
class WarpStudy {
 public:
  // Both images have size x size pixels. The middle `fov_size` pixels of the width span the field
  // of view of the setup. The other pixels are a border. If `fov_size` is 0, the whole width spans
  // the field of view.
  WarpStudy(const StereoSetup& setup, int size, int fov_size = 0);

  // Returns the errors of the patch at `centre` [px] of the reference image. Returns nothing if the
  // ray of a texel does not meet the plane, if the exact projection or Algorithm 1 reports that the
  // source camera does not see the point of the plane at the centre, or if the true image of a
  // texel is outside the source image.
  std::optional<PatchErrors> errors(const Vector2<double>& centre) const;

  int size() const { return size_; }  // width and height of both images [px]

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

// Statistics of one warp over the centres for which WarpStudy::errors() returns errors.
struct WarpStatistics {
  double mean = 0;            // of e_BH [px]
  double largest = 0;         // of e_BH [px]
  double mean_at_centre = 0;  // of e_H of the middle texel [px]
};

// Statistics of all warps. Without centres all numbers are 0.
struct StudyStatistics {
  std::int64_t centres = 0;  // number of centres for which WarpStudy::errors() returns errors
  std::array<WarpStatistics, kWarps> warps;  // in the order of Warp
  // The next three fields are shares of the centres. Let W be e_BH of kExactCentre, which is the
  // error that the homography causes. Let R be e_H of the middle texel, which is the error that
  // rounding causes, because a homography has no other error at the middle texel.
  double rounding_over_warp = 0;         // R of kRounded is larger than W
  double papers_rounding_over_warp = 0;  // R of kPapers is larger than W
  double middle_not_least = 0;           // e_H of another texel of kPapers is smaller than R

  const WarpStatistics& operator[](Warp w) const { return warps[static_cast<std::size_t>(w)]; }
};

// Returns the statistics over every `step`-th centre in each direction. The centres range from
// kPatchReach to size - 1 - kPatchReach, with size = study.size(). Precondition: `step` is at least
// 1.
StudyStatistics study_statistics(const WarpStudy& study, int step);

// Returns e_BH [px] of one warp for every centre from kPatchReach to size - 1 - kPatchReach in each
// direction, row by row, with size = study.size(). The value is -1 where WarpStudy::errors()
// returns nothing.
std::vector<double> patch_error_map(const WarpStudy& study, Warp warp);

// Returns e_H [px] of one warp for every texel of the patch of every centre, as a map, row by row.
// The centres range from `border` to size - 1 - border in each direction, with size = study.size().
// The map shows the patches side by side, so it is kPatchSide times as wide and high as the range
// of centres. The value is -1 where WarpStudy::errors() returns nothing.
std::vector<double> exploded_error_map(const WarpStudy& study, Warp warp, int border = kPatchReach);

}  // namespace axial::experiments
