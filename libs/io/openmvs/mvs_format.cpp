// SPDX-License-Identifier: GPL-3.0-or-later
#include "openmvs/private/mvs_format.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/file_extension.h"
#include "bytes/private/byte_reader.h"
#include "bytes/private/byte_writer.h"

namespace axial::io {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr std::size_t kLeastCamera = mvs_bytes::kLength + 21 * 8;
constexpr std::size_t kLeastPlatform = mvs_bytes::kLength + 2 * mvs_bytes::kLength;
constexpr std::size_t kLeastImage = mvs_bytes::kLength + 3 * 4;
constexpr std::size_t kLeastVertex = 3 * 4 + mvs_bytes::kLength;
constexpr std::size_t kLeastLine = 6 * 4 + mvs_bytes::kLength;

// The reader and the writer of records have the same functions, so that fields() below states the
// format once for both. Record<T> is the type of a record: T, or const T for the writer.
class MvsReader {
 public:
  template <class T>
  using Record = T;

  MvsReader(ByteReader& in, std::uint32_t file_version) : version(file_version), in_(in) {}

  const std::uint32_t version;

  template <class T>
  void number(T& value, std::string_view field) {
    value = in_.read<T>(field);
  }
  void text(std::string& value, std::string_view field) { value = in_.string(field); }
  void unused_text(std::string_view field) { in_.string(field); }
  template <class T>
  void vector(Eigen::Matrix<T, 3, 1>& value, std::string_view field) {
    in_.read(std::span(value.data(), 3), field);
  }
  void matrix(Eigen::Matrix3d& value, std::string_view field) {
    RowMajor rows;
    in_.read(std::span(rows.data(), 9), field);
    value = rows;
  }
  template <class T>
  void list(std::vector<T>& items, std::size_t least_bytes, std::string_view field) {
    items.resize(in_.count(least_bytes, field));
    for (T& item : items) fields(*this, item);
  }
  template <class T>
  void unused_list(std::size_t least_bytes, std::string_view field) {
    T item;
    for (std::size_t left = in_.count(least_bytes, field); left > 0; --left) fields(*this, item);
  }
  void unused_transform() { in_.take(16 * sizeof(double), "transform"); }

 private:
  ByteReader& in_;
};

class MvsWriter {
 public:
  template <class T>
  using Record = const T;

  explicit MvsWriter(ByteWriter& out) : out_(out) {}

  static constexpr std::uint32_t version = kMvsVersion;

  template <class T>
  void number(T value, std::string_view) {
    out_.write(value);
  }
  void text(const std::string& value, std::string_view) { out_.string(value); }
  void unused_text(std::string_view) { out_.string(""); }
  template <class T>
  void vector(const Eigen::Matrix<T, 3, 1>& value, std::string_view) {
    out_.write(std::span(value.data(), 3));
  }
  void matrix(const Eigen::Matrix3d& value, std::string_view) {
    const RowMajor rows = value;
    out_.write(std::span(rows.data(), 9));
  }
  template <class T>
  void list(const std::vector<T>& items, std::size_t, std::string_view) {
    out_.count(items.size());
    for (const T& item : items) fields(*this, item);
  }
  template <class T>
  void unused_list(std::size_t, std::string_view) {
    out_.count(0);
  }
  void unused_transform() {
    for (int i = 0; i < 16; ++i) out_.write(i % 5 == 0 ? 1.0 : 0.0);  // the identity
  }

 private:
  ByteWriter& out_;
};

template <class File, class T>
using Record = typename File::template Record<T>;

template <class File>
void fields(File& file, Record<File, Eigen::Vector3f>& vector) {
  file.vector(vector, "a vector");
}

// Stored blue, green, red.
template <class File>
void fields(File& file, Record<File, Rgb>& color) {
  for (const std::size_t channel : {2u, 1u, 0u}) file.number(color[channel], "a colour");
}

template <class File>
void fields(File& file, Record<File, MvsPose>& pose) {
  file.matrix(pose.rotation, "rotation");
  file.vector(pose.centre, "centre");
}

template <class File>
void fields(File& file, Record<File, MvsCamera>& camera) {
  file.unused_text("camera name");
  if (file.version >= 4) file.unused_text("camera bandName");
  if (file.version >= 1) {
    file.number(camera.width, "camera width");
    file.number(camera.height, "camera height");
  }
  file.matrix(camera.k, "camera K");
  fields(file, camera.on_platform);
}

template <class File>
void fields(File& file, Record<File, MvsPlatform>& platform) {
  file.unused_text("platform name");
  file.list(platform.cameras, kLeastCamera, "platform cameras");
  file.list(platform.poses, mvs_bytes::kPose, "platform poses");
}

template <class File>
void fields(File& file, Record<File, ViewScore>& score) {
  file.number(score.image, "viewScores ID");
  file.number(score.points, "viewScores points");
  file.number(score.scale, "viewScores scale");
  file.number(score.angle, "viewScores angle");
  file.number(score.area, "viewScores area");
  file.number(score.score, "viewScores score");
}

template <class File>
void fields(File& file, Record<File, MvsImage>& image) {
  file.text(image.name, "image name");
  if (file.version >= 5) file.text(image.mask_name, "image maskName");
  file.number(image.platform, "image platformID");
  file.number(image.camera, "image cameraID");
  file.number(image.pose, "image poseID");
  if (file.version >= 3) file.number(image.id, "image ID");
  if (file.version < 7) return;
  file.number(image.min_depth, "image minDepth");
  file.number(image.average_depth, "image avgDepth");
  file.number(image.max_depth, "image maxDepth");
  file.list(image.view_scores, mvs_bytes::kViewScore, "image viewScores");
}

template <class File>
void fields(File& file, Record<File, SparseView>& view) {
  file.number(view.image, "view imageID");
  file.number(view.confidence, "view confidence");
}

template <class File>
void fields(File& file, Record<File, SparsePoint>& point) {
  file.vector(point.position, "vertex position");
  file.list(point.views, mvs_bytes::kView, "views");
}

struct MvsLine {
  Eigen::Vector3f from, to;
};

template <class File>
void fields(File& file, Record<File, MvsLine>& line) {
  file.vector(line.from, "line");
  file.vector(line.to, "line");
  file.template unused_list<SparseView>(mvs_bytes::kView, "views");
}

template <class File>
void fields(File& file, Record<File, MvsFile>& mvs) {
  file.list(mvs.platforms, kLeastPlatform, "platforms");
  file.list(mvs.images, kLeastImage, "images");
  file.list(mvs.points, kLeastVertex, "vertices");
  file.list(mvs.normals, mvs_bytes::kVector3f, "verticesNormal");
  file.list(mvs.colors, mvs_bytes::kColor, "verticesColor");
  if (file.version < 1) return;
  file.template unused_list<MvsLine>(kLeastLine, "lines");
  file.template unused_list<Eigen::Vector3f>(mvs_bytes::kVector3f, "linesNormal");
  file.template unused_list<Rgb>(mvs_bytes::kColor, "linesColor");
  if (file.version >= 2) file.unused_transform();
  if (file.version < 6) return;
  file.matrix(mvs.box.rotation, "obb rot");
  file.vector(mvs.box.min, "obb ptMin");
  file.vector(mvs.box.max, "obb ptMax");
}

MvsFile read_body(ByteReader& in, std::uint32_t version) {
  MvsFile mvs;
  MvsReader file(in, version);
  fields(file, mvs);
  in.require_end();
  return mvs;
}

bool has_mvs_extension(const std::string& file) {
  return lower_extension(file) == ".mvs";
}

}  // namespace

MvsFile parse_mvs(std::string_view bytes, const std::string& file) {
  using namespace std::string_view_literals;
  if (bytes.empty()) fail_in(file, "is empty");
  if (bytes.starts_with("MVS\0"sv))
    fail_in(file,
            "is a native OpenMVS project, which only OpenMVS can read: save it again "
            "with OpenMVS as an interchange scene (archive type -1)");
  if (!bytes.starts_with("MVSI")) {
    if (!has_mvs_extension(file)) fail_in(file, "is not a .mvs scene: it does not start with MVSI");
    ByteReader in(bytes, file + " (no MVSI header, so read as version 0)");
    return read_body(in, 0);
  }
  ByteReader in(bytes, file);
  in.take(4, "header");
  const auto version = in.read<std::uint32_t>("version");
  in.read<std::uint32_t>("header");
  if (version < 1 || version > kMvsVersion)
    fail_in(file, "version is {}, but 1 to {} are supported", version, kMvsVersion);
  return read_body(in, version);
}

std::string format_mvs(const MvsFile& mvs, std::size_t room) {
  ByteWriter out;
  out.reserve(room);
  out.text("MVSI");
  out.write(kMvsVersion);
  out.write(std::uint32_t{0});
  MvsWriter file(out);
  fields(file, mvs);
  return out.take();
}

}  // namespace axial::io
