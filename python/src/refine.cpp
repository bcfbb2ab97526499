// SPDX-License-Identifier: GPL-3.0-or-later
#include "axial/refine.h"

#include "mesh/clean.h"
#include "src/bind.h"
#include "src/mesh_options.h"
#include "src/records.h"
#include "src/stage.h"
#include "src/survey_call.h"
#include "survey/image_store.h"
#include "survey/survey.h"

namespace axial::python {
namespace {

using refine::References;

// The work of the program RefineMesh, without its treatment of surface that no two cameras see.
struct Refinement {
  survey::Options survey;
  refine::Options options;
  mesh::CleanOptions cleaning;

  Refinement() {
    survey.resolution = {0, 640, 1 << 16};
    survey.compares_photographs = true;
    cleaning.spurious = 0;
    cleaning.spikes = false;
  }

  // Changes the mesh, which is in `frame`, and the frame.
  void run(Mesh& mesh, LocalFrame& frame, const Context& context) const {
    survey::Survey scene = survey::open_scene(survey, context);
    survey::find_photographs(scene, context);
    move_positions(frame, scene.frame, mesh.vertices);
    frame = scene.frame;
    const survey::ImageShares shares = survey::share_out(context.memory(), scene);
    survey::ImageStore images(scene, survey::Channels::grey, shares.images);
    images.check_all(1, context);
    refine::Options settings = options;
    settings.bytes_afterwards = mesh::bytes_to_clean(1);
    const auto picture = [&](std::size_t view) {
      const auto image = images.get(view);
      return refine::Picture{image->grey, image->mask};
    };
    refine::refine(mesh, survey::posed_cameras(scene), picture, settings,
                   Context(context, shares.for_work));
    scene.photograph_check->report(context);
    mesh = mesh::clean(mesh, cleaning);
  }
};

void add_keywords(Keywords& keywords, Refinement& refinement) {
  refine::Options& options = refinement.options;
  add_survey_keywords(keywords, refinement.survey);
  add_cleaning_keywords(keywords, refinement.cleaning);
  keywords.add("working_folder", refinement.survey.files.working_folder)
      .add("scales", options.scales, 1, 16)
      .add("scale_step", options.scale_step, 0.1, 1)
      .add("max_views", options.max_views, 1, 1000)
      .add("references", options.references,
           {{"both", References::both},
            {"alternating", References::alternating},
            {"first", References::first},
            {"second", References::second}})
      .add("smoothness", options.smoothness, 0, 1e9)
      .add("anchor", options.anchor, 0, 1e9)
      .add("max_face_area", options.max_face_area, 0, 1e9);
}

py::dict refine_mesh(const py::dict& fields, const py::object& scene, const py::object& photographs,
                     const py::object& masks, const py::dict& keywords) {
  const SurveyCall call{scene, photographs, masks};
  Refinement refinement;
  StageControls controls;
  Keywords known;
  add_keywords(known, refinement);
  controls.add_to(known);
  known.take(keywords, "refine_mesh");
  take_survey(call, keywords, refinement.survey);
  Mesh mesh = to_mesh(fields);
  mesh.unseen.clear();  // faces are split
  LocalFrame frame = frame_of(fields);
  run_stage(controls, [&](const Context& context) { refinement.run(mesh, frame, context); });
  return fields_of(std::move(mesh), frame);
}

}  // namespace

void bind_refine(py::module_& module) {
  module.def("refine_mesh", &refine_mesh);
}

}  // namespace axial::python
