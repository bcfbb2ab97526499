// SPDX-License-Identifier: GPL-3.0-or-later
// Tests EvaluateReconstruction --render from the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/atomic_file.h"
#include "evaluate/program_fixture.h"
#include "io/images/image.h"
#include "io/textured/textured_mesh.h"

namespace axial::evaluate {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// The seabed of write_scene with a texture of coloured stripes, in three formats.
void write_textured(const fs::path& folder) {
  TexturedMesh mesh;
  mesh.mesh = height_field(60, 2, ripples);
  cv::Mat3b& texture = mesh.textures.emplace_back(128, 128);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      texture(y, x) = {static_cast<std::uint8_t>(2 * x), static_cast<std::uint8_t>(x / 8 % 2 * 200),
                       static_cast<std::uint8_t>(y / 8 % 2 * 200)};
  mesh.texture_of.assign(mesh.mesh.faces.size(), 0);
  for (const auto& face : mesh.mesh.faces)
    for (std::size_t k = 0; auto& corner : mesh.uv.emplace_back())
      corner = (mesh.mesh.vertices[face[k++]].head<2>().array() + 1) * 64 - 0.5f;
  for (const auto format :
       {io::TexturedFormat::ply, io::TexturedFormat::obj, io::TexturedFormat::glb})
    io::write_textured_mesh(folder / "textured", mesh, format);
}

TEST_F(Programs, RenderATexturedMeshIntoViews) {
  write_scene();
  write_textured(folder_);
  const std::string views = " --cameras true --render 0000.jpg,0002.jpg --render-samples 2 ";
  ASSERT_EQ(run("EvaluateReconstruction", "-i textured.ply --render-folder photographs" + views)
                .exit_code,
            0);
  fs::rename(folder_ / "photographs" / "0000.png", folder_ / "photographs" / "0000.jpg");
  cv::Mat3b changed = io::read_color_image(folder_ / "photographs" / "0002.png");
  for (cv::Vec3b& bgr : changed)
    for (int c = 0; c < 3; ++c)
      bgr[c] = static_cast<std::uint8_t>(bgr[c] < 128 ? bgr[c] + 10 : bgr[c] - 10);
  io::write_png(folder_ / "photographs" / "0002.png", changed);
  fs::rename(folder_ / "photographs" / "0002.png", folder_ / "photographs" / "0002.jpg");
  for (const char* mesh : {"textured.ply", "textured.obj", "textured.glb"}) {
    const Outcome outcome =
        run("EvaluateReconstruction",
            fmt::format("-i {} --photographs photographs --json out.json", mesh) + views);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("all views"));
    const auto json = read_json("out.json")["render"];
    EXPECT_EQ(json["views"][0]["view"], "0000.jpg");
    EXPECT_GT(json["views"][0]["covered"], 0.7);
    EXPECT_EQ(json["views"][0]["psnr"], nullptr) << mesh << ": the pictures are equal";
    EXPECT_NEAR(json["views"][1]["psnr"].get<double>(), 10 * std::log10(255 * 255 / 100.0), 1e-6);
    EXPECT_EQ(json["views"][1]["mean_difference"], 10.0);
    EXPECT_FALSE(json["views"][0].contains("truth_covered"));
  }
}

TEST_F(Programs, LeaveNoOutputsIfAnInputIsRefused) {
  write_scene();
  write_textured(folder_);
  const std::string command = "-i textured.ply --cameras true --render all --render-samples 1 ";
  ASSERT_EQ(run("EvaluateReconstruction", command + "--render-folder photographs").exit_code, 0);
  for (const char* name : {"0000", "0001", "0002", "0003"})
    fs::rename(folder_ / "photographs" / fmt::format("{}.png", name),
               folder_ / "photographs" / fmt::format("{}.jpg", name));
  std::string damaged = read_file(folder_ / "photographs" / "0002.jpg");
  for (std::size_t i = damaged.size() / 2; i < damaged.size() / 2 + 40; ++i) damaged[i] ^= '\x55';
  write_atomically(folder_ / "photographs" / "0002.jpg", damaged);
  const Outcome rendered =
      run("EvaluateReconstruction", command + "--photographs photographs --render-folder pictures");
  EXPECT_EQ(rendered.exit_code, 1);
  EXPECT_THAT(rendered.output, HasSubstr("0002.jpg"));
  EXPECT_FALSE(fs::exists(folder_ / "pictures" / "0000.png"));
  const Outcome drawn = run("EvaluateReconstruction",
                            "-i textured.ply -m truth.ply --cameras true --picture picture.png "
                            "--picture-camera 9.jpg --aligned aligned.ply");
  EXPECT_THAT(drawn.output, HasSubstr("--picture-camera 9.jpg: no such image"));
  EXPECT_FALSE(fs::exists(folder_ / "aligned.ply"));
  const Outcome measured = run("EvaluateReconstruction",
                               "-i textured.ply -m truth.ply --cameras true --min-views 99 "
                               "--aligned aligned.ply --transform-out moved.txt");
  EXPECT_EQ(measured.exit_code, 1) << measured.output;
  EXPECT_FALSE(fs::exists(folder_ / "aligned.ply"));
  EXPECT_FALSE(fs::exists(folder_ / "moved.txt"));
}

TEST_F(Programs, RenderAMeshColouredByItsErrors) {
  write_scene();
  Mesh mesh = height_field(60, 2, ripples);
  for (auto& x : mesh.vertices) x.z() += x.x() > 0 ? 0.05f : 0.0f;
  io::write_mesh_ply(folder_ / "mesh.ply", mesh);
  const std::string views = " --cameras true --render all --render-type jpg --render-samples 1 ";
  const Outcome outcome = run("EvaluateReconstruction",
                              "-i mesh.ply -m truth.ply --samples 1000 --error-mesh errors.ply "
                              "--render-folder out --json out.json" +
                                  views);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const Mesh errors = io::read_mesh_ply(folder_ / "errors.ply");
  ASSERT_EQ(errors.colors.size(), mesh.vertices.size());
  EXPECT_EQ(errors.faces, mesh.faces);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    EXPECT_EQ(errors.colors[i][0] > errors.colors[i][2], mesh.vertices[i].x() > 0) << i;
  EXPECT_EQ(read_json("out.json")["render"]["views"].size(), 4u);
  const cv::Mat3b picture = io::read_color_image(folder_ / "out" / "0000.errors.jpg");
  EXPECT_GT(picture(100, 280)[2], picture(100, 280)[0]);
  EXPECT_GT(picture(100, 40)[0], picture(100, 40)[2]);
  EXPECT_FALSE(fs::exists(folder_ / "out" / "0000.jpg")) << "the mesh has no colours of its own";
  ASSERT_EQ(run("EvaluateReconstruction", "-i errors.ply --render-folder own" + views).exit_code,
            0);
  ASSERT_EQ(
      run("EvaluateReconstruction", "-i errors.ply --render-folder small --render-width 80" + views)
          .exit_code,
      0);
  EXPECT_EQ(io::read_image_size(folder_ / "small" / "0000.jpg"), cv::Size(80, 60));
  Mesh half = height_field(60, 2, ripples);
  std::erase_if(half.faces, [&](const auto& face) { return half.vertices[face[0]].x() > 0.2f; });
  io::write_mesh_ply(folder_ / "half.ply", half);
  ASSERT_EQ(
      run("EvaluateReconstruction",
          "-i errors.ply -m half.ply --photographs own --samples 1000 --json out.json" + views)
          .exit_code,
      0);
  const auto view = read_json("out.json")["render"]["views"][0];
  EXPECT_LT(view["truth_covered"], view["covered"].get<double>() - 0.1);
  EXPECT_LE(view["compared"], view["truth_covered"]);
  EXPECT_GT(view["psnr"], 35.0) << "the pictures differ by their JPEG compression";
}

TEST_F(Programs, RefuseToRender) {
  write_scene();
  write_textured(folder_);
  const std::string views = " --cameras true --render 0001.jpg ";
  refuses("--render needs --cameras", "-i textured.ply --render 0001.jpg --render-folder out");
  refuses("--render needs --render-folder or --photographs", "-i textured.ply" + views);
  refuses("--render-folder needs --render", "-i textured.ply -m truth.ply --render-folder out");
  refuses("--picture needs --truth-file",
          "-i textured.ply --render-folder out --picture a.png" + views);
  refuses("--render 7.jpg: no such image in",
          "-i textured.ply --cameras true --render 7.jpg --render-folder out");
  refuses("--render ,0001.jpg",
          "-i textured.ply --cameras true --render ,0001.jpg --render-folder o");
  refuses("--render-type gif: must be",
          "-i textured.ply --render-folder out --render-type gif" + views);
  refuses("--render-samples 0: must be",
          "-i textured.ply --render-folder out --render-samples 0" + views);
  refuses("--render-width -1: must be",
          "-i textured.ply --render-folder out --render-width -1" + views);
  refuses("--render-width 100: photographs",
          "-i textured.ply --photographs . --render-width 100" + views);
  refuses("truth.ply: the mesh has neither", "-i truth.ply --render-folder out" + views);
  refuses("cloud.ply has no faces", "-i cloud.ply --render-folder out" + views);
  refuses("--render is for clouds and meshes", "-i a.dmap -m a.tiff --render-folder out" + views);
  refuses("0001.jpg", "-i textured.ply --photographs . " + views);
  io::write_png(folder_ / "0001.jpg", cv::Mat3b(10, 10));
  refuses("0001.jpg: is 10 x 10, but its camera is 320 x 240",
          "-i textured.ply --photographs . " + views);
  for (const char* texture : {"textured0.png", "textured_material_0_map_Kd.png"})
    fs::remove(folder_ / texture);
  refuses("textured0.png", "-i textured.ply --render-folder out" + views);
  refuses("textured_material_0_map_Kd.png", "-i textured.obj --render-folder out" + views);
}

}  // namespace
}  // namespace axial::evaluate
