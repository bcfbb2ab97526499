// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/scene_alignment.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "evaluate/shapes.h"

namespace axial::evaluate {
namespace {

Scene scene_of(const std::vector<std::string>& paths) {
  Scene scene;
  std::mt19937 random(4);
  for (const std::string& path : paths) {
    SceneImage image;
    image.path = path;
    image.pose = {random_rotation(random), random_vector(random, 3)};
    scene.images.push_back(std::move(image));
  }
  return scene;
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(SceneAlignment, PairsImagesByTheEndsOfTheirPaths) {
  const Scene scene = scene_of({"/a/left/1.jpg", "/a/right/1.jpg", "/a/2.jpg", "/a/3.jpg"});
  Scene other = scene_of({"/b/3.jpg", "/b/right/1.jpg", "/b/left/1.jpg", "/b/4.jpg"});
  ImagePairs found = pair_images(scene, other);
  EXPECT_TRUE(found.by_name);
  EXPECT_EQ(found.pairs, (Pairs{{0, 2}, {1, 1}, {3, 0}}));
  other.images[0].calibrated = false;  // two names are too few, and the numbers differ
  EXPECT_THROW(pair_images(scene, other), Error);
  other = scene_of({"w.jpg", "x.jpg", "y.jpg", "z.jpg"});
  found = pair_images(scene, other);
  EXPECT_FALSE(found.by_name);
  EXPECT_EQ(found.pairs, (Pairs{{0, 0}, {1, 1}, {2, 2}, {3, 3}}));
  EXPECT_THROW(pair_images(scene, scene_of({"x.jpg", "y.jpg", "z.jpg"})), Error);
}

TEST(SceneAlignment, LeavesAmbiguousNamesOut) {
  const Scene scene = scene_of({"/a/1.jpg", "/a/2.jpg", "/a/3.jpg", "/a/4.jpg"});
  const Scene other = scene_of({"/c/4.jpg", "/b/3.jpg", "/b/2.jpg", "/b/1.jpg", "/b/4.jpg"});
  EXPECT_EQ(pair_images(scene, other).pairs, (Pairs{{0, 3}, {1, 2}, {2, 1}}));
}

TEST(SceneAlignment, FindsTheSimilarity) {
  const Scene scene = scene_of({"1.jpg", "2.jpg", "3.jpg", "4.jpg"});
  std::mt19937 random(8);
  const Similarity truth{2.5, random_rotation(random), {5, -6, 7}};
  Scene other = scene;
  for (SceneImage& image : other.images) image.pose = truth(image.pose);
  const ImagePairs images = pair_images(scene, other);
  SceneAlignment found = align_scenes(scene, other, images, true);
  EXPECT_EQ(found.images, 4u);
  EXPECT_LT((found.similarity.matrix() - truth.matrix()).norm(), 1e-9);
  EXPECT_LT(found.largest, 1e-9);
  EXPECT_LT(*found.turn, 1e-7);
  found = align_scenes(scene, other, images, false);
  EXPECT_EQ(found.similarity.scale, 1);
  EXPECT_GT(found.rms, 0.1);
  EXPECT_LE(found.rms, found.largest);
}

}  // namespace
}  // namespace axial::evaluate
