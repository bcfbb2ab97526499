// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/atomic_file.h"
#include "bytes/private/byte_reader.h"
#include "bytes/private/byte_writer.h"
#include "colmap/private/colmap_parts.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// Smallest records, in bytes: a camera of two parameters, an image with an empty name, a point
// without a track.
constexpr std::size_t kMinCamera = 4 + 4 + 8 + 8 + 2 * 8;
constexpr std::size_t kMinImage = 4 + 7 * 8 + 4 + 1 + 8;
constexpr std::size_t kMinPoint = 8 + 3 * 8 + 3 + 8 + 8;
constexpr std::size_t kObservation = 8 + 8 + 8;
constexpr std::size_t kTrackElement = 4 + 4;

void require_finite(double value, const char* field, std::uint64_t id, const std::string& file) {
  if (!std::isfinite(value)) fail_in(file, "{} of record {} is {}", field, id, value);
}

std::optional<refractive::Port<double>> parse_port(ByteReader& in, const ColmapCamera& camera,
                                                   const Context& context) {
  const auto number = in.read<std::int32_t>("port");
  if (number == -1) return std::nullopt;
  const std::string where = fmt::format("{}: camera {}", in.file(), camera.id);
  if (port_word(number).empty()) fail("{} has the unknown port number {}", where, number);
  PortNumbers numbers;
  in.read(std::span(numbers), "port parameters");
  return port_from(port_word(number), numbers, where, context);
}

ColmapCamera parse_camera(ByteReader& in, Dialect dialect, const Context& context) {
  ColmapCamera camera;
  camera.id = in.read<std::uint32_t>("camera id");
  const auto model = in.read<std::int32_t>("camera model");
  camera.model = colmap_model_name(model, dialect);
  if (camera.model.empty())
    fail_in(in.file(), "camera {} has the unknown model number {}", camera.id, model);
  camera.width = in.read<std::uint64_t>("width");
  camera.height = in.read<std::uint64_t>("height");
  camera.params.resize(static_cast<std::size_t>(colmap_parameter_count(camera.model)));
  in.read(std::span(camera.params), "camera parameters");
  check_colmap_camera(camera, in.file());
  if (dialect == Dialect::underwater) camera.port = parse_port(in, camera, context);
  return camera;
}

ColmapImage parse_image(ByteReader& in) {
  ColmapImage image;
  image.id = in.read<std::uint32_t>("image id");
  ColmapPose pose;
  in.read(std::span(pose), "image pose");
  image.pose = pose_from_colmap(pose, fmt::format("{}: image {}", in.file(), image.id));
  image.camera = in.read<std::uint32_t>("camera id");
  image.name = in.c_string("image name");
  if (image.name.empty()) fail_in(in.file(), "image {} has no name", image.id);
  image.points.resize(in.count(kObservation, "2D points"));
  for (ColmapPoint2D& point : image.points) {
    point.x = in.read<double>("x of a 2D point");
    point.y = in.read<double>("y of a 2D point");
    require_finite(point.x, "x of a 2D point", image.id, in.file());
    require_finite(point.y, "y of a 2D point", image.id, in.file());
    point.point3d = in.read<std::uint64_t>("3D point id");
  }
  return image;
}

ColmapPoint3D parse_point(ByteReader& in) {
  ColmapPoint3D point;
  point.id = in.read<std::uint64_t>("3D point id");
  in.read(std::span(point.position.data(), 3), "position");
  for (const double value : point.position) require_finite(value, "position", point.id, in.file());
  in.read(std::span(point.color), "colour");
  point.error = in.read<double>("error");
  require_finite(point.error, "error", point.id, in.file());
  point.track.resize(in.count(kTrackElement, "track"));
  for (ColmapTrackElement& element : point.track) {
    element.image = in.read<std::uint32_t>("image id of the track");
    element.point2d = in.read<std::uint32_t>("2D point of the track");
  }
  return point;
}

// Reads a file that consists of a count and that many records.
template <class T>
std::vector<T> read_records(const fs::path& path, std::size_t min_bytes, const char* field,
                            T (*parse)(ByteReader&)) {
  const std::string bytes = read_file(path);
  ByteReader in(bytes, path.string());
  std::vector<T> records(in.count(min_bytes, field));
  for (T& record : records) record = parse(in);
  in.require_end();
  return records;
}

std::vector<ColmapCamera> cameras_from(const std::string& bytes, const fs::path& path,
                                       Dialect dialect, const Context& context) {
  ByteReader in(bytes, path.string());
  std::vector<ColmapCamera> cameras(in.count(kMinCamera, "cameras"));
  for (ColmapCamera& camera : cameras) camera = parse_camera(in, dialect, context);
  in.require_end();
  return cameras;
}

std::string cameras_as_bytes(const ColmapModel& model, const std::string& file, Dialect dialect) {
  ByteWriter out;
  out.count(model.cameras.size());
  for (const ColmapCamera& camera : model.cameras) {
    const int id = colmap_model_id(camera.model, dialect);
    if (id < 0)
      fail_in(file, "camera {} has model '{}', which this binary format does not support",
              camera.id, camera.model);
    check_colmap_camera(camera, file);
    out.write(camera.id);
    out.write(static_cast<std::int32_t>(id));
    out.write(camera.width);
    out.write(camera.height);
    out.write(std::span(camera.params));
    if (dialect == Dialect::colmap) continue;
    out.write(static_cast<std::int32_t>(camera.port ? port_number(*camera.port) : -1));
    if (!camera.port) continue;
    const PortNumbers numbers = port_numbers(*camera.port);
    out.write(std::span(numbers));
  }
  return out.bytes();
}

std::string images_as_bytes(const ColmapModel& model, const std::string& file) {
  ByteWriter out;
  out.count(model.images.size());
  for (const ColmapImage& image : model.images) {
    if (image.name.empty() || image.name.find('\0') != std::string::npos)
      fail_in(file, "image {} has an empty name or a name with a NUL", image.id);
    const ColmapPose pose = pose_to_colmap(image.pose);
    out.write(image.id);
    out.write(std::span(pose));
    out.write(image.camera);
    out.text(image.name);
    out.write('\0');
    out.count(image.points.size());
    for (const ColmapPoint2D& point : image.points) {
      out.write(point.x);
      out.write(point.y);
      out.write(point.point3d);
    }
  }
  return out.bytes();
}

std::string points_as_bytes(const ColmapModel& model) {
  ByteWriter out;
  out.count(model.points.size());
  for (const ColmapPoint3D& point : model.points) {
    out.write(point.id);
    out.write(std::span(point.position.data(), 3));
    out.write(std::span(point.color));
    out.write(point.error);
    out.count(point.track.size());
    for (const ColmapTrackElement& element : point.track) {
      out.write(element.image);
      out.write(element.point2d);
    }
  }
  return out.bytes();
}

}  // namespace

// The file does not name its dialect. If a file of one dialect is read as the other, the reader is
// misaligned after the first camera. It then finds unknown model numbers, or does not end where the
// file ends.
std::vector<ColmapCamera> read_cameras_binary(const fs::path& path, const Context& context) {
  const std::string bytes = read_file(path);
  try {
    return cameras_from(bytes, path, Dialect::colmap, context);
  } catch (const Error&) {
    try {
      return cameras_from(bytes, path, Dialect::underwater, context);
    } catch (const Error&) {
    }
    throw;
  }
}

std::vector<ColmapImage> read_images_binary(const fs::path& path) {
  return read_records<ColmapImage>(path, kMinImage, "images", parse_image);
}

std::vector<ColmapPoint3D> read_points_binary(const fs::path& path) {
  return read_records<ColmapPoint3D>(path, kMinPoint, "points", parse_point);
}

namespace {

void write_binary(const fs::path& folder, const ColmapModel& model, Dialect dialect) {
  const auto name = [&](const char* file) { return (folder / file).string(); };
  write_atomically(name("cameras.bin"), cameras_as_bytes(model, name("cameras.bin"), dialect));
  write_atomically(name("images.bin"), images_as_bytes(model, name("images.bin")));
  write_atomically(name("points3D.bin"), points_as_bytes(model));
}

}  // namespace

void write_colmap_binary(const fs::path& folder, const ColmapModel& model) {
  write_binary(folder, model, Dialect::colmap);
}

void write_underwater_binary(const fs::path& folder, const ColmapModel& model) {
  write_binary(folder, model, Dialect::underwater);
}

}  // namespace axial::io
