// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>

#include "base/atomic_file.h"
#include "bytes/private/text_reader.h"
#include "colmap/private/colmap_parts.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

void require_no_rest(const TextLine& line) {
  if (!line.rest().empty())
    fail_in(line.where(), "unexpected '{}' at the end", line.rest().substr(0, 40));
}

// The port at the end of the line, which only COLMAP-Underwater writes.
std::optional<refractive::Port<double>> parse_port(TextLine& line, const Context& context) {
  TextLine ahead = line;
  if (line.empty() || !is_port_word(ahead.word("port"))) return std::nullopt;
  const std::string word(line.word("port"));
  PortNumbers numbers;
  for (double& number : numbers) number = line.number<double>(word + " parameter");
  return port_from(word, numbers, line.where(), context);
}

ColmapCamera parse_camera(TextLine& line, const Context& context) {
  ColmapCamera camera;
  camera.id = line.number<std::uint32_t>("camera id");
  camera.model = line.word("camera model");
  camera.width = line.number<std::uint64_t>("width");
  camera.height = line.number<std::uint64_t>("height");
  const int parameters = colmap_parameter_count(camera.model);
  if (parameters < 0)
    fail_in(line.where(), "camera {} has the unknown model '{}'", camera.id, camera.model);
  for (int i = 0; i < parameters; ++i)
    camera.params.push_back(line.number<double>(camera.model + " parameter"));
  camera.port = parse_port(line, context);
  require_no_rest(line);
  check_colmap_camera(camera, line.where());
  return camera;
}

// The comment "# focal_sigma CAMERA_ID SIGMA".
constexpr std::string_view kFocalSigma = "focal_sigma";

// A stated standard deviation of focal lengths, and the line that states it.
struct StatedSigma {
  double sigma = 0;
  std::string where;
};
using StatedSigmas = std::map<std::uint32_t, StatedSigma>;  // by camera id

// Reads `comment`, the text after '#', if it states a standard deviation.
void parse_focal_sigma(TextLine comment, StatedSigmas& stated) {
  if (comment.empty() || comment.word("comment") != kFocalSigma) return;
  const std::string where = comment.where();
  const auto id = comment.number<std::uint32_t>("camera id of focal_sigma");
  const auto sigma = comment.number<double>("focal_sigma");
  require_no_rest(comment);
  constexpr double kLeast = 1e-12;  // far below any measurement; its inverse square is finite
  if (!(sigma >= kLeast && sigma <= 1))
    fail_in(where, "focal_sigma of camera {} is {}, expected a value above 0 and at most 1", id,
            sigma);
  if (!stated.insert({id, {sigma, where}}).second)
    fail_in(where, "focal_sigma of camera {} occurs twice", id);
}

void set_focal_sigmas(const StatedSigmas& stated, std::vector<ColmapCamera>& cameras) {
  for (const auto& [id, sigma] : stated) {
    const auto camera = std::ranges::find(cameras, id, &ColmapCamera::id);
    if (camera == cameras.end())
      fail_in(sigma.where, "focal_sigma names camera {}, which the file does not contain", id);
    camera->focal_sigma = sigma.sigma;
  }
}

ColmapImage parse_image(TextLine& line) {
  ColmapImage image;
  image.id = line.number<std::uint32_t>("image id");
  ColmapPose pose;
  constexpr std::array<const char*, 7> kNames{"qw", "qx", "qy", "qz", "tx", "ty", "tz"};
  for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = line.number<double>(kNames[i]);
  image.pose = pose_from_colmap(pose, line.where());
  image.camera = line.number<std::uint32_t>("camera id");
  image.name = line.rest();
  if (image.name.empty()) fail_in(line.where(), "the image name is missing");
  return image;
}

std::uint64_t parse_point_id(TextLine& line) {
  TextLine ahead = line;
  if (ahead.word("3D point id") == "-1") {
    line = ahead;
    return kNoPoint3D;
  }
  return line.number<std::uint64_t>("3D point id");
}

void parse_observations(TextLine& line, std::vector<ColmapPoint2D>& points) {
  while (!line.empty()) {
    ColmapPoint2D point;
    point.x = line.number<double>("x of a 2D point");
    point.y = line.number<double>("y of a 2D point");
    point.point3d = parse_point_id(line);
    points.push_back(point);
  }
}

ColmapPoint3D parse_point(TextLine& line) {
  ColmapPoint3D point;
  point.id = line.number<std::uint64_t>("3D point id");
  for (Eigen::Index i = 0; i < 3; ++i) point.position[i] = line.number<double>("position");
  for (std::uint8_t& channel : point.color) channel = line.number<std::uint8_t>("colour");
  point.error = line.number<double>("error");
  while (!line.empty()) {
    ColmapTrackElement element;
    element.image = line.number<std::uint32_t>("image id of the track");
    element.point2d = line.number<std::uint32_t>("2D point of the track");
    point.track.push_back(element);
  }
  return point;
}

std::string cameras_as_text(const std::vector<ColmapCamera>& cameras, Dialect dialect) {
  const bool underwater = dialect == Dialect::underwater;
  std::string out = "# Camera list with one line of data per camera:\n";
  out += fmt::format("#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]{}\n",
                     underwater ? ", OPTIONAL[REFRAC_MODEL REFRAC_PARAMS[]]" : "");
  out += fmt::format("# Number of cameras: {}\n", cameras.size());
  for (const ColmapCamera& camera : cameras)
    if (camera.focal_sigma)
      out += fmt::format("# {} {} {}\n", kFocalSigma, camera.id, *camera.focal_sigma);
  for (const ColmapCamera& camera : cameras) {
    out += fmt::format("{} {} {} {} {}", camera.id, camera.model, camera.width, camera.height,
                       fmt::join(camera.params, " "));
    if (underwater && camera.port)
      out += fmt::format(" {} {}", port_word(*camera.port),
                         fmt::join(port_numbers(*camera.port), " "));
    out += '\n';
  }
  return out;
}

void check_name(const ColmapImage& image, const std::string& file) {
  const std::string& name = image.name;
  if (name.empty() || trimmed(name) != name || name.find('\n') != std::string::npos)
    fail_in(file, "image {} has the name '{}', which text files cannot hold", image.id, name);
}

std::string images_as_text(const ColmapModel& model, const std::string& file) {
  std::string out =
      "# Image list with two lines of data per image:\n"
      "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
      "#   POINTS2D[] as (X, Y, POINT3D_ID)\n";
  out += fmt::format("# Number of images: {}\n", model.images.size());
  for (const ColmapImage& image : model.images) {
    check_name(image, file);
    out += fmt::format("{} {} {} {}\n", image.id, fmt::join(pose_to_colmap(image.pose), " "),
                       image.camera, image.name);
    const char* separator = "";
    for (const ColmapPoint2D& point : image.points) {
      out += fmt::format("{}{} {} ", separator, point.x, point.y);
      out += point.point3d == kNoPoint3D ? "-1" : std::to_string(point.point3d);
      separator = " ";
    }
    out += '\n';
  }
  return out;
}

std::string points_as_text(const ColmapModel& model) {
  std::string out =
      "# 3D point list with one line of data per point:\n"
      "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n";
  out += fmt::format("# Number of points: {}\n", model.points.size());
  for (const ColmapPoint3D& point : model.points) {
    out += fmt::format("{} {} {} {} {} {}", point.id, point.position.x(), point.position.y(),
                       point.position.z(), fmt::join(point.color, " "), point.error);
    for (const ColmapTrackElement& element : point.track)
      out += fmt::format(" {} {}", element.image, element.point2d);
    out += '\n';
  }
  return out;
}

}  // namespace

std::vector<ColmapCamera> read_cameras_text(const fs::path& path, const Context& context) {
  const std::string bytes = read_file(path);
  TextReader reader(bytes, path.string());
  std::vector<ColmapCamera> cameras;
  StatedSigmas stated;
  while (auto line = reader.line()) {
    if (line->empty()) continue;
    if (line->rest().front() == '#')
      parse_focal_sigma(line->after('#'), stated);
    else
      cameras.push_back(parse_camera(*line, context));
  }
  set_focal_sigmas(stated, cameras);
  return cameras;
}

std::vector<ColmapImage> read_images_text(const fs::path& path) {
  const std::string bytes = read_file(path);
  TextReader reader(bytes, path.string());
  std::vector<ColmapImage> images;
  while (auto line = reader.record()) {
    images.push_back(parse_image(*line));
    auto observations = reader.line();
    if (!observations)
      fail_in(path, "truncated: image {} has no line of 2D points", images.back().id);
    parse_observations(*observations, images.back().points);
  }
  return images;
}

std::vector<ColmapPoint3D> read_points_text(const fs::path& path) {
  const std::string bytes = read_file(path);
  TextReader reader(bytes, path.string());
  std::vector<ColmapPoint3D> points;
  while (auto line = reader.record()) points.push_back(parse_point(*line));
  return points;
}

namespace {

void write_text(const fs::path& folder, const ColmapModel& model, Dialect dialect) {
  write_atomically(folder / "cameras.txt", cameras_as_text(model.cameras, dialect));
  write_atomically(folder / "images.txt", images_as_text(model, (folder / "images.txt").string()));
  write_atomically(folder / "points3D.txt", points_as_text(model));
}

}  // namespace

void require_no_binary_model(const fs::path& folder) {
  if (holds_model(folder, ModelForm::binary))
    fail_in(folder, "holds a binary model, which would be read instead of the text model to write");
}

void write_colmap_text(const fs::path& folder, const ColmapModel& model) {
  require_no_binary_model(folder);
  write_text(folder, model, Dialect::colmap);
}

void write_colmap_cameras(const fs::path& file, const std::vector<ColmapCamera>& cameras) {
  write_atomically(file, cameras_as_text(cameras, Dialect::colmap));
}

void write_underwater_text(const fs::path& folder, const ColmapModel& model) {
  write_text(folder, model, Dialect::underwater);
}

}  // namespace axial::io
