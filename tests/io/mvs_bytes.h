// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of .mvs scenes, written field by field from the description of the format, for the
// tests of reading and of writing such scenes.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/images/image.h"
#include "io/openmvs/mvs.h"
#include "io/wrong_input.h"

namespace axial::io {

// A file in memory. The functions append numbers and texts in the encoding of the format.
struct Bytes {
  std::string data;

  void u8(unsigned v) { data.push_back(static_cast<char>(v)); }
  void u32(std::uint64_t v) {
    for (int i = 0; i < 4; ++i) u8(static_cast<unsigned>(v >> (8 * i)) & 255);
  }
  void u64(std::uint64_t v) {
    u32(v & 0xFFFFFFFFu);
    u32(v >> 32);
  }
  void f32(float v) { u32(std::bit_cast<std::uint32_t>(v)); }
  void f64(double v) { u64(std::bit_cast<std::uint64_t>(v)); }
  void string(const std::string& s) {
    u64(s.size());
    data += s;
  }
  void f64s(const std::vector<double>& values) {
    for (const double v : values) f64(v);
  }
};

// The fields of a small scene: two images of one camera, and an uncalibrated image. A test can give
// any field a wrong value.
struct Description {
  unsigned version = 7;
  unsigned width = 640, height = 480;
  std::vector<double> k{500, 0, 320, 0, 510, 240, 0, 0, 1};
  std::vector<double> camera_r{1, 0, 0, 0, 1, 0, 0, 0, 1}, camera_c{0, 0, 0};
  std::vector<double> pose_r{0, 1, 0, -1, 0, 0, 0, 0, 1}, pose_c{1, 2, 3};
  unsigned platform = 0, camera = 0, pose = 0;  // ids of the first image
  unsigned first_id = 40, second_id = 7;
  std::string name = "images\\a.png";
  unsigned view_image = 1, score_image = 1;
  float x = 1, score = 5;
  std::uint64_t vertices = 2, normals = 2, colors = 2;  // counts in the file
  std::vector<double> box_min{0, 0, 0}, box_max{0, 0, 0};
  std::vector<double> box_r{1, 0, 0, 0, 1, 0, 0, 0, 1};
  bool third_image = true;
};

inline void put_image(Bytes& b, const Description& d, const std::string& name,
                      std::uint64_t platform, std::uint64_t camera, std::uint64_t pose,
                      std::uint64_t id, bool scored) {
  b.string(name);
  if (d.version >= 5) b.string(scored ? "masks/a.png" : "");
  b.u32(platform);
  b.u32(camera);
  b.u32(pose);
  if (d.version >= 3) b.u32(id);
  if (d.version < 7) return;
  for (const float depth : {1.0f, 2.0f, 3.0f}) b.f32(depth);
  b.u64(scored ? 1 : 0);
  if (!scored) return;
  b.u32(d.score_image);
  b.u32(12);
  for (const float v : {1.5f, 0.25f, 0.75f, d.score}) b.f32(v);
}

inline void put_points(Bytes& b, const Description& d) {
  b.u64(d.vertices);
  for (const float v : {d.x, 2.0f, 3.0f}) b.f32(v);
  b.u64(3);  // unsorted, with a duplicate
  for (const unsigned image : {d.view_image, 0u, 0u}) {
    b.u32(image);
    b.f32(0.5f);
  }
  for (const float v : {4.0f, 5.0f, 6.0f}) b.f32(v);
  b.u64(0);
  b.u64(d.normals);
  for (const float v : {0.0f, 0.0f, 1.0f, 0.0f, 1.0f, 0.0f}) b.f32(v);
  b.u64(d.colors);
  for (const unsigned v : {1u, 2u, 3u, 4u, 5u, 6u}) b.u8(v);
}

inline std::string bytes_of(const Description& d) {
  Bytes b;
  if (d.version >= 1) {
    b.data = "MVSI";
    b.u32(d.version);
    b.u32(0);
  }
  b.u64(1);
  b.string("platform");
  b.u64(1);
  b.string("camera");
  if (d.version >= 4) b.string("band");
  if (d.version >= 1) {
    b.u32(d.width);
    b.u32(d.height);
  }
  b.f64s(d.k);
  b.f64s(d.camera_r);
  b.f64s(d.camera_c);
  b.u64(2);
  for (int i = 0; i < 2; ++i) {
    b.f64s(d.pose_r);
    b.f64s(d.pose_c);
  }
  b.u64(d.third_image ? 3 : 1);
  put_image(b, d, d.name, d.platform, d.camera, d.pose, d.first_id, true);
  if (d.third_image) {
    put_image(b, d, "images/b.png", 0, 0, 1, d.second_id, false);
    put_image(b, d, "images/c.png", 0, 0, kNoId, kNoId, false);
  }
  put_points(b, d);
  if (d.version >= 1) {  // one line seen by one image, its normal and colour
    b.u64(1);
    for (int i = 0; i < 6; ++i) b.f32(1);
    b.u64(1);
    b.u32(0);
    b.f32(0);
    b.u64(1);
    for (int i = 0; i < 3; ++i) b.f32(0);
    b.u64(1);
    for (int i = 0; i < 3; ++i) b.u8(9);
  }
  if (d.version >= 2)
    for (int i = 0; i < 16; ++i) b.f64(i % 5 == 0);
  if (d.version >= 6) {
    b.f64s(d.box_r);
    b.f64s(d.box_min);
    b.f64s(d.box_max);
  }
  return b.data;
}

class MvsTest : public test::FolderTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "images");
    for (const char* name : {"a.png", "b.png"})
      write_png(folder_ / "images" / name, cv::Mat3b(480, 640, cv::Vec3b(1, 2, 3)));
  }

  Scene read(const Description& d) {
    test::put(file_, bytes_of(d));
    return read_mvs(file_, folder_);
  }
  std::string error(const Description& d) {
    return test::error_naming(file_, [&] { read(d); });
  }
  // Returns the error of reading a scene whose description was changed by `change`.
  std::string error(const std::function<void(Description&)>& change) {
    Description d;
    change(d);
    return error(d);
  }

  std::filesystem::path file_ = folder_ / "scene.mvs";
};

}  // namespace axial::io
