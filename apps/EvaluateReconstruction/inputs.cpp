// SPDX-License-Identifier: GPL-3.0-or-later
#include "inputs.h"

#include <utility>

#include "base/file_extension.h"
#include "base/log.h"
#include "base/program/unused_input.h"
#include "cloud_parts.h"
#include "io/cameras/geo_offset.h"
#include "io/colmap/colmap_frame.h"
#include "io/colmap/colmap_scene.h"
#include "io/colmap/other_ports.h"
#include "io/ply/ply.h"
#include "io/textured/textured_mesh.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// A frame near the file's vertices. Warns of float coordinates far from their origin: they had lost
// digits when the file was written.
LocalFrame checked_frame(const fs::path& path) {
  constexpr double kFar = 1e4;  // [m]: here, float has a resolution of 1 mm
  const io::MeshPlace place = io::mesh_place(path);
  const double far = place.frame.to_local(place.first_vertex).cwiseAbs().maxCoeff();
  if (place.is_float && far > kFar)
    log_warning(
        "{}: its coordinates are float32 values of about {:.0f} m: their resolution is only {:.2g} "
        "m (write double, or local coordinates with a comment geo_offset)",
        path.string(), far, far * 0x1p-24);
  return frame_near(place.first_vertex);
}

// OBJ and glTF files hold no clouds.
bool is_mesh(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".obj" || extension == ".glb" || extension == ".gltf" ||
         io::ply_has_faces(path);
}

}  // namespace

Models read_models(const Options& options, const Context& context) {
  Models models;
  checked_frame(options.input);
  if (!options.truth.empty()) models.frames.truth = checked_frame(options.truth);
  if (!options.cameras.empty()) {
    models.reference = io::read_colmap_model(options.cameras_model, context);
    models.frames.truth = io::enter_local_frame(models.reference);
  }
  models.frames.input = models.frames.truth;
  if (options.align == "centres") {
    models.estimated = io::read_colmap_model(options.estimated_model, context);
    models.frames.input = io::enter_local_frame(models.estimated);
  }
  return models;
}

Input read_input(const Options& options, const LocalFrame& frame, const Context& context) {
  const fs::path& path = options.input;
  Input input;
  if (!options.rendered_views.empty() && io::is_textured_mesh(path)) {
    input.texture = io::read_textured_mesh(path, frame, context);
    input.mesh = std::exchange(input.texture->mesh, {});
  } else if (is_mesh(path)) {
    input.mesh = io::read_shape(path, frame);
  } else {
    input.cloud = io::read_cloud_ply(path, frame);
    input.uncertainty = read_uncertainty(path, input.cloud);
  }
  if (input.positions().empty()) fail_in(path, "the cloud has no points");
  return input;
}

std::vector<evaluate::View> read_views(const Options& options, const Models& models,
                                       const Context& context) {
  if (options.cameras.empty()) return {};
  std::optional<io::Housing> housing;
  if (!options.housing.empty()) {
    housing = io::in_frame(models.frames.truth,
                           io::read_housing(options.housing, models.reference, context));
    for (const std::string& entry : io::unused_entries(*housing, models.reference))
      log_warning("{}: no image matches {}", options.housing.string(), entry);
    io::warn_of_other_ports(*housing, options.housing.string(),
                            io::housing_of(models.reference.cameras),
                            "the model in " + options.cameras.string(), models.reference, context);
    if (io::gives_no_image_a_port(*housing, models.reference))
      UnusedInput(options.allow_missing)
          .report(fmt::format("--housing {}: gives no image a port", options.housing.string()),
                  context);
  }
  return naming(options.cameras_model, [&] {
    return evaluate::views_of_model(models.reference, housing ? &*housing : nullptr);
  });
}

}  // namespace axial::apps
