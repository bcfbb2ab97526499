// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/dmap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>
#include <limits>

#include "base/atomic_file.h"
#include "io/wrong_input.h"
#include "refractive/flat_port_camera.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

enum class Port { none, flat, dome };

// A tilted thick port. The virtual centre is centimetres away from the camera centre.
refractive::FlatPort<double> flat_port() {
  return {Eigen::Vector3d(0.2, -0.1, 1).normalized(), 0.05, 0.02, 1, 1.49, 1.34};
}

refractive::DomePort<double> dome_port() {
  return {{0.01, -0.02, 0.005}, 0.06, 0.02, 1, 1.49, 1.34};
}

CameraModel camera(Port port) {
  CameraModel model;
  model.width = 9;
  model.height = 7;
  model.lens = {6, 6.5, 3.9, 3.1};  // about 75 degrees wide
  if (port == Port::flat) model.port = flat_port();
  if (port == Port::dome) model.port = dome_port();
  return model;
}

DepthMap depth_map(const fs::path& folder, Port port) {
  DepthMap map;
  map.image_path = (folder / "images" / "a.jpg").string();
  map.ids = {4, 2, 9};
  map.camera = camera(port);
  map.pose = {Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix(), {1, 2, 3}};
  map.min_depth = 0.25f;
  map.max_depth = 4.5f;
  map.depth.create(7, 9);
  map.normal.create(7, 9);
  map.confidence.create(7, 9);
  for (int v = 0; v < 7; ++v)
    for (int u = 0; u < 9; ++u) {
      map.depth(v, u) = (u + v) % 5 == 0 ? 0.0f : 0.3f + 0.07f * static_cast<float>(9 * v + u);
      map.normal(v, u) = {0.6f, static_cast<float>(u), -0.8f};
      map.confidence(v, u) = 0.01f * static_cast<float>(u * v);
    }
  return map;
}

class DmapTest : public test::FolderTest {
 protected:
  std::string error() {
    return error_of([&] { read_dmap(file_); });
  }
  // The error for the .dmap file without side file, with the bytes at `offset` replaced.
  template <class T>
  std::string error_with(std::size_t offset, T value) {
    write_dmap(file_, depth_map(folder_, Port::flat), "x");
    std::string bytes = read_file(file_);
    EXPECT_LE(offset + sizeof value, bytes.size());
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    test::put(file_, bytes);
    fs::remove(side_);
    return test::error_naming(file_, [&] { read_dmap(file_); });
  }

  fs::path file_ = folder_ / "depth0004.dmap", side_ = folder_ / "depth0004.dmap.json";
};

// Offsets of the fields in the file of depth_map(): 30 bytes, "images/a.jpg", the ids, then K, R,
// C.
constexpr std::size_t kName = 30, kIds = kName + 12, kK = kIds + 4 + 3 * 4, kR = kK + 9 * 8,
                      kC = kR + 9 * 8, kDepth = kC + 3 * 8;

TEST_F(DmapTest, KeepsTheDistanceAlongTheRefractedRay) {
  for (const Port port : {Port::none, Port::flat, Port::dome}) {
    const DepthMap map = depth_map(folder_, port);
    write_dmap(file_, map, "fingerprint");
    const StoredDepthMap stored = read_dmap(file_);
    EXPECT_EQ(stored.made_from, "fingerprint");
    EXPECT_EQ(stored.map.image_path, map.image_path);
    EXPECT_EQ(stored.map.ids, map.ids);
    EXPECT_EQ(stored.map.min_depth, map.min_depth);
    EXPECT_EQ(stored.map.max_depth, map.max_depth);
    EXPECT_EQ(stored.map.pose.rotation, map.pose.rotation);
    EXPECT_EQ(stored.map.pose.centre, map.pose.centre);
    EXPECT_EQ(stored.map.camera.lens.cx, map.camera.lens.cx);
    ASSERT_EQ(stored.map.camera.port.has_value(), port != Port::none);
    if (port == Port::flat) {
      const auto& kept = std::get<refractive::FlatPort<double>>(*stored.map.camera.port);
      EXPECT_LT((kept.normal - flat_port().normal).norm(), 1e-15);
    }
    if (port == Port::dome) {
      const auto& kept = std::get<refractive::DomePort<double>>(*stored.map.camera.port);
      EXPECT_EQ(kept.centre, dome_port().centre);
      EXPECT_EQ(kept.inner_radius, dome_port().inner_radius);
    }
    EXPECT_EQ(cv::norm(stored.map.normal, map.normal, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(stored.map.confidence, map.confidence, cv::NORM_INF), 0);
    for (int v = 0; v < 7; ++v)
      for (int u = 0; u < 9; ++u) {
        // z and lambda are each rounded to float once: an error of at most 2 half units in the last
        // place for each. z exceeds lambda d_z by at most the few centimetres of the port.
        const float tolerance = 4e-7f * map.depth(v, u);
        EXPECT_NEAR(stored.map.depth(v, u), map.depth(v, u), tolerance) << u << ", " << v;
        EXPECT_EQ(stored.map.depth(v, u) == 0, map.depth(v, u) == 0);
      }
  }
}

TEST_F(DmapTest, KeepsTheLens) {
  DepthMap map = depth_map(folder_, Port::flat);
  map.camera.distortion.emplace();
  map.camera.distortion->fisheye = 1;
  map.camera.distortion->above[1] = 1.0 / 30;
  write_dmap(file_, map, "fingerprint");
  const DepthMap kept = read_dmap(file_).map;
  EXPECT_EQ(kept.camera.distortion, map.camera.distortion);
  for (int v = 0; v < 7; ++v)
    for (int u = 0; u < 9; ++u)
      EXPECT_NEAR(kept.depth(v, u), map.depth(v, u), 4e-7f * map.depth(v, u)) << u << ", " << v;
}

// The depth in the file is z in the frame of the real camera. The test computes it without the
// conversion under test, from the end point of the pixel's ray after lambda.
TEST_F(DmapTest, StoresZDepthOfTheRealCamera) {
  const DepthMap map = depth_map(folder_, Port::flat);
  write_dmap(file_, map, "");
  const std::string bytes = read_file(file_);
  const refractive::FlatPortCamera<double> exact(map.camera.lens, flat_port(), 9, 7);
  for (int v = 0; v < 7; ++v)
    for (int u = 0; u < 9; ++u) {
      float z = 0;
      std::memcpy(&z, bytes.data() + kDepth + sizeof z * static_cast<std::size_t>(9 * v + u),
                  sizeof z);
      if (map.depth(v, u) == 0) {
        EXPECT_EQ(z, 0);
      } else {
        const Eigen::Vector3d x = exact.ray({u, v}).at(static_cast<double>(map.depth(v, u)));
        EXPECT_NEAR(z, x.z(), 1e-7 * x.z());
        const auto projected = exact.project(x);
        EXPECT_TRUE(projected.visible);
        EXPECT_LT((projected.pixel - Eigen::Vector2d(u, v)).norm(), 1e-9);
      }
    }
}

TEST_F(DmapTest, WritesTheHeaderOfTheFormat) {
  const DepthMap map = depth_map(folder_, Port::none);
  write_dmap(file_, map, "");
  const std::string bytes = read_file(file_);
  EXPECT_EQ(bytes.substr(0, 4), std::string("DR\7\0", 4));
  EXPECT_EQ(bytes.substr(4, 16), std::string("\11\0\0\0\7\0\0\0\11\0\0\0\7\0\0\0", 16));
  EXPECT_EQ(bytes.substr(28, 2 + 12), std::string("\14\0images/a.jpg", 14));
  EXPECT_EQ(bytes.substr(kIds, 8), std::string("\3\0\0\0\4\0\0\0", 8));
  double k[9];
  std::memcpy(k, bytes.data() + kK, sizeof k);
  EXPECT_EQ(k[0], 6);
  EXPECT_EQ(k[5], 3.1);
  EXPECT_EQ(k[8], 1);
  EXPECT_EQ(bytes.size(), kDepth + 63 * (4 + 12 + 4));
}

TEST_F(DmapTest, CountsAsPinholeWithoutItsSideFile) {
  const DepthMap map = depth_map(folder_, Port::none);
  write_dmap(file_, map, "x");
  fs::remove(side_);
  const StoredDepthMap stored = read_dmap(file_);
  EXPECT_FALSE(stored.map.camera.port);
  EXPECT_EQ(stored.made_from, "");
  EXPECT_EQ(dmap_status(file_).made_from, "");
  EXPECT_NEAR(stored.map.depth(3, 3), map.depth(3, 3), 1e-6);
  EXPECT_LE(stored.map.min_depth, 0.30f + 0.07f);
  EXPECT_GE(stored.map.max_depth, 0.30f + 0.07f * 61);
}

// A file as OpenMVS may write it: half the image's resolution, only depth, and the views map.
TEST_F(DmapTest, ReadsMapsSmallerThanTheImageAndSkipsViews) {
  DepthMap map = depth_map(folder_, Port::none);
  map.normal.release();
  map.confidence.release();
  write_dmap(file_, map, "");
  fs::remove(side_);
  std::string bytes = read_file(file_);
  bytes[2] = 1 | 8;
  bytes[4] = 18;
  bytes[8] = 14;
  test::put(file_, bytes + std::string(4 * 63, '\1'));
  const DepthMap read = read_dmap(file_).map;
  EXPECT_EQ(read.camera.width, 9);
  EXPECT_EQ(read.camera.lens.fx, 3);  // K in the file is for the image, which is twice as large
  EXPECT_EQ(read.camera.lens.cx, (3.9 + 0.5) / 2 - 0.5);
  EXPECT_EQ(read.normal.size(), read.depth.size());
  EXPECT_EQ(cv::norm(read.normal), 0);
  EXPECT_TRUE(read.confidence.empty());
}

TEST_F(DmapTest, NamesWhatIsWrong) {
  EXPECT_THAT(error_with(0, 'X'), HasSubstr("DR"));
  EXPECT_THAT(error_with(2, std::uint8_t{6}), HasSubstr("flags are 6"));
  EXPECT_THAT(error_with(2, std::uint8_t{23}), HasSubstr("flags are 23"));
  EXPECT_THAT(error_with(2, std::uint8_t{15}), HasSubstr("views"));
  EXPECT_THAT(error_with(2, std::uint8_t{3}), HasSubstr("bytes follow"));
  EXPECT_THAT(error_with(4, 8u), HasSubstr("larger than the image"));
  EXPECT_THAT(error_with(12, 0u), HasSubstr("0x7"));
  EXPECT_THAT(error_with(16, 0xFFFFFFFFu), HasSubstr("4294967295"));
  EXPECT_THAT(error_with(20, HUGE_VALF), HasSubstr("inf"));
  // The ray of the image centre is not along the optical axis, so the distance is longer than z.
  EXPECT_THAT(error_with(24, std::numeric_limits<float>::max()), HasSubstr("to inf along the ray"));
  EXPECT_THAT(error_with(28, std::uint16_t{65535}), HasSubstr("image name"));
  EXPECT_THAT(error_with(kIds, 0u), HasSubstr("no ids"));
  EXPECT_THAT(error_with(kIds, 0xFFFFFFFFu), HasSubstr("ids"));
  EXPECT_THAT(error_with(kK, 0.0), HasSubstr("K is not a calibration matrix"));
  EXPECT_THAT(error_with(kR + 8, 0.5), HasSubstr("R is not a rotation"));
  EXPECT_THAT(error_with(kC, std::nan("")), HasSubstr("C is not finite"));
  EXPECT_THAT(error_with(kDepth + 4, -1.0f), HasSubstr("pixel (1, 0) is -1"));
  EXPECT_THAT(error_with(kDepth + 4, std::nanf("")), HasSubstr("depth at pixel 1 is nan"));
  EXPECT_THAT(error_with(kDepth + 63 * 4 + 12, HUGE_VALF), HasSubstr("normal at pixel 1"));
}

TEST_F(DmapTest, RefusesASideFileOfAnotherMap) {
  write_dmap(file_, depth_map(folder_, Port::flat), "x");
  const std::string side = read_file(side_);
  const auto message = [&](const std::string& from, const std::string& to) {
    test::put(side_, test::replaced(side, from, to));
    return error();
  };
  EXPECT_THAT(message("\"width\": 9", "\"width\": 10"), HasSubstr("10x7"));
  EXPECT_THAT(message("\"fx\": 6.0", "\"fx\": 7.0"), HasSubstr("lens"));
  EXPECT_THAT(message("\"version\": 1", "\"version\": 2"), HasSubstr("version is 2"));
  EXPECT_THAT(message("\"n_glass\": 1.49", "\"n_glass\": 0.5"), HasSubstr("n_glass is 0.5"));
  EXPECT_THAT(message("\"max_depth_m\": 4.5", "\"max_depth_m\": 1e39"), HasSubstr("to inf"));
  EXPECT_THAT(message("\"made_from\"", "\"made_by\""), HasSubstr("made_by"));
  EXPECT_EQ(dmap_status(file_).made_from, "");
}

// The distance is larger than that of the glass of any housing.
TEST_F(DmapTest, KeepsTheWaterSurfaceUnderADrone) {
  DepthMap map = depth_map(folder_, Port::none);
  const refractive::FlatPort<double> surface{
      Eigen::Vector3d(0.3, -0.1, 1).normalized(), 30, 0, 1, 1.34, 1.34};
  map.camera.port = surface;
  map.depth += 40;
  write_dmap(file_, map, "x");
  const DepthMap kept = read_dmap(file_).map;
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(*kept.camera.port).distance, 30);
  // Two roundings to single precision.
  EXPECT_LT(cv::norm(kept.depth, map.depth, cv::NORM_INF), 40 * 1e-6);
}

TEST_F(DmapTest, TellsWhatAMapWasMadeFrom) {
  EXPECT_EQ(dmap_status(file_).made_from, "");
  write_dmap(file_, depth_map(folder_, Port::flat), "abc");
  EXPECT_EQ(dmap_status(file_).made_from, "abc");
  test::put(side_, "{");
  EXPECT_EQ(dmap_status(file_).made_from, "");
  write_dmap(file_, depth_map(folder_, Port::flat), "def");
  EXPECT_EQ(dmap_status(file_).made_from, "def");
  const std::string whole = read_file(file_);
  for (const std::string& other :
       {whole.substr(0, 100), whole + "x", std::string(whole.size(), '1')}) {
    test::put(file_, other);
    EXPECT_EQ(dmap_status(file_).made_from, "");
  }
  test::put(file_, whole);
  EXPECT_EQ(dmap_status(file_).made_from, "def");
  fs::remove(file_);
  EXPECT_EQ(dmap_status(file_).made_from, "");
}

TEST_F(DmapTest, TellsWhoWroteAMap) {
  const auto origin = [&] { return dmap_status(file_).origin; };
  EXPECT_EQ(origin(), DmapOrigin::none);
  DepthMap map = depth_map(folder_, Port::none);
  write_dmap(file_, map, "x");
  EXPECT_EQ(origin(), DmapOrigin::ours);
  EXPECT_EQ(dmap_status(file_).made_from, "x");
  const std::string ours = read_file(file_), side = read_file(side_);
  map.depth(3, 3) *= 1.01f;
  write_dmap(folder_ / "other.dmap", map, "y");
  const std::string other = read_file(folder_ / "other.dmap");

  test::put(file_, other);
  EXPECT_EQ(origin(), DmapOrigin::foreign);
  for (std::size_t length = 0; length < other.size(); length += 97) {
    test::put(file_, other.substr(0, length));
    EXPECT_EQ(origin(), DmapOrigin::damaged) << length;
  }
  test::put(file_, ours);
  test::put(side_, side.substr(0, side.size() / 2));
  EXPECT_EQ(origin(), DmapOrigin::damaged);
  fs::remove(side_);
  for (const std::string& bytes : {ours, other, std::string(), std::string("no map")}) {
    test::put(file_, bytes);
    EXPECT_EQ(origin(), DmapOrigin::foreign);
  }
}

TEST_F(DmapTest, ReadsTheHeaderAloneAsTheWholeMap) {
  for (const Port port : {Port::none, Port::flat, Port::dome}) {
    write_dmap(file_, depth_map(folder_, port), "x");
    const DepthMap whole = read_dmap(file_).map, header = read_dmap_header(file_);
    EXPECT_TRUE(header.depth.empty());
    EXPECT_EQ(header.ids, whole.ids);
    EXPECT_EQ(header.image_path, whole.image_path);
    EXPECT_EQ(header.camera.width, whole.camera.width);
    EXPECT_EQ(header.camera.port.has_value(), port != Port::none);
    EXPECT_FALSE(read_dmap_header(file_, DmapSide::ignored).camera.port.has_value());
    EXPECT_EQ(header.pose.centre, whole.pose.centre);
    const std::string bytes = read_file(file_);
    for (const std::string& wrong : {bytes + "x", bytes.substr(0, bytes.size() - 1)}) {
      test::put(file_, wrong);
      EXPECT_THAT(error_of([&] { read_dmap_header(file_); }), HasSubstr("according to its header"));
    }
  }
}

// A map without a side file counts as another program's. Our own maps always have one, even if the
// program is killed.
TEST_F(DmapTest, LeavesNoMapBesideTheSideFileOfAnother) {
  write_dmap(file_, depth_map(folder_, Port::none), "first");
  const std::string before = read_file(file_);
  fs::remove(side_);
  fs::create_directory(side_);  // prevents the side file from being written
  EXPECT_THAT(error_of([&] { write_dmap(file_, depth_map(folder_, Port::none), "second"); }),
              HasSubstr("dmap"));
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(DmapTest, RefusesAMapThatItsSideFileDoesNotDescribe) {
  DepthMap map = depth_map(folder_, Port::flat);
  write_dmap(file_, map, "x");
  const std::string side = read_file(side_);
  map.depth(3, 3) *= 1.01f;
  write_dmap(file_, map, "x");
  test::put(side_, side);
  EXPECT_THAT(error(), HasSubstr("is not the depth map"));
}

TEST_F(DmapTest, RefusesToWriteWhatCannotBeRead) {
  DepthMap map = depth_map(folder_, Port::flat);
  map.depth(2, 2) = -0.5f;
  EXPECT_THAT(error_of([&] { write_dmap(file_, map, ""); }), HasSubstr("-0.5"));
  map = depth_map(folder_, Port::flat);
  map.camera.width = 10;
  EXPECT_THAT(error_of([&] { write_dmap(file_, map, ""); }), HasSubstr("9x7"));
  map = depth_map(folder_, Port::flat);
  map.confidence.create(3, 3);
  EXPECT_THAT(error_of([&] { write_dmap(file_, map, ""); }), HasSubstr("another size"));
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(DmapTest, SurvivesWrongInput) {
  write_dmap(file_, depth_map(folder_, Port::flat), "x");
  const std::string bytes = read_file(file_);
  const std::string side = read_file(side_);
  const auto reader = [](const fs::path& file) { read_dmap(file); };
  test::expect_prefixes_refused(file_, bytes, reader);
  test::expect_damage_survived(file_, bytes.substr(0, kDepth + 63 * 20), reader, 4);
  test::put(file_, bytes);
  const auto read_side = [&](const fs::path&) { read_dmap(file_); };
  test::expect_prefixes_refused(side_, side, read_side, side.size() - 1);
  test::put(side_, side);
  int survived = 0;
  for (std::size_t i = 0; i < side.size(); ++i) {
    std::string damaged = side;
    damaged[i] ^= 1;
    test::put(side_, damaged);
    survived += !test::fails_naming(file_, [&] { read_dmap(file_); });
  }
  EXPECT_LT(survived, static_cast<int>(side.size() / 2));
}

}  // namespace
}  // namespace axial::io
