// SPDX-License-Identifier: GPL-3.0-or-later
// Exact depth maps of a surface, ready to be fused, for the tests of fusion.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <vector>

#include "cloud/fuse.h"
#include "support/analytic_scene.h"

namespace axial::cloud {

using test::AnalyticScene;

struct Fixture {
  Scene scene;
  std::vector<FusionView> views;
  std::vector<DepthMap> maps;
  std::map<std::size_t, int> loads;

  FusionProviders providers() {
    return {[this](std::size_t i) {
              ++loads[i];
              return maps[i];
            },
            {}};
  }
};

inline Fixture make_fixture(const AnalyticScene& world, const CameraModel& model,
                            std::size_t count = 5) {
  Fixture fixture;
  fixture.scene = test::scene_of(model, test::circle_of_poses(count));
  for (std::uint32_t i = 0; i < count; ++i) {
    fixture.maps.push_back(exact_map(world, model, fixture.scene.images[i].pose));
    FusionView view;
    view.image = i;
    for (std::uint32_t k = 1; k < count; ++k) {
      view.neighbours.push_back((i + k) % static_cast<std::uint32_t>(count));
    }
    view.rank = count - 1;
    fixture.views.push_back(view);
  }
  return fixture;
}

inline PointCloud run(Fixture& fixture, const FuseOptions& options = {}) {
  return fuse(fixture.scene, fixture.views, fixture.providers(), options);
}

inline bool same_bytes(const PointCloud& a, const PointCloud& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() &&
           (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return same(a.positions, b.positions) && same(a.normals, b.normals) && same(a.colors, b.colors) &&
         same(a.view_begin, b.view_begin) && same(a.view_images, b.view_images) &&
         same(a.view_weights, b.view_weights) && same(a.errors, b.errors) &&
         same(a.confidences, b.confidences);
}

class FuseWithCamera : public testing::TestWithParam<bool> {
 protected:
  static CameraModel model() {
    return GetParam() ? test::behind_port(test::dry_camera()) : test::dry_camera();
  }
};

}  // namespace axial::cloud
