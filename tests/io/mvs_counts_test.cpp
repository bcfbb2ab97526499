// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/mvs_counts.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/memory.h"
#include "io/openmvs/mvs.h"
#include "support/analytic_scene.h"
#include "support/empty_folder.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

Scene make_scene(std::size_t images, std::size_t points, std::size_t track, std::size_t scores,
                 bool colors) {
  Scene scene = test::scene_of(test::dry_camera(), test::circle_of_poses(images));
  for (std::size_t i = 0; i < images; ++i) {
    scene.images[i].path = "images/" + std::to_string(i) + ".jpg";
    scene.images[i].id = static_cast<std::uint32_t>(i);
    for (std::size_t k = 0; k < std::min(scores, images - 1); ++k) {
      ViewScore score;
      score.image = static_cast<std::uint32_t>((i + 1 + k) % images);
      scene.images[i].neighbours.push_back(score);
    }
  }
  for (std::size_t p = 0; p < points; ++p) {
    SparsePoint point;
    for (std::size_t k = 0; k < (p + track) % (track + 1); ++k)
      point.views.push_back({static_cast<std::uint32_t>(k % images), 1});
    scene.points.push_back(point);
  }
  if (colors) scene.point_colors.resize(points);
  if (colors) scene.point_normals.assign(points, Eigen::Vector3f::UnitZ());
  return scene;
}

std::size_t number(std::size_t from, std::size_t to) {
  return *rc::gen::inRange(from, to);
}

RC_GTEST_PROP(MvsCounts, AreThoseOfTheSceneThatWasWritten, (bool colors)) {
  const fs::path folder = test::empty_folder(), file = folder / "scene.mvs";
  const Scene scene = make_scene(number(2, 9), number(0, 30), number(0, 5), number(0, 5), colors);
  write_mvs(file, scene, folder);
  const auto counts = count_mvs(file);
  RC_ASSERT(counts.has_value());
  const MvsCounts expected = count_scene(scene);
  RC_ASSERT(counts->images == expected.images);
  RC_ASSERT(counts->points == expected.points);
  RC_ASSERT(counts->observations == expected.observations);
  RC_ASSERT(counts->view_scores == expected.view_scores);
  RC_ASSERT(counts->view_list_bytes == expected.view_list_bytes);
  RC_ASSERT(counts->normals == expected.normals);
  RC_ASSERT(counts->colors == expected.colors);
  RC_ASSERT(counts->file_bytes == fs::file_size(file));
  RC_ASSERT(counts->file_bytes <= expected.file_bytes);
  fs::remove_all(folder);
}

// Only for files that are cut before the end of the counted part; the part after it is not read.
TEST(MvsCounts, AreNoneOfAFileThatIsCutOrGarbage) {
  const fs::path folder = test::empty_folder(), file = folder / "scene.mvs";
  write_mvs(file, make_scene(3, 5, 3, 2, true), folder);
  const std::string whole = read_file(file);
  const std::size_t behind = 3 * 8 + 16 * 8 + 9 * 8 + 6 * 8 + 16;  // lines, transform, region
  for (std::size_t length = 0; length + behind < whole.size(); ++length) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, length);
    EXPECT_FALSE(count_mvs(file)) << length;
  }
  for (std::size_t at = 12; at + 8 <= whole.size(); at += 3) {
    std::string wrong = whole;
    wrong.replace(at, 8, "\xff\xff\xff\xff\xff\xff\xff\xff");
    std::ofstream(file, std::ios::binary) << wrong;
    EXPECT_NO_THROW(count_mvs(file)) << at;
  }
  EXPECT_FALSE(count_mvs(folder / "nowhere.mvs"));
  EXPECT_FALSE(count_mvs(folder));
  fs::remove_all(folder);
}

// The heap allocates large blocks in pages.
constexpr std::uint64_t kPages = 1 << 16;

// The estimate is an upper bound of the memory, and a tight one.
TEST(MvsCounts, TellWhatTheSceneTakesInMemory) {
  const fs::path folder = test::empty_folder(), file = folder / "scene.mvs";
  struct Case {
    std::size_t images, points, track, scores;
  };
  for (const Case& c : {Case{3, 200'000, 2, 0}, Case{20, 50'000, 15, 0}, Case{4000, 10, 2, 100}}) {
    write_mvs(file, make_scene(c.images, c.points, c.track, c.scores, true), folder);
    const std::uint64_t planned = count_mvs(file)->scene_bytes();
    const std::uint64_t before = allocated_memory();
    const Scene scene = read_mvs(file, folder);
    const std::uint64_t taken = allocated_memory() - before;
    EXPECT_LE(taken, planned + kPages) << c.images;
    EXPECT_GE(taken, planned / 10 * 7) << c.images;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace axial::io
