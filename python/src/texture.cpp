// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes with textures, and their files.
#include "axial/texture.h"

#include <pybind11/stl/filesystem.h>

#include "base/error.h"
#include "io/textured/textured_mesh.h"
#include "src/bind.h"
#include "src/records.h"
#include "src/scene_files.h"
#include "src/stage.h"
#include "src/survey_call.h"
#include "survey/photographs.h"
#include "texture/faces/photograph_source.h"

namespace axial::python {
namespace {

namespace fs = std::filesystem;

// The work of the program TextureMesh, for a mesh in one piece.
struct Texturing {
  survey::Options survey;
  texture::Options options;

  Texturing() {
    survey.resolution = {0, 640, 1 << 20};
    survey.compares_photographs = true;
  }

  // Changes the frame of the mesh to that of the survey.
  TexturedMesh run(Mesh mesh, LocalFrame& frame, const Context& context) const {
    survey::Survey scene = survey::open_scene(survey, context);
    survey::find_photographs(scene, context);
    move_positions(frame, scene.frame, mesh.vertices);
    frame = scene.frame;
    const survey::Photographs photographs(scene);
    texture::Options settings = options;
    settings.image_bytes = photographs.bytes_to_read_color();
    TexturedMesh result =
        texture::texture_mesh(std::move(mesh), survey::posed_cameras(scene),
                              texture::source_of(photographs), settings, nullptr, context);
    photographs.report(context);
    return result;
  }
};

void add_keywords(Keywords& keywords, Texturing& texturing) {
  texture::Options& options = texturing.options;
  add_survey_keywords(keywords, texturing.survey);
  keywords.add("working_folder", texturing.survey.files.working_folder)
      .add("outlier_threshold", options.outlier_threshold, 0, 0.999)
      .add("cost_smoothness_ratio", options.labels.cost_smoothness_ratio, 0, 100)
      .add("global_leveling", options.leveling.global)
      .add("local_leveling", options.leveling.local)
      .add("sharpness_weight", options.sharpness_weight, 0, 10)
      .add_zero_or("max_size", options.packing.max_size, 16, 32768)
      .add("multiple", options.packing.multiple, 0, 32768)
      .add("empty_color", [&options](const py::handle& value) {
        const Array<std::uint8_t> rgb = array_argument<std::uint8_t>(
            py::reinterpret_borrow<py::object>(value), "empty_color", {3});
        std::copy_n(rgb.data(), 3, options.empty_color.begin());
      });
}

py::dict texture_mesh(const py::dict& fields, const py::object& scene,
                      const py::object& photographs, const py::object& masks,
                      const py::dict& keywords) {
  const SurveyCall call{scene, photographs, masks};
  Texturing texturing;
  StageControls controls;
  Keywords known;
  add_keywords(known, texturing);
  controls.add_to(known);
  known.take(keywords, "texture_mesh");
  take_survey(call, keywords, texturing.survey);
  Mesh mesh = to_mesh(fields);
  mesh.colors.clear();  // the textured mesh has none
  LocalFrame frame = frame_of(fields);
  TexturedMesh result;
  run_stage(controls, [&](const Context& context) {
    result = texturing.run(std::move(mesh), frame, context);
  });
  return fields_of(std::move(result), frame);
}

io::TexturedFormat format_of(const fs::path& path) {
  std::string name = path.extension().string();
  if (!name.empty()) name.erase(0, 1);
  const auto format = io::textured_format(name);
  if (!format) fail_in(path, "must have the extension ply, obj, glb or gltf");
  return *format;
}

py::dict read_textured_mesh(const fs::path& path) {
  LocalFrame frame;
  TexturedMesh mesh = logged([&](const Context& context) {
    frame = frame_of_file(path);
    return io::read_textured_mesh(path, frame, context);
  });
  return fields_of(std::move(mesh), frame);
}

void write_textured_mesh(const fs::path& path, const py::dict& fields) {
  const io::TexturedFormat format = format_of(path);
  const TexturedMesh mesh = to_textured_mesh(fields);
  const LocalFrame frame = frame_of(fields);
  const py::gil_scoped_release release;
  io::write_textured_mesh(path, mesh, format, frame);
}

}  // namespace

void bind_texture(py::module_& module) {
  module.def("texture_mesh", &texture_mesh);
  module.def("read_textured_mesh", &read_textured_mesh);
  module.def("write_textured_mesh", &write_textured_mesh);
}

}  // namespace axial::python
