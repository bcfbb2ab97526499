// SPDX-License-Identifier: GPL-3.0-or-later
// The files rigs and frames of COLMAP models.
#include <algorithm>
#include <limits>
#include <set>

#include "base/atomic_file.h"
#include "bytes/private/byte_reader.h"
#include "bytes/private/text_reader.h"
#include "colmap/private/colmap_parts.h"
#include "colmap/private/rig_parts.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// Sensors are a word in text files and a number in binary files.
constexpr std::string_view kCameraWord = "CAMERA";
constexpr std::int32_t kCameraNumber = 0;
// Smallest records of binary files, in bytes: a rig without a sensor, a frame without an image, a
// sensor without a pose, an image of a frame.
constexpr std::size_t kMinRig = 4 + 4, kMinFrame = 4 + 4 + 7 * 8 + 4, kMinSensor = 4 + 4 + 1,
                      kFrameImage = 4 + 4 + 8;

// Reads the fields of one line of a text file.
class TextFields {
 public:
  explicit TextFields(TextLine line) : line_(line) {}

  std::string where() const { return line_.where(); }
  std::uint32_t id(const char* field) { return line_.number<std::uint32_t>(field); }
  std::uint64_t long_id(const char* field) { return line_.number<std::uint64_t>(field); }
  std::uint32_t count(const char* field, std::size_t) { return id(field); }
  bool is_camera() { return line_.word("sensor type") == kCameraWord; }
  bool flag(const char* field) {
    const auto value = id(field);
    if (value > 1) fail_in(where(), "{} is {}, expected 0 or 1", field, value);
    return value == 1;
  }
  ColmapPose pose() {
    ColmapPose pose;
    for (double& number : pose) number = line_.number<double>("number of the pose");
    return pose;
  }
  void end() const {
    if (!line_.empty()) fail_in(where(), "'{}' follows the last value", line_.rest());
  }

 private:
  TextLine line_;
};

// Reads the fields of one record of a binary file.
class BinaryFields {
 public:
  explicit BinaryFields(ByteReader& in) : in_(in), start_(in.position()) {}

  std::string where() const { return fmt::format("{}: record at byte {}", in_.file(), start_); }
  std::uint32_t id(const char* field) { return in_.read<std::uint32_t>(field); }
  std::uint64_t long_id(const char* field) { return in_.read<std::uint64_t>(field); }
  std::uint32_t count(const char* field, std::size_t min_bytes) {
    const auto number = id(field);
    in_.require_room(number > 0 ? number - 1 : 0, min_bytes, field);
    return number;
  }
  bool is_camera() { return in_.read<std::int32_t>("sensor type") == kCameraNumber; }
  bool flag(const char* field) {
    const auto value = in_.read<std::uint8_t>(field);
    if (value > 1) fail_in(where(), "{} is {}, expected 0 or 1", field, value);
    return value == 1;
  }
  ColmapPose pose() {
    ColmapPose pose;
    in_.read(std::span(pose), "pose");
    return pose;
  }
  void end() const {}

 private:
  ByteReader& in_;
  std::size_t start_;
};

template <class Fields>
Rig parse_rig(Fields in) {
  Rig rig;
  rig.id = in.id("rig id");
  const auto sensors = in.count("number of sensors", kMinSensor);
  for (std::uint32_t i = 0; i < sensors; ++i) {
    const bool is_camera = in.is_camera();
    RigCamera camera;
    camera.id = in.id("sensor id");
    camera.is_reference = i == 0;
    if (i > 0 && in.flag("HAS_POSE")) camera.pose = pose_from_colmap(in.pose(), in.where());
    if (!is_camera && camera.is_reference)
      fail_in(in.where(), "the reference sensor of rig {} is no camera", rig.id);
    if (!is_camera) continue;
    if (std::ranges::find(rig.cameras, camera.id, &RigCamera::id) != rig.cameras.end())
      fail_in(in.where(), "camera {} occurs twice in rig {}", camera.id, rig.id);
    rig.cameras.push_back(camera);
  }
  in.end();
  return rig;
}

template <class Fields>
RigFrame parse_frame(Fields in) {
  RigFrame frame;
  frame.id = in.id("frame id");
  frame.rig = in.id("rig id");
  pose_from_colmap(in.pose(), in.where());  // checks the pose, which the images have as well
  const auto images = in.count("number of images", kFrameImage);
  for (std::uint32_t i = 0; i < images; ++i) {
    const bool is_camera = in.is_camera();
    RigFrame::Image image;
    image.camera = in.id("sensor id");
    const std::uint64_t id = in.long_id("image id");
    if (!is_camera) continue;
    if (id > std::numeric_limits<std::uint32_t>::max())
      fail_in(in.where(), "image id is {}, which is too large", id);
    image.image = static_cast<std::uint32_t>(id);
    frame.images.push_back(image);
  }
  in.end();
  return frame;
}

template <class Record>
std::vector<Record> records_of_text(const fs::path& path, Record (*parse)(TextFields)) {
  const std::string bytes = read_file(path);
  TextReader reader(bytes, path.string());
  std::vector<Record> records;
  while (const auto line = reader.record()) records.push_back(parse(TextFields(*line)));
  return records;
}

template <class Record>
std::vector<Record> records_of_binary(const fs::path& path, std::size_t min_bytes,
                                      Record (*parse)(BinaryFields)) {
  const std::string bytes = read_file(path);
  ByteReader in(bytes, path.string());
  const std::size_t count = in.count(min_bytes, "records");
  std::vector<Record> records;
  for (std::size_t i = 0; i < count; ++i) records.push_back(parse(BinaryFields(in)));
  if (in.left() > 0) fail_in(path, "{} bytes follow the last record", in.left());
  return records;
}

template <class Record>
void require_unique_ids(const std::vector<Record>& records, const fs::path& path,
                        const char* kind) {
  std::set<std::uint32_t> ids;
  for (const Record& record : records)
    if (!ids.insert(record.id).second) fail_in(path, "{} {} occurs twice", kind, record.id);
}

void check_frames(const RigFile& file, const fs::path& path) {
  for (const RigFrame& frame : file.frames) {
    const auto rig = std::ranges::find(file.rigs, frame.rig, &Rig::id);
    if (rig == file.rigs.end())
      fail_in(path, "frame {} is of rig {}, which does not exist", frame.id, frame.rig);
    std::set<std::uint32_t> cameras;
    for (const RigFrame::Image& image : frame.images) {
      if (std::ranges::find(rig->cameras, image.camera, &RigCamera::id) == rig->cameras.end())
        fail_in(path, "frame {} has an image of camera {}, which is not in rig {}", frame.id,
                image.camera, frame.rig);
      if (!cameras.insert(image.camera).second)
        fail_in(path, "frame {} has two images of camera {}", frame.id, image.camera);
    }
  }
}

}  // namespace

std::vector<Rig> read_rigs_text(const fs::path& path) {
  return records_of_text<Rig>(path, parse_rig);
}

std::vector<Rig> read_rigs_binary(const fs::path& path) {
  return records_of_binary<Rig>(path, kMinRig, parse_rig);
}

std::vector<RigFrame> read_frames_text(const fs::path& path) {
  return records_of_text<RigFrame>(path, parse_frame);
}

std::vector<RigFrame> read_frames_binary(const fs::path& path) {
  return records_of_binary<RigFrame>(path, kMinFrame, parse_frame);
}

RigFile read_rigs(const fs::path& path) {
  if (path.extension() == ".json") return {read_rig_config(path), {}, true};
  const bool binary = path.extension() == ".bin";
  if (!binary && path.extension() != ".txt")
    fail_in(path, "the name of a file of rigs ends with .json, .txt or .bin");
  const fs::path frames = path.parent_path() / ("frames" + path.extension().string());
  RigFile file;
  file.rigs = binary ? read_rigs_binary(path) : read_rigs_text(path);
  file.frames = binary ? read_frames_binary(frames) : read_frames_text(frames);
  require_unique_ids(file.rigs, path, "rig");
  require_unique_ids(file.frames, frames, "frame");
  check_frames(file, frames);
  std::erase_if(file.rigs, [](const Rig& rig) { return rig.cameras.empty(); });
  return file;
}

}  // namespace axial::io
