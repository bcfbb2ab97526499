// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>

#include "base/atomic_file.h"
#include "io/same_colmap.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::small_model;
using testing::HasSubstr;

// All camera models with their numbers of parameters, in the order of their numbers in binary
// files.
const std::vector<std::pair<std::string, std::size_t>> kModels{
    {"SIMPLE_PINHOLE", 3},
    {"PINHOLE", 4},
    {"SIMPLE_RADIAL", 4},
    {"RADIAL", 5},
    {"OPENCV", 8},
    {"OPENCV_FISHEYE", 8},
    {"FULL_OPENCV", 12},
    {"FOV", 5},
    {"SIMPLE_RADIAL_FISHEYE", 4},
    {"RADIAL_FISHEYE", 5},
    {"THIN_PRISM_FISHEYE", 12},
    {"RAD_TAN_THIN_PRISM_FISHEYE", 16},
    {"SIMPLE_DIVISION", 4},
    {"DIVISION", 5},
    {"SIMPLE_FISHEYE", 3},
    {"FISHEYE", 4},
    {"EUCM", 6},
    {"EQUIRECTANGULAR", 2},
};

class ColmapTest : public test::FolderTest {
 protected:
  void put_text(const std::string& cameras, const std::string& images, const std::string& points) {
    test::put(folder_ / "cameras.txt", cameras);
    test::put(folder_ / "images.txt", images);
    test::put(folder_ / "points3D.txt", points);
  }
  std::string error() {
    return error_of([&] { read_colmap_model(folder_); });
  }
};

TEST_F(ColmapTest, ReadsBackText) {
  write_colmap_text(folder_, small_model());
  test::expect_same(read_colmap_model(folder_), small_model());
}

TEST_F(ColmapTest, ReadsBackBinary) {
  write_colmap_binary(folder_, small_model());
  test::expect_same(read_colmap_model(folder_), small_model());
}

TEST_F(ColmapTest, KnowsEveryCameraModelInBothForms) {
  ColmapModel model;
  for (std::size_t i = 0; i < kModels.size(); ++i) {
    const auto& [name, count] = kModels[i];
    EXPECT_EQ(colmap_parameter_count(name), static_cast<int>(count));
    ColmapCamera camera{static_cast<std::uint32_t>(i), name, 640, 480, {}};
    for (std::size_t k = 0; k < count; ++k) camera.params.push_back(0.5 + static_cast<double>(k));
    model.cameras.push_back(camera);
  }
  EXPECT_EQ(colmap_parameter_count("METASHAPE_FISHEYE"), 10);
  EXPECT_EQ(colmap_parameter_count("PINHOLES"), -1);
  write_colmap_text(folder_, model);
  test::expect_same(read_colmap_model(folder_), model);
  for (const char* name : {"cameras.txt", "images.txt", "points3D.txt"}) fs::remove(folder_ / name);
  write_colmap_binary(folder_, model);
  test::expect_same(read_colmap_model(folder_), model);
  // In binary files the number of a model is its place in the list above.
  const std::string bytes = read_file(folder_ / "cameras.bin");
  std::size_t at = 8;
  for (std::size_t i = 0; i < kModels.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(bytes[at + 4]), i);
    at += 24 + 8 * kModels[i].second;
  }
}

RC_GTEST_PROP(Colmap, KeepsAnyRotation, ()) {
  const auto component = [] { return *rc::gen::inRange(-3, 4) / 3.0; };  // includes half turns
  Eigen::Quaterniond q(component(), component(), component(), component());
  RC_PRE(q.norm() > 0.1);
  q.normalize();
  ColmapModel model;
  model.cameras = {{1, "PINHOLE", 64, 48, {50, 50, 32, 24}}};
  model.images = {{1, 1, "a.jpg", {q.matrix(), {component(), component(), component()}}, {}}};
  const fs::path folder = test::empty_folder();
  write_colmap_text(folder, model);
  const Pose read = read_colmap_model(folder).images[0].pose;
  fs::remove_all(folder);
  RC_ASSERT((read.rotation - model.images[0].pose.rotation).norm() < 1e-14);
  RC_ASSERT((read.centre - model.images[0].pose.centre).norm() < 1e-14);
}

// As COLMAP writes text files: comments, an empty second line, a name with blanks, -1 for "no
// point".
constexpr const char* kCameras = "# Camera list\n1 SIMPLE_PINHOLE 640 480 500 320 240\n";
constexpr const char* kImages =
    "# Image list\n# two lines each\n5 1 0 0 0 -1 -2 -3 1 my photo.jpg\n"
    "1.5 2.5 9 3 4 -1\n6 0 0 0 1 0 0 0 1 b.jpg\n\n";
constexpr const char* kPoints = "# points\n9 1 2 3 10 20 30 0.5 5 0\n";

TEST_F(ColmapTest, ReadsTextAsColmapWritesIt) {
  put_text(kCameras, kImages, kPoints);
  const ColmapModel model = read_colmap_model(folder_);
  ASSERT_EQ(model.images.size(), 2u);
  EXPECT_EQ(model.images[0].name, "my photo.jpg");
  EXPECT_EQ(model.images[0].pose.centre, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(model.images[0].points[1].point3d, kNoPoint3D);
  EXPECT_TRUE(model.images[1].points.empty());
  EXPECT_EQ(model.images[1].pose.rotation(0, 0), -1);  // a half turn about z
  EXPECT_EQ(model.points[0].color, (Rgb{10, 20, 30}));
}

// An image is identified by its path, in any notation.
TEST_F(ColmapTest, RefusesTwoImagesOfOneName) {
  ColmapModel model = small_model();
  for (const char* name : {"c.jpg", "./c.jpg", "left/../c.jpg", ".//c.jpg"}) {
    model.images[2].name = name;
    write_colmap_text(folder_, model);
    EXPECT_EQ(error(), folder_.string() + ": images 2 and 4 have the same name, " + name);
  }
  for (const char* name : {"left/c.jpg", "C.jpg", "c.jpg.jpg"}) {
    model.images[2].name = name;
    write_colmap_text(folder_, model);
    EXPECT_NO_THROW(read_colmap_model(folder_)) << name;
  }
}

// Blanks and carriage returns (not at the ends), '#', quotes and commas anywhere.
RC_GTEST_PROP(Colmap, KeepsAnyName, ()) {
  const auto name = *rc::gen::nonEmpty(
      rc::gen::container<std::string>(rc::gen::element('a', ' ', '#', '"', ',', '7', '\t', '\r')));
  RC_PRE(std::string(" \t\r").find(name.front()) == std::string::npos);
  RC_PRE(std::string(" \t\r").find(name.back()) == std::string::npos);
  ColmapModel model;
  model.cameras = {{1, "PINHOLE", 64, 48, {50, 50, 32, 24}}};
  model.images = {{1, 1, name, {}, {}}};
  const fs::path folder = test::empty_folder();
  write_colmap_text(folder, model);
  const std::string read = read_colmap_model(folder).images[0].name;
  fs::remove_all(folder);
  RC_ASSERT(read == name);
}

TEST_F(ColmapTest, FindsTheModelWhereItMayBe) {
  EXPECT_THAT(error_of([&] { find_colmap_model(folder_); }), HasSubstr("sparse/0"));
  test::put(folder_ / "cameras.bin", "");
  EXPECT_EQ(find_colmap_model(folder_), folder_);
  fs::create_directories(folder_ / "sparse" / "0");
  test::put(folder_ / "sparse" / "0" / "cameras.txt", "");
  EXPECT_EQ(find_colmap_model(folder_), folder_ / "sparse" / "0");
  test::put(folder_ / "sparse" / "cameras.txt", "");
  EXPECT_EQ(find_colmap_model(folder_), folder_ / "sparse");
  EXPECT_THAT(error_of([&] { read_colmap_model(folder_ / "sparse"); }), HasSubstr("images.txt"));
}

TEST_F(ColmapTest, NamesWhatIsWrongInCameras) {
  const auto message = [&](const std::string& camera) {
    put_text(camera + "\n", kImages, kPoints);
    return error();
  };
  EXPECT_THAT(message("1 NO_SUCH 640 480 1 2 3"), HasSubstr("NO_SUCH"));
  EXPECT_THAT(message("1 PINHOLE 640 480 500 320 240"), HasSubstr("missing"));
  EXPECT_THAT(message("1 PINHOLE 640 480 500 500 320 240 1"), HasSubstr("unexpected '1'"));
  EXPECT_THAT(message("1 PINHOLE 640 480 0 500 320 240"), HasSubstr("parameter 0 is 0"));
  EXPECT_THAT(message("1 PINHOLE 640 480 nan 500 320 240"), HasSubstr("nan"));
  EXPECT_THAT(message("1 PINHOLE 640 480 5e999 500 320 240"), HasSubstr("5e999"));
  EXPECT_THAT(message("1 PINHOLE 0 480 500 500 320 240"), HasSubstr("width 0"));
  EXPECT_THAT(message("1 PINHOLE 640 99999999999 500 500 320 240"), HasSubstr("99999999999"));
  EXPECT_THAT(message("4294967296 PINHOLE 640 480 500 500 320 240"), HasSubstr("4294967296"));
  EXPECT_THAT(message("2 PINHOLE 640 480 500 500 320 240"), HasSubstr("camera 1"));
  EXPECT_THAT(message("1 PINHOLE 6 4 5 5 3 2\n1 PINHOLE 6 4 5 5 3 2"), HasSubstr("occurs twice"));
}

TEST_F(ColmapTest, NamesWhatIsWrongInImagesAndPoints) {
  const auto images = [&](const std::string& text) {
    put_text(kCameras, text, kPoints);
    return error();
  };
  EXPECT_THAT(images("5 1 0 0 0 -1 -2 -3 1\n\n"), HasSubstr("name is missing"));
  EXPECT_THAT(images("5 0 0 0 0 -1 -2 -3 1 a.jpg\n\n"), HasSubstr("not a rotation"));
  EXPECT_THAT(images("5 nan 0 0 0 -1 -2 -3 1 a.jpg\n\n"), HasSubstr("qw is 'nan'"));
  EXPECT_THAT(images("5 1 0 0 0 -1 -2 inf 1 a.jpg\n\n"), HasSubstr("tz is 'inf'"));
  EXPECT_THAT(images("5 0.9239 0 0 0.3827 1.7e308 1.7e308 1.7e308 1 a.jpg\n\n"),
              HasSubstr("too long"));
  EXPECT_THAT(images("5 1 0 0 0 -1 -2 -3 2 a.jpg\n1 2 9\n"), HasSubstr("camera 2"));
  EXPECT_THAT(images("5 1 0 0 0 -1 -2 -3 1 a.jpg\n1 2 8\n"), HasSubstr("3D point 8"));
  EXPECT_THAT(images("5 1 0 0 0 -1 -2 -3 1 a.jpg\n1 2\n"), HasSubstr("3D point id is missing"));
  EXPECT_THAT(images("5 1 0 0 0 -1 -2 -3 1 a.jpg\n\n"), HasSubstr("2D point 0"));
  EXPECT_THAT(images("4 1 0 0 0 -1 -2 -3 1 a.jpg\n\n"), HasSubstr("image 5"));
  EXPECT_THAT(images("5 1 0 0 0 -1 -2 -3 1 a.jpg\n"), HasSubstr("truncated"));
  const auto points = [&](const std::string& text) {
    put_text(kCameras, kImages, text);
    return error();
  };
  EXPECT_THAT(points("9 1 2 3 10 20 256 0.5 5 0\n"), HasSubstr("256"));
  EXPECT_THAT(points("9 1 2 nan 10 20 30 0.5 5 0\n"), HasSubstr("nan"));
  EXPECT_THAT(points("9 1 2 3 10 20 30 0.5 5\n"), HasSubstr("2D point of the track is missing"));
  EXPECT_THAT(points("9 1 2 3 10 20 30 0.5 5 2\n"), HasSubstr("2D point 2"));
  EXPECT_THAT(points("9 1 2 3 10 20 30 0.5 7 0\n"), HasSubstr("image 7"));
}

TEST_F(ColmapTest, RefusesToWriteWhatCannotBeRead) {
  ColmapModel model = small_model();
  model.images[0].name = "two\nlines.jpg";
  EXPECT_THAT(error_of([&] { write_colmap_text(folder_, model); }), HasSubstr("two"));
  model.images[0].name = "";
  EXPECT_THAT(error_of([&] { write_colmap_binary(folder_, model); }), HasSubstr("image 7"));
  model = small_model();
  model.cameras[0].model = "METASHAPE_FISHEYE";
  EXPECT_THAT(error_of([&] { write_colmap_binary(folder_, model); }), HasSubstr("METASHAPE"));
}

// A text file has no count, so a prefix of complete records can be a smaller model. It must be
// refused if other files of the model refer to missing elements, or if it ends within a line.
TEST_F(ColmapTest, SurvivesWrongInput) {
  const auto read = [&](const fs::path&) { read_colmap_model(folder_); };
  const auto fails = [&] {
    try {
      read_colmap_model(folder_);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      EXPECT_THAT(error.what(), HasSubstr(folder_.string()));
      return true;
    }
    return false;
  };
  // A model is read from three files, which takes long. The fuzz tests try more.
  constexpr int kRounds = 150;
  const auto damaged_model = [&](const fs::path& file) {
    if (fails()) fail("{}", file.string());
  };
  write_colmap_text(folder_, small_model());
  for (const char* name : {"cameras.txt", "images.txt", "points3D.txt"}) {
    const std::string bytes = read_file(folder_ / name);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      test::put(folder_ / name, bytes.substr(0, size));
      const bool failed = fails();
      const bool whole_lines = size == 0 || bytes[size - 1] == '\n';
      EXPECT_TRUE(failed || whole_lines) << name << ", prefix of " << size << " bytes";
      if (!failed) {  // all that is referred to is there: only the unreferred point 5 may be
                      // missing
        EXPECT_EQ(std::string(name), "points3D.txt");
      }
    }
    test::put(folder_ / name, bytes);
    test::expect_damage_survived(folder_ / name, bytes, damaged_model, 4, kRounds);
    test::put(folder_ / name, bytes);
  }
  for (const char* name : {"cameras.txt", "images.txt", "points3D.txt"}) fs::remove(folder_ / name);
  write_colmap_binary(folder_, small_model());
  for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) {
    const std::string bytes = read_file(folder_ / name);
    test::expect_prefixes_refused(folder_ / name, bytes, read);
    test::expect_damage_survived(folder_ / name, bytes, damaged_model, 8, kRounds);
    test::put(folder_ / name, bytes);
  }
}

// The standard deviation of focal lengths in COLMAP's cameras.txt: a comment that COLMAP skips.

class FocalSigmaTest : public test::FolderTest {
 protected:
  std::vector<ColmapCamera> read(const std::string& comments) {
    test::put(file(), comments +
                          "3 PINHOLE 640 480 500 501 320 240\n"
                          "1 SIMPLE_RADIAL 64 48 50 32 24 -0.1\n");
    return read_colmap_cameras(file());
  }
  std::string error(const std::string& comments) {
    return test::error_of([&] { read(comments); });
  }
  fs::path file() const { return folder_ / "cameras.txt"; }
};

TEST_F(FocalSigmaTest, IsReadAndWritten) {
  ColmapModel model;
  model.cameras = read("# A list.\n#focal_sigma 1 0.002\n# focal sigma 3 is unknown\n");
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_EQ(model.cameras[0].focal_sigma, std::nullopt);
    EXPECT_EQ(model.cameras[1].focal_sigma, 0.002);
    write_colmap_text(folder_, model);
    EXPECT_THAT(read_file(file()), HasSubstr("\n# focal_sigma 1 0.002\n"));
    model = read_colmap_model(folder_);
  }
}

TEST_F(FocalSigmaTest, ErrorsNameFileLineAndValue) {
  EXPECT_THAT(error("# focal_sigma 3 -0.1\n"),
              HasSubstr(file().string() + ": line 1: focal_sigma of camera 3 is -0.1"));
  EXPECT_THAT(error("# focal_sigma 3 0\n"), HasSubstr("focal_sigma of camera 3 is 0, expected"));
  EXPECT_THAT(error("\n# focal_sigma 3 1.5\n"),
              HasSubstr("line 2: focal_sigma of camera 3 is 1.5"));
  EXPECT_THAT(error("# focal_sigma 3\n"), HasSubstr("line 1: focal_sigma is missing"));
  EXPECT_THAT(error("# focal_sigma 0.01\n"), HasSubstr("camera id of focal_sigma is '0.01'"));
  EXPECT_THAT(error("# focal_sigma 3 0.01 px\n"), HasSubstr("unexpected 'px'"));
  EXPECT_THAT(error("# focal_sigma 2 0.01\n"), HasSubstr("line 1: focal_sigma names camera 2"));
  EXPECT_THAT(error("# focal_sigma 3 0.01\n# focal_sigma 3 0.01\n"),
              HasSubstr("line 2: focal_sigma of camera 3 occurs twice"));
}

}  // namespace
}  // namespace axial::io
