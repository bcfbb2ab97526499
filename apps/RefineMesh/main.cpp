// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/program.h"
#include "base/parallel.h"
#include "densify/image_store.h"
#include "densify/project.h"
#include "io/ply/ply.h"
#include "refine/refine.h"

int main(int, char** argv) {
  using namespace axial;
  return run_program("RefineMesh", [&] {
    const ThreadLimit threads(2);
    densify::Settings settings;
    settings.input = std::filesystem::absolute(argv[1]);
    settings.working_folder = settings.input.parent_path();
    settings.output = "/tmp/c2/out.mvs";
    settings.resolution.level = 0;
    settings.estimate_colors = 0;
    settings.number_views = 8;
    settings.selection.min_area = 0.1;
    settings.selection.min_angle = 2.5 * 3.14159265 / 180;
    settings.selection.max_angle = 45 * 3.14159265 / 180;
    settings.selection.max_views = 8;
    densify::Project project = densify::load_project(settings);
    densify::ImageStore store(project, settings, 64);
    Mesh mesh = io::read_mesh_ply(argv[2], project.frame);
    std::vector<refine::View> views;
    std::vector<std::vector<std::uint32_t>> sources;
    for (std::size_t i = 0; i < project.views.size(); ++i) {
      views.push_back({project.views[i].camera, project.views[i].pose});
      sources.emplace_back();
      for (const auto& s : project.sources[i]) sources.back().push_back(s.image);
    }
    refine::refine(mesh, views, sources, [&](std::size_t i) {
      const auto image = store.get(i);
      return refine::Picture{image->grey, image->mask};
    });
    io::write_mesh_ply(argv[3], mesh, {project.frame, false});
    return 0;
  });
}
