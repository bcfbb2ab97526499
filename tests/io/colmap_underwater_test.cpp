// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras with ports in COLMAP-Underwater's files, compared with hand-made files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/colmap/colmap.h"
#include "io/colmap/colmap_scene.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

// Little-endian, like all machines on which the project runs.
template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

const std::vector<double> kFlat{0.6, 0, 0.8, 0.02, 0.014, 1, 1.52, 1.333};
const std::vector<double> kDome{0.001, -0.002, 0.003, 0.05, 0.007, 1, 1.52, 1.34};

struct CameraBytes {
  std::int32_t model;
  std::vector<double> params;
  std::int32_t port;  // -1: no port
  std::vector<double> port_params;
};

// cameras.bin of COLMAP-Underwater: COLMAP's record, the number of the port, its eight numbers.
std::string underwater_bytes(const std::vector<CameraBytes>& cameras) {
  std::string bytes;
  append(bytes, std::uint64_t{cameras.size()});
  std::uint32_t id = 1;
  for (const CameraBytes& camera : cameras) {
    append(bytes, id++);
    append(bytes, camera.model);
    append(bytes, std::uint64_t{1024});
    append(bytes, std::uint64_t{768});
    for (const double value : camera.params) append(bytes, value);
    append(bytes, camera.port);
    for (const double value : camera.port_params) append(bytes, value);
  }
  return bytes;
}

class Underwater : public test::FolderTest {
 protected:
  std::vector<ColmapCamera> read_binary(const std::string& bytes) {
    test::put(folder_ / "cameras.bin", bytes);
    return read_colmap_cameras(folder_ / "cameras.bin");
  }
  std::vector<ColmapCamera> read_text(const std::string& line) {
    test::put(folder_ / "cameras.txt", line + "\n");
    return read_colmap_cameras(folder_ / "cameras.txt");
  }
};

const std::vector<double> kPinhole{610, 615, 512, 384};

void expect_flat(const ColmapCamera& camera) {
  ASSERT_TRUE(camera.port);
  const auto port = std::get<refractive::FlatPort<double>>(*camera.port);
  EXPECT_EQ(port.normal, Eigen::Vector3d(0.6, 0, 0.8));
  EXPECT_EQ(
      (std::vector<double>{port.distance, port.thickness, port.n_air, port.n_glass, port.n_water}),
      (std::vector<double>{0.02, 0.014, 1, 1.52, 1.333}));
}

void expect_dome(const ColmapCamera& camera) {
  ASSERT_TRUE(camera.port);
  const auto port = std::get<refractive::DomePort<double>>(*camera.port);
  EXPECT_EQ(port.centre, Eigen::Vector3d(0.001, -0.002, 0.003));
  EXPECT_EQ((std::vector<double>{port.inner_radius, port.thickness, port.n_air, port.n_glass,
                                 port.n_water}),
            (std::vector<double>{0.05, 0.007, 1, 1.52, 1.34}));
}

TEST_F(Underwater, ReadsTextTails) {
  const std::string camera = "1 PINHOLE 1024 768 610 615 512 384";
  expect_flat(read_text(camera + " FLATPORT 0.6 0 0.8 0.02 0.014 1 1.52 1.333").at(0));
  expect_dome(read_text(camera + " DOMEPORT 0.001 -0.002 0.003 0.05 0.007 1 1.52 1.34").at(0));
  EXPECT_FALSE(read_text(camera).at(0).port);
}

TEST_F(Underwater, ReadsBinaryTails) {
  const auto cameras =
      read_binary(underwater_bytes({{1, kPinhole, 0, kFlat}, {1, kPinhole, 1, kDome}}));
  ASSERT_EQ(cameras.size(), 2u);
  expect_flat(cameras[0]);
  expect_dome(cameras[1]);
  EXPECT_EQ(cameras[1].params, kPinhole);
}

TEST_F(Underwater, TellsItsBinaryFilesFromColmaps) {
  // One and several cameras, with and without ports, with every number of parameters.
  for (const auto& [model, count] :
       std::vector<std::pair<int, std::size_t>>{{0, 3}, {1, 4}, {2, 4}, {4, 8}, {6, 12}, {7, 5}}) {
    std::vector<double> params(count, 0.25);
    params[0] = params[1] = 500;
    for (const int cameras : {1, 2, 3}) {
      std::vector<CameraBytes> wet(static_cast<std::size_t>(cameras), {model, params, 0, kFlat});
      wet.back() = {model, params, -1, {}};
      const auto read = read_binary(underwater_bytes(wet));
      ASSERT_EQ(read.size(), wet.size());
      EXPECT_FALSE(read.back().port);
      EXPECT_EQ(read.back().params, params);
      ColmapModel dry;
      dry.cameras = read;
      for (ColmapCamera& camera : dry.cameras) camera.port.reset();
      write_colmap_binary(folder_, dry);
      const auto again = read_colmap_cameras(folder_ / "cameras.bin");
      ASSERT_EQ(again.size(), read.size());
      for (const ColmapCamera& camera : again) {
        EXPECT_FALSE(camera.port);
        EXPECT_EQ(camera.params, params);
      }
    }
  }
}

// Number 11 is a different camera model in each of the two programs.
TEST_F(Underwater, ResolvesNumberEleven) {
  std::vector<double> ten(10, 0.1), sixteen(16, 0.1);
  ten[0] = ten[1] = sixteen[0] = sixteen[1] = 500;
  const auto fork = read_binary(underwater_bytes({{11, ten, 0, kFlat}}));
  EXPECT_EQ(fork.at(0).model, "METASHAPE_FISHEYE");
  EXPECT_EQ(fork.at(0).params, ten);
  ColmapModel upstream;
  upstream.cameras = {{1, "RAD_TAN_THIN_PRISM_FISHEYE", 1024, 768, sixteen}};
  write_colmap_binary(folder_, upstream);
  EXPECT_EQ(read_colmap_cameras(folder_ / "cameras.bin").at(0).model, "RAD_TAN_THIN_PRISM_FISHEYE");
  EXPECT_THAT(error_of([&] { write_underwater_binary(folder_, upstream); }),
              HasSubstr("RAD_TAN_THIN_PRISM_FISHEYE"));
}

// COLMAP has used the numbers above 11 since. COLMAP-Underwater has no such camera models.
TEST_F(Underwater, RefusesNumbersAboveEleven) {
  EXPECT_EQ(read_binary(underwater_bytes({{2, kPinhole, 0, kFlat}})).at(0).model, "SIMPLE_RADIAL");
  EXPECT_THAT(error_of([&] {
                read_binary(underwater_bytes({{12, kPinhole, 0, kFlat}}));
              }),
              HasSubstr("cameras.bin"));
}

ColmapModel model_with_ports() {
  ColmapModel model;
  model.cameras = {{1, "PINHOLE", 1024, 768, kPinhole},
                   {2, "OPENCV", 1024, 768, {610, 615, 512, 384, 0.1, 0.01, 0.001, -0.002}},
                   {7, "SIMPLE_PINHOLE", 1024, 768, {610, 512, 384}}};
  model.cameras[0].port = refractive::FlatPort<double>{{0.6, 0, 0.8}, 0.02, 0.014, 1, 1.52, 1.333};
  model.cameras[2].port =
      refractive::DomePort<double>{{0.001, -0.002, 0.003}, 0.05, 0.007, 1, 1.52, 1.34};
  return model;
}

TEST_F(Underwater, WritesTextByteForByte) {
  write_underwater_text(folder_, model_with_ports());
  const std::string text = read_file(folder_ / "cameras.txt");
  EXPECT_THAT(text, HasSubstr("\n1 PINHOLE 1024 768 610 615 512 384 FLATPORT 0.6 0 0.8 0.02 0.014 "
                              "1 1.52 1.333\n"));
  EXPECT_THAT(text, HasSubstr("\n2 OPENCV 1024 768 610 615 512 384 0.1 0.01 0.001 -0.002\n"));
  EXPECT_THAT(text, HasSubstr("\n7 SIMPLE_PINHOLE 1024 768 610 512 384 DOMEPORT 0.001 -0.002 0.003 "
                              "0.05 0.007 1 1.52 1.34\n"));
  const auto cameras = read_colmap_cameras(folder_);
  expect_flat(cameras.at(0));
  expect_dome(cameras.at(2));
}

TEST_F(Underwater, WritesBinaryByteForByte) {
  ColmapModel model = model_with_ports();
  model.cameras.resize(1);
  write_underwater_binary(folder_, model);
  EXPECT_EQ(read_file(folder_ / "cameras.bin"), underwater_bytes({{1, kPinhole, 0, kFlat}}));
  write_underwater_binary(folder_, model_with_ports());
  const auto cameras = read_colmap_cameras(folder_);
  expect_flat(cameras.at(0));
  EXPECT_FALSE(cameras.at(1).port);
  expect_dome(cameras.at(2));
}

TEST_F(Underwater, NeverWritesATailForColmap) {
  write_colmap_text(folder_, model_with_ports());
  EXPECT_THAT(read_file(folder_ / "cameras.txt"), testing::Not(HasSubstr("PORT")));
  fs::remove(folder_ / "cameras.txt");
  write_colmap_binary(folder_, model_with_ports());
  EXPECT_EQ(fs::file_size(folder_ / "cameras.bin"), 8u + 3 * 24 + (4 + 8 + 3) * 8);
}

TEST_F(Underwater, RefusesWrongTails) {
  const auto text = [&](const std::string& tail) {
    return error_of([&] { read_text("1 PINHOLE 1024 768 610 615 512 384 " + tail); });
  };
  EXPECT_THAT(text("FLATPORT 0 0 1 0.02 0.014 1 1.52"), HasSubstr("parameter is missing"));
  EXPECT_THAT(text("FLATPORT 0 0 1 0.02 0.014 1 1.52 1.333 5"), HasSubstr("unexpected '5'"));
  EXPECT_THAT(text("FLATPORT 0 0 -1 0.02 0.014 1 1.52 1.333"), HasSubstr("cameras.txt: line 1"));
  EXPECT_THAT(text("FLATPORT 0 0 0 0.02 0.014 1 1.52 1.333"), HasSubstr("not a direction"));
  EXPECT_THAT(text("FLATPORT 0 0 1 nan 0.014 1 1.52 1.333"), HasSubstr("nan"));
  EXPECT_THAT(text("DOMEPORT 0 0 0.2 0.05 0.007 1 1.52 1.333"), HasSubstr("cameras.txt: line 1"));
  EXPECT_THAT(text("WINDOW 0 0 1"), HasSubstr("unexpected 'WINDOW"));
  const auto binary = [&](const std::string& bytes) {
    return error_of([&] { read_binary(bytes); });
  };
  const std::string good = underwater_bytes({{1, kPinhole, 0, kFlat}});
  // A prefix without the port is a valid file of COLMAP.
  const std::size_t colmaps = good.size() - 4 - 8 * 8;
  EXPECT_FALSE(read_binary(good.substr(0, colmaps)).at(0).port);
  for (std::size_t size = 0; size < good.size(); ++size)
    if (size != colmaps) {
      EXPECT_THAT(binary(good.substr(0, size)), HasSubstr("cameras.bin")) << size;
    }
  EXPECT_THAT(binary(underwater_bytes({{1, kPinhole, 2, kFlat}})), HasSubstr("cameras.bin"));
}

TEST(HousingOf, GivesEveryCameraItsOwnPort) {
  const Housing housing = housing_of(model_with_ports().cameras);
  EXPECT_EQ(housing.port_of("any.jpg", 1), "camera_1");
  EXPECT_EQ(housing.port_of("any.jpg", 2), "none");
  EXPECT_EQ(housing.port_of("any.jpg", 7), "camera_7");
  EXPECT_EQ(housing.ports.size(), 2u);
}

}  // namespace
}  // namespace axial::io
