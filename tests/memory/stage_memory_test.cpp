// SPDX-License-Identifier: GPL-3.0-or-later
// What the stages say that they need, against the memory that they use.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "base/memory.h"
#include "cloud/fuse.h"
#include "cloud/fusion_map.h"
#include "densify/pinhole_model.h"
#include "depth/filters.h"
#include "depth/patch_match.h"
#include "geometry/face_sights.h"
#include "io/images/image.h"
#include "io/openmvs/dmap.h"
#include "map/pixel_width.h"
#include "mesh/clean.h"
#include "mesh/reconstruct.h"
#include "mesh/sphere_cloud.h"
#include "mesh/unseen.h"
#include "refine/memory.h"
#include "refine/photographed_mesh.h"
#include "support/analytic_scene.h"
#include "support/empty_folder.h"
#include "survey/image_store.h"
#include "texture/faces/adjacency.h"

namespace axial {
namespace {

std::uint64_t bytes_of(const std::vector<cv::Mat>& images) {
  std::uint64_t bytes = 0;
  for (const cv::Mat& image : images) bytes += image.total() * image.elemSize();
  return bytes;
}

TEST(StageMemory, OfImagesAndMapsIsExact) {
  const auto folder = test::empty_folder();
  survey::Survey project;
  io::write_png(folder / "image.png", cv::Mat3b(72, 96, cv::Vec3b(10, 20, 30)));
  io::write_png(folder / "mask.png", cv::Mat1b(72, 96, uchar{1}));
  project.options.ignore_mask_label = 0;
  project.views.resize(1);
  project.views[0].file = folder / "image.png";
  project.views[0].camera = test::dry_camera();
  project.views[0].header = io::read_image_header(folder / "image.png");
  for (const bool mask : {false, true})
    for (const bool color : {false, true}) {
      project.views[0].mask = mask ? folder / "mask.png" : std::filesystem::path();
      const auto image =
          survey::ImageStore(project, color ? survey::Channels::both : survey::Channels::grey, 1)
              .get(0);
      EXPECT_EQ(survey::bytes_needed(survey::PixelsSize{72 * 96, mask, color}),
                bytes_of({image->grey, image->color, image->mask}));
    }
  const DepthMap map = test::exact_map({}, test::dry_camera(), {});
  EXPECT_EQ(bytes_of_depths(72 * 96), bytes_of({map.depth}));
  EXPECT_EQ(bytes_of_map(72 * 96), bytes_of({map.depth, map.normal, map.confidence}));
  for (const bool color : {false, true}) {
    const cv::Mat3b colors = color ? cv::Mat3b(72, 96) : cv::Mat3b();
    const cloud::FusionMap fused = cloud::make_fusion_map(map, colors);
    EXPECT_EQ(cloud::bytes_needed({72 * 96, 0, 1, color}),
              bytes_of({fused.depth, fused.normal, fused.weight, fused.color}));
  }
}

// A value of /proc/self/status [bytes].
std::uint64_t status(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (std::uint64_t kilobytes = 0; word == name + ":" && file >> kilobytes)
      return 1024 * kilobytes;
  return 0;
}

// As in the programs, and before the first thread starts.
[[maybe_unused]] const bool kOneHeap = (share_one_heap(), true);

// The largest number of bytes that were resident while `run` ran, besides those before. Empty if
// the system cannot forget an earlier peak.
template <class Run>
std::optional<std::uint64_t> peak_of(const Run& run) {
  return_freed_memory();
  std::ofstream("/proc/self/clear_refs") << 5;
  const std::uint64_t before = status("VmHWM");
  if (before > resident_memory() + (4u << 20)) return {};
  run();
  return status("VmHWM") - before;
}

// Threads, small blocks and what a call allocates once.
constexpr std::uint64_t kSmallBlocks = 12u << 20;

// A stage with its input.
struct Work {
  std::uint64_t need = 0;  // what the stage says that it needs [bytes]
  std::function<void()> run;
};

struct Stage {
  const char* name;
  // The share of the need that is used at least. A need of much more than the use would make runs
  // slow that have little memory.
  double use = 0;
  std::function<Work()> prepare;
};

void PrintTo(const Stage& stage, std::ostream* out) {
  *out << stage.name;
}

class StagePeak : public testing::TestWithParam<Stage> {};

TEST_P(StagePeak, IsWithinTheNeed) {
#ifdef AXIAL_SANITIZED
  GTEST_SKIP() << "the sanitizer keeps freed blocks to itself";
#endif
  const Work work = GetParam().prepare();
  work.run();  // starts threads and loads code
  const auto peak = peak_of(work.run);
  if (!peak) GTEST_SKIP() << "the system does not measure the peak";
  EXPECT_LE(*peak, work.need + kSmallBlocks);
  EXPECT_GE(static_cast<double>(*peak), GetParam().use * static_cast<double>(work.need));
}

constexpr std::uint64_t kPixels = 960 * 720;

CameraModel large_camera() {
  return test::dry_camera().resized(960, 720);
}

// Five photographs of a wall with a pattern.
struct Photographs {
  Photographs() {
    const CameraModel camera = large_camera();
    const std::vector<Pose> poses = test::circle_of_poses(5);
    for (std::uint32_t i = 0; i < 5; ++i) {
      cv::Mat1b grey(camera.height, camera.width);
      cv::RNG(i).fill(grey, cv::RNG::UNIFORM, 0, 255);
      views.push_back({i, camera, poses[i], grey});
    }
    for (std::size_t i = 1; i < 5; ++i) sources.push_back(&views[i]);
  }

  std::vector<depth::MatchImage> views;
  std::vector<const depth::MatchImage*> sources;
  const std::vector<Eigen::Vector3f> points{{0, 0, 1}, {0.1f, 0, 0.9f}};
};

// The need includes the copies of the filters, which this call does not make.
Work matching() {
  const auto given = std::make_shared<Photographs>();
  return {depth::bytes_needed(depth::MatchSize{kPixels, 4}), [given] {
            depth::PatchMatchOptions options;
            options.iterations = 1;
            depth::estimate_depth_map({&given->views[0], given->sources, given->points}, options);
          }};
}

Work adjusting() {
  std::vector<DepthMap> maps;
  for (const depth::MatchImage& view : Photographs().views)
    maps.push_back(test::exact_map({}, view.camera, view.pose));
  return {depth::bytes_needed(depth::AdjustSize{kPixels, 4}), [maps] {
            depth::adjust_with_neighbours(maps[0], {maps.begin() + 1, maps.end()});
          }};
}

std::filesystem::path map_file() {
  return std::filesystem::path(testing::TempDir()) / "stage_memory_map.dmap";
}

Work writing_map() {
  DepthMap map = test::exact_map({}, large_camera(), {});
  map.ids = {0};
  return {io::dmap_bytes_needed(kPixels), [map] { io::write_dmap(map_file(), map, "print"); }};
}

Work reading_map() {
  writing_map().run();
  return {io::dmap_bytes_needed(kPixels) + bytes_of_map(kPixels),
          [] { io::read_dmap(map_file()); }};
}

// 200,000 points that four images see.
Scene seen_points() {
  Scene scene;
  scene.images.resize(4);
  for (std::uint32_t i = 0; i < 4; ++i) {
    scene.images[i].path = "/images/" + std::to_string(i);
    scene.images[i].id = i;
    scene.images[i].camera = large_camera();
  }
  scene.points.assign(200000, {{0, 0, 1}, {{0, 0}, {1, 0}, {2, 0}, {3, 0}}});
  return scene;
}

Work writing_pinhole_model() {
  const auto scene = std::make_shared<Scene>(seen_points());
  const auto points =
      std::make_shared<densify::PinholePoints>(*scene, std::vector<std::size_t>{0, 1, 2, 3});
  const cloud::PinholeView view{large_camera(), Eigen::Vector3d::Zero(), true};
  const cv::Size size(view.camera.width, view.camera.height);
  for (std::size_t i = 0; i < 4; ++i)
    points->find(i, view,
                 {cv::Mat3b(size, cv::Vec3b()), cv::Mat1b(size, cloud::kExact),
                  cv::Mat1b(size, std::uint8_t{255})});
  return {densify::bytes_needed_for_pinhole_model(*scene), [scene, points] {
            Scene exported;
            exported.images = scene->images;
            points->give_to(exported);
            const auto folder = std::filesystem::path(testing::TempDir()) / "stage_memory_model";
            EXPECT_EQ(densify::write_pinhole_model(folder, exported, "/images").points, 200000u);
          }};
}

// A photographed mesh of 135,000 vertices, seen from above.
struct Surface {
  test::PhotographedMesh scene;
  Mesh mesh = scene.mesh(0.001, 0.003);
};

// The work on a Surface, whose need depends on its mesh.
Work on_mesh(std::uint64_t (*need)(const Mesh&), std::function<void(const Surface&)> run) {
  const auto given = std::make_shared<Surface>();
  return {need(given->mesh), [given, run = std::move(run)] { run(*given); }};
}

std::uint64_t to_clean(const Mesh& mesh) {
  return mesh::bytes_to_clean(mesh.vertices.size());
}

std::uint64_t to_pair(const Mesh& mesh) {
  return texture::bytes_to_pair(mesh.faces.size());
}

std::uint64_t to_refine(const Mesh& mesh) {
  const std::uint64_t copy = (mesh.vertices.size() + mesh.faces.size()) * 12;
  return refine::bytes_needed({mesh.vertices.size(), mesh.faces.size(), 6, 200 * 150}, 6) + copy;
}

Work reconstructing() {
  const Scene scene = test::cameras_around_sphere(false);
  const PointCloud cloud = test::points_on_sphere(scene, 60'000);
  return {mesh::bytes_needed(cloud.size()), [=] {
            mesh::ReconstructOptions options;
            options.merge.min_distance = 0;
            mesh::reconstruct(cloud, scene, options);
          }};
}

const std::vector<Stage> kStages{
    {"Matching", 0.35, matching},
    {"Adjusting", 0.5, adjusting},
    {"WritingAMap", 0.3, writing_map},
    {"ReadingAMap", 0.3, reading_map},
    {"Reconstructing", 0.35, reconstructing},
    {"Cleaning", 0.3, [] { return on_mesh(to_clean, [](const auto& s) { mesh::clean(s.mesh); }); }},
    {"Refining", 0.3,
     [] {
       return on_mesh(to_refine, [](const auto& s) {
         Mesh mesh = s.mesh;
         refine::Options options;
         options.scales = 1;
         options.max_face_area = 0;
         s.scene.refine(mesh, options);
       });
     }},
    {"WritingPinholeModel", 0.3, writing_pinhole_model},
    {"Sights", 0.3,
     [] {
       return on_mesh(geometry::bytes_of_sights,
                      [](const auto& s) { geometry::count_sights(s.mesh, s.scene.views); });
     }},
    {"Cosines", 0.3,
     [] {
       return on_mesh(geometry::bytes_of_cosines,
                      [](const auto& s) { geometry::second_cosines(s.mesh, s.scene.views, 1); });
     }},
    {"Unseen", 0.3,
     [] {
       return on_mesh(mesh::bytes_of_unseen,
                      [](const auto& s) { mesh::treat_unseen(s.mesh, s.scene.views, {}); });
     }},
    {"PixelWidth", 0.3,
     [] {
       return on_mesh(map::bytes_of_pixel_width,
                      [](const auto& s) { map::median_pixel_width(s.mesh, s.scene.views); });
     }},
    {"PairsOfFaces", 0.3,
     [] { return on_mesh(to_pair, [](const auto& s) { texture::face_pairs(s.mesh.faces); }); }}};

INSTANTIATE_TEST_SUITE_P(Stages, StagePeak, testing::ValuesIn(kStages),
                         [](const auto& stage) { return std::string(stage.param.name); });

}  // namespace
}  // namespace axial
