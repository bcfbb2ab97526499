// SPDX-License-Identifier: GPL-3.0-or-later
#include "find_move.h"

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/naming.h"
#include "evaluate/scene_alignment.h"
#include "io/cameras/geo_offset.h"
#include "io/cameras/position_file.h"
#include "io/cameras/transform_file.h"
#include "io/openmvs/mvs.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

void tell(const evaluate::SceneAlignment& alignment, const std::string& how) {
  log_info(
      "Aligned by {} {}: scale {:.9g}, residuals of the centres RMS {:.3f} mm, largest {:.3f} mm",
      alignment.images, how, alignment.similarity.scale, alignment.rms * 1e3,
      alignment.largest * 1e3);
  if (alignment.turn)
    log_info("Residuals of the rotations: largest {:.4f} degrees",
             *alignment.turn * 180 / std::numbers::pi);
}

FrameMove align_to_scene(const Options& options, const io::SceneWithCameras& scene) {
  Scene reference = io::read_mvs(options.align, options.files.working_folder);
  const LocalFrame frame = io::enter_local_frame(reference, options.align);
  return naming(options.align, [&] {
    const evaluate::ImagePairs images = evaluate::pair_images(scene.scene, reference);
    const auto alignment = evaluate::align_scenes(scene.scene, reference, images, !options.rigid);
    tell(alignment, images.by_name ? "images with the same names"
                                   : "images in their order, because names do not match");
    return FrameMove{alignment.similarity, scene.frame, frame};
  });
}

struct Known {
  std::vector<std::size_t> images;
  std::vector<Eigen::Vector3d> positions;  // [world]
};

// A survey's list may name photographs that are not in the scene: skips them with a warning.
Known read_known(const Options& options, const Scene& scene) {
  Known known;
  std::set<std::size_t> seen;
  const evaluate::ImageNames names(scene);
  const auto is_image = [&](const std::string& name) { return !names.named(name).empty(); };
  for (const io::NamedPosition& one : io::read_positions(options.positions, is_image)) {
    const std::span<const std::size_t> images = names.named(one.name);
    if (images.empty()) {
      log_warning("{}:{}: the scene has no image '{}'", options.positions.string(), one.line,
                  one.name);
      continue;
    }
    if (images.size() > 1)
      fail("{}:{}: '{}' is the end of {} and of {}", options.positions.string(), one.line, one.name,
           scene.images[images[0]].path, scene.images[images[1]].path);
    if (!seen.insert(images[0]).second)
      fail("{}:{}: {} occurs twice", options.positions.string(), one.line, one.name);
    known.images.push_back(images[0]);
    known.positions.push_back(one.position);
  }
  return known;
}

FrameMove align_to_known(const Options& options, const io::SceneWithCameras& scene) {
  Known known = read_known(options, scene.scene);
  const LocalFrame frame = frame_of(known.positions, {});
  for (Eigen::Vector3d& position : known.positions) position = frame.to_local(position);
  return naming(options.positions, [&] {
    const auto alignment =
        evaluate::align_to_positions(scene.scene, known.images, known.positions, !options.rigid);
    tell(alignment, "known positions");
    return FrameMove{alignment.similarity, scene.frame, frame};
  });
}

// The frame near the moved scene.
LocalFrame frame_after(const FrameMove& move, const Scene& scene) {
  const auto to_world = [&](const Eigen::Vector3d& local) {
    return move.to.to_world(move.similarity(local));
  };
  std::vector<Eigen::Vector3d> centres, points;
  for (const SceneImage& image : scene.images)
    if (image.calibrated) centres.push_back(to_world(image.pose.centre));
  for (const SparsePoint& point : scene.points)
    points.push_back(to_world(point.position.cast<double>()));
  return frame_of(centres, points);
}

}  // namespace

FrameMove find_move(const Options& options, const io::SceneWithCameras& scene) {
  if (!options.moves()) return {{}, scene.frame, scene.frame};
  FrameMove move;
  if (!options.align.empty())
    move = align_to_scene(options, scene);
  else if (!options.positions.empty())
    move = align_to_known(options, scene);
  else
    move = move_in(scene.frame, io::read_transform(options.transform));
  return move.ending_in(frame_after(move, scene.scene));
}

void check_scale(const Options& options, const io::SceneWithCameras& scene,
                 const Similarity& similarity) {
  constexpr double kSame = 1e-6;
  if (!scene.housing || options.scale_ports || std::abs(similarity.scale - 1) <= kSame) return;
  for (const SceneImage& image : scene.scene.images) {
    if (!image.camera.port || image.port_name.empty()) continue;
    const auto port = scene.housing->ports.find(image.port_name);
    if (port == scene.housing->ports.end() || std::holds_alternative<WaterSurface>(port->second))
      continue;
    fail(
        "{}: the transformation has the scale {:.9g}, but the lengths of port '{}' are known in "
        "metres: use --rigid to align without a scale, or --scale-ports to scale the port, too",
        options.files.scene.string(), similarity.scale, image.port_name);
  }
}

}  // namespace axial::apps
