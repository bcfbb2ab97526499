// SPDX-License-Identifier: GPL-3.0-or-later
#include "find_move.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/naming.h"
#include "evaluate/scene_alignment.h"
#include "io/cameras/geo_offset.h"
#include "io/cameras/image_positions.h"
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

void warn_of_outliers(const fs::path& file, const evaluate::SceneAlignment& alignment) {
  for (const std::string& line : alignment.outliers) log_warning("{}: {}", file.string(), line);
}

FrameMove align_to_scene(const Options& options, const io::SceneWithCameras& scene,
                         const Context& context) {
  Scene reference = io::read_mvs(options.align, options.survey.files.working_folder, context);
  const LocalFrame frame = io::enter_local_frame(reference, options.align, context);
  return naming(options.align, [&] {
    const evaluate::ImagePairs images = evaluate::pair_images(scene.scene, reference);
    const auto alignment = evaluate::align_scenes(scene.scene, reference, images, !options.rigid);
    warn_of_outliers(options.align, alignment);
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
  std::vector<std::string> paths;
  std::vector<std::size_t> calibrated;
  std::vector<Eigen::Vector3d> centres;
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (!scene.images[i].calibrated) continue;
    calibrated.push_back(i);
    paths.push_back(scene.images[i].path);
    centres.push_back(scene.images[i].pose.centre);
  }
  const auto read = io::positions_of_images(options.positions, paths, centres, "the scene");
  for (const std::string& line : read.notes) log_info("{}", line);
  for (const std::string& line : read.absent) log_warning("{}", line);
  Known known;
  for (const io::ImagePosition& one : read.found) {
    known.images.push_back(calibrated[one.image]);
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
    warn_of_outliers(options.positions, alignment);
    tell(alignment, "known positions");
    if (const auto line = evaluate::may_be_mirrored(scene.scene, known.images, known.positions,
                                                    !options.rigid, alignment))
      log_warning("{}: {}", options.positions.string(), *line);
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

FrameMove find_move(const Options& options, const io::SceneWithCameras& scene,
                    const Context& context) {
  if (!options.moves()) return {{}, scene.frame, scene.frame};
  FrameMove move;
  if (!options.align.empty())
    move = align_to_scene(options, scene, context);
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
    fail_in(options.survey.files.scene,
            "the transformation has the scale {:.9g}, but the lengths of port '{}' are known in "
            "metres: use --rigid to align without a scale, or --scale-ports to scale the port, too",
            similarity.scale, image.port_name);
  }
}

}  // namespace axial::apps
