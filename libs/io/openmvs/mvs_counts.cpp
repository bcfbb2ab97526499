// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/mvs_counts.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <vector>

#include "base/heap_bytes.h"
#include "openmvs/private/mvs_format.h"

namespace axial::io {
namespace {

// Reads the numbers of a file and skips the other data. `good` becomes false at the first value
// that is missing. A count is refused if the file is too short for it.
class SkippingReader {
 public:
  explicit SkippingReader(const std::filesystem::path& path) {
    constexpr std::uint64_t kSmallest = 1u << 12, kLargest = 1u << 20;
    std::error_code error;
    left_ = std::filesystem::file_size(path, error);
    buffer_.resize(error ? kSmallest : std::clamp(left_, kSmallest, kLargest));
    in_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    // A pipe has no size, and to open it would wait for its writer.
    if (!error) in_.open(path, std::ios::binary);
    if (error || !in_) fail();
  }

  bool good() const { return good_; }
  std::uint64_t left() const { return left_; }

  template <class T>
  T read() {
    T value{};
    if (!claim(1, sizeof value)) return {};
    in_.read(reinterpret_cast<char*>(&value), sizeof value);
    if (!in_) fail();
    return good_ ? value : T{};
  }

  void skip(std::uint64_t count, std::uint64_t each = 1) {
    if (claim(count, each)) in_.ignore(static_cast<std::streamsize>(count * each));
  }

  // Reads a 64-bit count of elements of at least `each` bytes.
  std::uint64_t count(std::uint64_t each) {
    const auto number = read<std::uint64_t>();
    if (number > left_ / each) fail();
    return good_ ? number : 0;
  }

  // Skips an array and returns its length.
  std::uint64_t array(std::uint64_t each) {
    const std::uint64_t length = count(each);
    skip(length, each);
    return length;
  }

 private:
  void fail() {
    good_ = false;
    left_ = 0;
  }

  bool claim(std::uint64_t count, std::uint64_t each) {
    if (count > left_ / each) fail();
    if (good_) left_ -= count * each;
    return good_;
  }

  std::vector<char> buffer_;
  std::ifstream in_;
  std::uint64_t left_ = 0;
  bool good_ = true;
};

constexpr std::uint64_t kCamera = 9 * 8 + mvs_bytes::kPose;

void count_platforms(SkippingReader& in, std::uint32_t version, MvsCounts& counts) {
  const std::uint64_t platforms = in.count(3 * mvs_bytes::kLength);
  for (std::uint64_t i = 0; i < platforms && in.good(); ++i) {
    in.array(1);
    const std::uint64_t cameras = in.count(mvs_bytes::kLength + kCamera);
    for (std::uint64_t k = 0; k < cameras && in.good(); ++k) {
      in.array(1);
      if (version >= 4) in.array(1);
      in.skip(kCamera + (version >= 1 ? 8 : 0));
    }
    counts.cameras += cameras;
    counts.poses += in.array(mvs_bytes::kPose);
  }
}

void count_images(SkippingReader& in, std::uint32_t version, MvsCounts& counts) {
  counts.images = in.count(mvs_bytes::kLength + 12);
  for (std::uint64_t i = 0; i < counts.images && in.good(); ++i) {
    counts.name_bytes += in.array(1);
    if (version >= 5) counts.name_bytes += in.array(1);
    in.skip(version >= 3 ? 16 : 12);
    if (version < 7) continue;
    in.skip(12);
    counts.view_scores += in.array(mvs_bytes::kViewScore);
  }
}

void count_points(SkippingReader& in, MvsCounts& counts) {
  counts.points = in.count(mvs_bytes::kVector3f + 8);
  for (std::uint64_t i = 0; i < counts.points && in.good(); ++i) {
    in.skip(mvs_bytes::kVector3f);
    const std::uint64_t views = in.array(mvs_bytes::kView);
    counts.observations += views;
    counts.pairs += views > 0 ? views * (views - 1) : 0;
    counts.view_list_bytes += heap_bytes(views * sizeof(SparseView));
  }
}

}  // namespace

std::optional<MvsCounts> count_mvs(const std::filesystem::path& path) {
  SkippingReader in(path);
  MvsCounts counts;
  counts.file_bytes = in.left();
  const auto magic = in.read<std::array<char, 4>>();
  if (std::memcmp(magic.data(), "MVSI", magic.size()) != 0) return {};
  const auto version = in.read<std::uint32_t>();
  in.skip(4);
  count_platforms(in, version, counts);
  count_images(in, version, counts);
  count_points(in, counts);
  counts.normals = in.array(mvs_bytes::kVector3f);
  counts.colors = in.array(mvs_bytes::kColor);
  if (!in.good()) return {};
  return counts;
}

MvsCounts count_scene(const Scene& scene) {
  constexpr std::uint64_t kPlatform =
      3 * mvs_bytes::kLength + 2 * mvs_bytes::kLength + 8 + kCamera + mvs_bytes::kPose;
  constexpr std::uint64_t kImage = 3 * mvs_bytes::kLength + 4 * 4 + 3 * 4;
  MvsCounts counts;
  counts.cameras = counts.poses = counts.images = scene.images.size();
  counts.points = scene.points.size();
  counts.normals = scene.point_normals.size();
  counts.colors = scene.point_colors.size();
  for (const SceneImage& image : scene.images) {
    counts.name_bytes += image.path.size() + image.mask_path.size();
    counts.view_scores += image.neighbours.size();
  }
  for (const SparsePoint& point : scene.points) {
    counts.observations += point.views.size();
    counts.view_list_bytes += heap_bytes(point.views.size() * sizeof(SparseView));
  }
  counts.file_bytes =
      counts.images * (kPlatform + kImage) + counts.name_bytes +
      counts.view_scores * mvs_bytes::kViewScore + counts.points * (mvs_bytes::kVector3f + 8) +
      counts.observations * mvs_bytes::kView + counts.normals * mvs_bytes::kVector3f +
      counts.colors * mvs_bytes::kColor + 1000;
  return counts;
}

void MvsCounts::set_view_scores(std::uint64_t number) {
  file_bytes = file_bytes - mvs_bytes::kViewScore * view_scores + mvs_bytes::kViewScore * number;
  view_scores = number;
}

std::uint64_t MvsCounts::scene_bytes() const {
  constexpr std::uint64_t kPath = 128;  // working folder before a name, and heap overhead
  return images * (sizeof(SceneImage) + 2 * kPath) + name_bytes + view_scores * sizeof(ViewScore) +
         points * sizeof(SparsePoint) + view_list_bytes + normals * mvs_bytes::kVector3f +
         colors * mvs_bytes::kColor;
}

// Counts the bytes of the file, and its records in addition to the scene made from them. A list of
// images that grows exists twice for a moment.
std::uint64_t MvsCounts::reading_bytes() const {
  const std::uint64_t records = cameras * (sizeof(MvsCamera) + sizeof(MvsPlatform)) +
                                poses * sizeof(MvsPose) + images * sizeof(MvsImage) +
                                2 * name_bytes + view_scores * sizeof(ViewScore);
  return scene_bytes() + records + std::max(file_bytes, 2 * images * sizeof(SceneImage));
}

// Counts the records of the scene and the bytes of the file.
std::uint64_t MvsCounts::writing_bytes() const {
  return scene_bytes() + file_bytes;
}

}  // namespace axial::io
