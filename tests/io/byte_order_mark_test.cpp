// SPDX-License-Identifier: GPL-3.0-or-later
// Text files that start with the byte order mark, which some editors write, must be read as without
// it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "io/cameras/housing.h"
#include "io/cameras/lenses.h"
#include "io/cameras/position_file.h"
#include "io/colmap/calibmar.h"
#include "io/colmap/colmap.h"
#include "io/ply/ply.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

class ByteOrderMark : public test::FolderTest {
 protected:
  fs::path marked(const std::string& name, const std::string& text) const {
    test::put(folder_ / name, "\xEF\xBB\xBF" + text);
    return folder_ / name;
  }
};

TEST_F(ByteOrderMark, InAColmapModel) {
  for (const bool comment : {true, false}) {
    const std::string first = comment ? "# as COLMAP begins\n" : "";
    marked("cameras.txt", first + "1 SIMPLE_PINHOLE 640 480 500 320 240\n");
    marked("images.txt", first + "5 1 0 0 0 -1 -2 -3 1 a.jpg\n1.5 2.5 9\n");
    marked("points3D.txt", first + "9 1 2 3 10 20 30 0.5 5 0\n");
    const ColmapModel model = read_colmap_model(folder_);
    EXPECT_EQ(model.cameras.at(0).id, 1u);
    EXPECT_EQ(model.images.at(0).id, 5u);
    EXPECT_EQ(model.points.at(0).id, 9u);
  }
}

TEST_F(ByteOrderMark, InAPly) {
  const std::string header =
      "element vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  const auto ascii = marked("a.ply", "ply\nformat ascii 1.0\n" + header + "1 2 3\n4 5 6\n");
  EXPECT_EQ(read_cloud_ply(ascii).positions.at(1).z(), 6);
  std::string bytes = "ply\nformat binary_little_endian 1.0\n" + header;
  for (const float value : {1.f, 2.f, 3.f, 4.f, 5.f, 6.f})
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  EXPECT_EQ(read_cloud_ply(marked("b.ply", bytes)).positions.at(1).z(), 6);
}

TEST_F(ByteOrderMark, InAHousingAndLenses) {
  const Housing housing =
      housing_with(refractive::FlatPort<double>{{0, 0, 1}, 0.02, 0.01, 1, 1.5, 1.33});
  write_housing(folder_ / "h.json", housing);
  EXPECT_EQ(read_housing(marked("marked.json", read_file(folder_ / "h.json"))).ports.size(), 1u);
  write_lenses(folder_ / "l.json", SceneLenses{});
  EXPECT_EQ(read_lenses(marked("marked.json", read_file(folder_ / "l.json"))).default_lens, "none");
  write_calibmar(folder_ / "c.yaml", {1, "PINHOLE", 64, 48, {50, 50, 32, 24}});
  EXPECT_EQ(read_calibmar(marked("marked.yaml", read_file(folder_ / "c.yaml"))).width, 64u);
}

TEST_F(ByteOrderMark, InPositions) {
  const auto file = marked("positions.txt", "a.jpg 1 2 3\n");
  EXPECT_EQ(read_positions(file, [](const std::string&) { return false; }).positions.at(0).name,
            "a.jpg");
}

}  // namespace
}  // namespace axial::io
