// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/visible_area.h"

#include <cmath>

#include "base/parallel.h"

namespace axial::refine {
namespace {

float area_of(const VertexImage& a, const VertexImage& b, const VertexImage& c) {
  return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

}  // namespace

std::vector<bool> larger_than(double limit, const Mesh& mesh, const ScaledViews& views,
                              const Visibility& visibility, MeshImages& images) {
  std::vector<std::uint8_t> count(mesh.faces.size());
  for (std::size_t i = 0; i < views.count(); ++i) {
    if (!views.used(i)) continue;
    const auto image = images.get(i);
    parallel_for(
        mesh.faces.size(),
        [&](std::size_t f) {
          const auto& [a, b, c] = mesh.faces[f];
          if (count[f] < 2 && visibility.seen(a, i) && visibility.seen(b, i) &&
              visibility.seen(c, i) && area_of((*image)[a], (*image)[b], (*image)[c]) > limit)
            ++count[f];
        },
        kPointGrain);
  }
  std::vector<bool> large(mesh.faces.size());
  for (std::size_t f = 0; f < large.size(); ++f) large[f] = count[f] == 2;
  return large;
}

}  // namespace axial::refine
