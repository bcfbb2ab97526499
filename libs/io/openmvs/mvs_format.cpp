// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/openmvs/mvs_format.h"

#include <algorithm>
#include <filesystem>

#include "base/file_extension.h"
#include "private/bytes/byte_reader.h"
#include "private/bytes/byte_writer.h"

namespace axial::io {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr std::size_t kLeastCamera = mvs_bytes::kLength + 21 * 8;
constexpr std::size_t kLeastPlatform = mvs_bytes::kLength + 2 * mvs_bytes::kLength;
constexpr std::size_t kLeastImage = mvs_bytes::kLength + 3 * 4;
constexpr std::size_t kLeastVertex = 3 * 4 + mvs_bytes::kLength;
constexpr std::size_t kLeastLine = 6 * 4 + mvs_bytes::kLength;
constexpr std::size_t kTransform = 16 * 8;

Eigen::Matrix3d read_matrix(ByteReader& in, std::string_view field) {
  RowMajor matrix;
  in.read(std::span(matrix.data(), 9), field);
  return matrix;
}

Eigen::Vector3d read_vector(ByteReader& in, std::string_view field) {
  Eigen::Vector3d vector;
  in.read(std::span(vector.data(), 3), field);
  return vector;
}

Eigen::Vector3f read_vector3f(ByteReader& in, std::string_view field) {
  Eigen::Vector3f vector;
  in.read(std::span(vector.data(), 3), field);
  return vector;
}

MvsPose read_pose(ByteReader& in) {
  MvsPose pose;
  pose.rotation = read_matrix(in, "rotation");
  pose.centre = read_vector(in, "centre");
  return pose;
}

MvsCamera read_camera(ByteReader& in, std::uint32_t version) {
  MvsCamera camera;
  in.string("camera name");
  if (version >= 4) in.string("camera bandName");
  if (version >= 1) {
    camera.width = in.read<std::uint32_t>("camera width");
    camera.height = in.read<std::uint32_t>("camera height");
  }
  camera.k = read_matrix(in, "camera K");
  camera.on_platform = read_pose(in);
  return camera;
}

MvsPlatform read_platform(ByteReader& in, std::uint32_t version) {
  MvsPlatform platform;
  in.string("platform name");
  platform.cameras.resize(in.count(kLeastCamera, "platform cameras"));
  for (MvsCamera& camera : platform.cameras) camera = read_camera(in, version);
  platform.poses.resize(in.count(mvs_bytes::kPose, "platform poses"));
  for (MvsPose& pose : platform.poses) pose = read_pose(in);
  return platform;
}

ViewScore read_view_score(ByteReader& in) {
  ViewScore score;
  score.image = in.read<std::uint32_t>("viewScores ID");
  score.points = in.read<std::uint32_t>("viewScores points");
  score.scale = in.read<float>("viewScores scale");
  score.angle = in.read<float>("viewScores angle");
  score.area = in.read<float>("viewScores area");
  score.score = in.read<float>("viewScores score");
  return score;
}

MvsImage read_image(ByteReader& in, std::uint32_t version) {
  MvsImage image;
  image.name = in.string("image name");
  if (version >= 5) image.mask_name = in.string("image maskName");
  image.platform = in.read<std::uint32_t>("image platformID");
  image.camera = in.read<std::uint32_t>("image cameraID");
  image.pose = in.read<std::uint32_t>("image poseID");
  if (version >= 3) image.id = in.read<std::uint32_t>("image ID");
  if (version >= 7) {
    image.min_depth = in.read<float>("image minDepth");
    image.average_depth = in.read<float>("image avgDepth");
    image.max_depth = in.read<float>("image maxDepth");
    image.view_scores.resize(in.count(mvs_bytes::kViewScore, "image viewScores"));
    for (ViewScore& score : image.view_scores) score = read_view_score(in);
  }
  return image;
}

std::vector<SparseView> read_views(ByteReader& in) {
  std::vector<SparseView> views(in.count(mvs_bytes::kView, "views"));
  for (SparseView& view : views) {
    view.image = in.read<std::uint32_t>("view imageID");
    view.confidence = in.read<float>("view confidence");
  }
  return views;
}

SparsePoint read_vertex(ByteReader& in) {
  SparsePoint point;
  point.position = read_vector3f(in, "vertex position");
  point.views = read_views(in);
  return point;
}

std::vector<Eigen::Vector3f> read_normals(ByteReader& in, std::string_view field) {
  std::vector<Eigen::Vector3f> normals(in.count(mvs_bytes::kVector3f, field));
  for (Eigen::Vector3f& normal : normals) normal = read_vector3f(in, field);
  return normals;
}

std::vector<Rgb> read_colors(ByteReader& in, std::string_view field) {
  std::vector<Rgb> colors(in.count(mvs_bytes::kColor, field));
  for (Rgb& color : colors) {
    in.read(std::span(color), field);
    std::swap(color[0], color[2]);  // stored blue, green, red
  }
  return colors;
}

void skip_lines(ByteReader& in) {
  const std::size_t lines = in.count(kLeastLine, "lines");
  for (std::size_t i = 0; i < lines; ++i) {
    in.take(2 * mvs_bytes::kVector3f, "line");
    read_views(in);
  }
  read_normals(in, "linesNormal");
  read_colors(in, "linesColor");
}

MvsFile read_body(ByteReader& in, std::uint32_t version) {
  MvsFile mvs;
  mvs.platforms.resize(in.count(kLeastPlatform, "platforms"));
  for (MvsPlatform& platform : mvs.platforms) platform = read_platform(in, version);
  mvs.images.resize(in.count(kLeastImage, "images"));
  for (MvsImage& image : mvs.images) image = read_image(in, version);
  mvs.points.resize(in.count(kLeastVertex, "vertices"));
  for (SparsePoint& point : mvs.points) point = read_vertex(in);
  mvs.normals = read_normals(in, "verticesNormal");
  mvs.colors = read_colors(in, "verticesColor");
  if (version >= 1) skip_lines(in);
  if (version >= 2) in.take(kTransform, "transform");
  if (version >= 6) {
    mvs.box.rotation = read_matrix(in, "obb rot");
    mvs.box.min = read_vector(in, "obb ptMin");
    mvs.box.max = read_vector(in, "obb ptMax");
  }
  in.require_end();
  return mvs;
}

bool has_mvs_extension(const std::string& file) {
  return lower_extension(file) == ".mvs";
}

void write_matrix(ByteWriter& out, const Eigen::Matrix3d& matrix) {
  const RowMajor rows = matrix;
  out.write(std::span(rows.data(), 9));
}

template <class T>
void write_vector(ByteWriter& out, const Eigen::Matrix<T, 3, 1>& vector) {
  out.write(std::span(vector.data(), 3));
}

void write_pose(ByteWriter& out, const MvsPose& pose) {
  write_matrix(out, pose.rotation);
  write_vector(out, pose.centre);
}

void write_platform(ByteWriter& out, const MvsPlatform& platform) {
  out.string("");
  out.count(platform.cameras.size());
  for (const MvsCamera& camera : platform.cameras) {
    out.string("");
    out.string("");
    out.write(camera.width);
    out.write(camera.height);
    write_matrix(out, camera.k);
    write_pose(out, camera.on_platform);
  }
  out.count(platform.poses.size());
  for (const MvsPose& pose : platform.poses) write_pose(out, pose);
}

void write_image(ByteWriter& out, const MvsImage& image) {
  out.string(image.name);
  out.string(image.mask_name);
  for (const std::uint32_t id : {image.platform, image.camera, image.pose, image.id}) out.write(id);
  for (const float depth : {image.min_depth, image.average_depth, image.max_depth})
    out.write(depth);
  out.count(image.view_scores.size());
  for (const ViewScore& score : image.view_scores) {
    out.write(score.image);
    out.write(score.points);
    for (const float value : {score.scale, score.angle, score.area, score.score}) out.write(value);
  }
}

void write_vertex(ByteWriter& out, const SparsePoint& point) {
  write_vector(out, point.position);
  out.count(point.views.size());
  for (const SparseView& view : point.views) {
    out.write(view.image);
    out.write(view.confidence);
  }
}

}  // namespace

MvsFile parse_mvs(std::string_view bytes, const std::string& file) {
  using namespace std::string_view_literals;
  if (bytes.empty()) fail("{}: is empty", file);
  if (bytes.starts_with("MVS\0"sv))
    fail(
        "{}: is a native OpenMVS project, which only OpenMVS can read: save it again "
        "with OpenMVS as an interchange scene (archive type -1)",
        file);
  if (!bytes.starts_with("MVSI")) {
    if (!has_mvs_extension(file))
      fail("{}: is not a .mvs scene: it does not start with MVSI", file);
    ByteReader in(bytes, file + " (no MVSI header, so read as version 0)");
    return read_body(in, 0);
  }
  ByteReader in(bytes, file);
  in.take(4, "header");
  const auto version = in.read<std::uint32_t>("version");
  in.read<std::uint32_t>("header");
  if (version < 1 || version > kMvsVersion)
    fail("{}: version is {}, but 1 to {} are supported", file, version, kMvsVersion);
  return read_body(in, version);
}

std::string format_mvs(const MvsFile& mvs, std::size_t room) {
  ByteWriter out;
  out.reserve(room);
  out.text("MVSI");
  out.write(kMvsVersion);
  out.write(std::uint32_t{0});
  out.count(mvs.platforms.size());
  for (const MvsPlatform& platform : mvs.platforms) write_platform(out, platform);
  out.count(mvs.images.size());
  for (const MvsImage& image : mvs.images) write_image(out, image);
  out.count(mvs.points.size());
  for (const SparsePoint& point : mvs.points) write_vertex(out, point);
  out.count(mvs.normals.size());
  for (const Eigen::Vector3f& normal : mvs.normals) write_vector(out, normal);
  out.count(mvs.colors.size());
  for (const Rgb& color : mvs.colors)
    for (const std::size_t channel : {2u, 1u, 0u}) out.write(color[channel]);
  for (int i = 0; i < 3; ++i) out.count(0);                        // lines, linesNormal, linesColor
  for (int i = 0; i < 16; ++i) out.write(i % 5 == 0 ? 1.0 : 0.0);  // transform: identity
  write_matrix(out, mvs.box.rotation);
  write_vector(out, mvs.box.min);
  write_vector(out, mvs.box.max);
  return out.take();
}

}  // namespace axial::io
