// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary/sides.h"

#include <algorithm>
#include <cmath>

namespace axial::boundary {
namespace {

constexpr std::size_t kMostBins = 4096;

Eigen::AlignedBox2d box_of(const Side& side) {
  Eigen::AlignedBox2d box(side.from);
  return box.extend(side.to);
}

bool touch(const Eigen::AlignedBox2d& a, const Eigen::AlignedBox2d& b) {
  return (a.min().array() <= b.max().array() + kSame).all() &&
         (b.min().array() <= a.max().array() + kSame).all();
}

}  // namespace

Sides::Sides(const Boundary& boundary) {
  for (const Boundary::Polygon& polygon : boundary.polygons())
    for (const geometry::Ring& ring : polygon)
      for (std::size_t i = 0; i < ring.size(); ++i) {
        sides_.push_back({ring[i], ring[(i + 1) % ring.size()]});
        extent_.extend(ring[i]);
      }
  bins_.resize(std::min(kMostBins, sides_.size()));
  for (std::uint32_t i = 0; i < sides_.size(); ++i) {
    const Eigen::AlignedBox2d box = box_of(sides_[i]);
    for (std::size_t bin = bin_at(box.min().x()); bin <= bin_at(box.max().x()); ++bin)
      bins_[bin].push_back(i);
  }
}

std::size_t Sides::bin_at(double x) const {
  const double width = extent_.sizes().x();
  const double last = static_cast<double>(bins_.size() - 1);
  if (!(width > 0 && std::isfinite(width))) return 0;
  const double at = (x - extent_.min().x()) / width * static_cast<double>(bins_.size());
  return static_cast<std::size_t>(std::clamp(at, 0.0, last));
}

template <class Use>
bool Sides::visit(const Eigen::AlignedBox2d& box, const Use& use) const {
  if (!touch(box, extent_)) return false;
  const std::size_t last = bin_at(box.max().x() + kSame);
  for (std::size_t bin = bin_at(box.min().x() - kSame); bin <= last; ++bin)
    for (const std::uint32_t side : bins_[bin])
      if (touch(box_of(sides_[side]), box) && use(side)) return true;
  return false;
}

std::vector<std::uint32_t> Sides::near(const Eigen::AlignedBox2d& box) const {
  std::vector<std::uint32_t> found;
  visit(box, [&](std::uint32_t side) {
    found.push_back(side);
    return false;
  });
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool Sides::any_near(const Eigen::AlignedBox2d& box) const {
  return visit(box, [](std::uint32_t) { return true; });
}

}  // namespace axial::boundary
