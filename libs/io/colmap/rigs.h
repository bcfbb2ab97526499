// SPDX-License-Identifier: GPL-3.0-or-later
// Rigs: cameras that are mounted together and take photographs at the same time. The files are
// those of COLMAP 3.12 and later (docs/formats.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "axial/scene.h"

namespace axial::io {

// A camera of a rig. The frame of the rig is that of the reference camera, in metres.
struct RigCamera {
  std::string prefix;    // of the names of its images; of rig_config.json alone
  std::uint32_t id = 0;  // of the camera in the model; of rigs.txt and rigs.bin alone
  bool is_reference = false;
  // From the frame of the rig to that of the camera. Empty: not stated, or the reference camera.
  std::optional<Pose> pose;
  // Standard deviations of `pose` per axis. 0: not stated. Only rig_config.json states them.
  double sigma_translation = 0;  // [m]
  double sigma_rotation = 0;     // [degrees]
};

// Exactly one camera is the reference camera.
struct Rig {
  std::uint32_t id = 0;  // of rigs.txt and rigs.bin alone
  std::vector<RigCamera> cameras;
};

// The photographs that one rig takes at one time.
struct RigFrame {
  std::uint32_t id = 0;
  std::uint32_t rig = 0;  // id of its rig
  struct Image {
    std::uint32_t camera = 0, image = 0;  // ids in the model
  };
  std::vector<Image> images;
};

struct RigFile {
  std::vector<Rig> rigs;
  std::vector<RigFrame> frames;
  bool by_prefix = false;  // rig_config.json: images belong to cameras by their prefixes
};

// Reads rig_config.json (any name that ends with .json), or rigs.txt or rigs.bin and, from the same
// folder, the file frames with the same ending. Sensors that are no cameras are left out, and so
// are rigs without a camera.
//
// Error that names the file, the record and the value for malformed or truncated data, an unknown
// key, a rig without or with two reference cameras, a camera that occurs twice, a pose of which
// only the rotation or the translation is stated, a pose of the reference camera, a quaternion of
// (almost) zero length, a standard deviation that is not positive or above 1 m or 90 degrees, an id
// that occurs twice, and a frame whose rig or camera does not exist.
RigFile read_rigs(const std::filesystem::path& path);

}  // namespace axial::io
