// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/images/photograph_size.h"

#include <algorithm>

#include "base/error.h"
#include "scene/resolution.h"

namespace axial::io {
namespace {

// The longer side of the photograph divided by that of the camera.
double size_ratio(const PhotographSize& photograph) {
  return static_cast<double>(std::max(photograph.stored.width, photograph.stored.height)) /
         std::max(photograph.camera.width, photograph.camera.height);
}

void require_size(const PhotographSize& photograph) {
  const cv::Size& stored = photograph.stored;
  const cv::Size& camera = photograph.camera;
  constexpr double kSmallest = 1.0 / 8;
  if (!(size_ratio(photograph) >= kSmallest))
    fail_in(photograph.file, "is {}x{}, too small for its camera, which is {}x{}", stored.width,
            stored.height, camera.width, camera.height);
  if (!same_shape(stored, camera))
    fail_in(photograph.file, "is {}x{}, but its camera is {}x{}", stored.width, stored.height,
            camera.width, camera.height);
}

}  // namespace

void check_photograph_sizes(std::span<const PhotographSize> photographs, const Context& context) {
  constexpr double kWhole = 0.9;
  const PhotographSize* first = nullptr;
  std::size_t small = 0;
  for (const PhotographSize& photograph : photographs) {
    require_size(photograph);
    if (size_ratio(photograph) >= kWhole) continue;
    if (first == nullptr) first = &photograph;
    ++small;
  }
  if (first == nullptr) return;
  context.warning(
      "{}: is {}x{}, but its camera is {}x{}: {} of {} photographs are smaller than their cameras, "
      "and detail is lost",
      first->file.string(), first->stored.width, first->stored.height, first->camera.width,
      first->camera.height, small, photographs.size());
}

}  // namespace axial::io
