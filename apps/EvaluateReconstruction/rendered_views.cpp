// SPDX-License-Identifier: GPL-3.0-or-later
#include "rendered_views.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <set>

#include "base/atomic_file.h"
#include "base/same_file.h"
#include "evaluate/pictures.h"
#include "evaluate/render_mesh.h"
#include "evaluate/report.h"
#include "io/images/image.h"
#include "io/textured/textured_mesh.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;
using evaluate::View;

std::vector<View> chosen_views(const Options& options, std::span<const View> views) {
  if (options.rendered_views == std::vector<std::string>{"all"})
    return {views.begin(), views.end()};
  std::vector<View> chosen;
  for (const std::string& name : options.rendered_views) {
    const auto view = std::ranges::find(views, name, &View::name);
    if (view == views.end())
      fail("{} {}: no such image in {}", setting("render"), name, options.cameras.string());
    chosen.push_back(*view);
  }
  return chosen;
}

CameraModel with_width(const CameraModel& camera, int width) {
  const double height = static_cast<double>(camera.height) * width / camera.width;
  return camera.resized(width, std::max(1, static_cast<int>(std::lround(height))));
}

bool has_colors(const Input& input) {
  return input.texture || !input.mesh->colors.empty();
}

// The path of a picture in the folder: the name of the image with another ending.
fs::path picture_path(const Options& options, const std::string& name, const char* ending) {
  const fs::path image(name);
  if (image.is_absolute() || std::ranges::find(image, fs::path("..")) != image.end())
    fail_in(options.cameras, "the image name {} leaves the folder of --render-folder", name);
  fs::path path = (options.render_folder / image).replace_extension();
  return path += ending + ("." + options.render_type);
}

// Reads the whole photograph, so that a damaged one is found before the first picture is written.
void check_photograph(const fs::path& photograph, const View& view) {
  const cv::Size size = io::read_color_image(photograph).size();
  if (size != cv::Size(view.camera.width, view.camera.height))
    fail_in(photograph, "is {} x {}, but its camera is {} x {}", size.width, size.height,
            view.camera.width, view.camera.height);
}

void check_pictures(const Options& options, std::span<const RenderTask> tasks) {
  if (options.render_folder.empty()) return;
  std::vector<fs::path> inputs = io::files_of_mesh(options.input);
  inputs.push_back(options.truth);
  for (const RenderTask& task : tasks) inputs.push_back(task.photograph);
  std::set<fs::path> pictures;
  for (const RenderTask& task : tasks)
    for (const fs::path& picture : {task.picture, task.errors}) {
      if (picture.empty()) continue;
      require_not_an_input(picture, inputs, setting("render_folder"));
      if (!pictures.insert(picture).second)
        fail_in(picture, "the pictures of two views would have this name");
    }
  require_writable_folder(options.render_folder);
}

void write_picture(const fs::path& path, const cv::Mat3b& picture) {
  constexpr int kJpegQuality = 80;
  make_folder(path.parent_path());
  if (path.extension() == ".jpg")
    io::write_jpeg(path, picture, kJpegQuality);
  else
    io::write_png(path, picture);
}

double share(const cv::Mat1b& mask) {
  return static_cast<double>(cv::countNonZero(mask)) / static_cast<double>(mask.total());
}

// What all views have in common.
struct Renderer {
  const Options& options;
  const Input& input;
  const geometry::Surface& mesh;
  const geometry::Surface* truth;
  std::span<const Rgb> error_colors;

  evaluate::RenderedView rendered(const evaluate::Coloring& coloring, const View& view) const {
    evaluate::RenderOptions settings;
    settings.samples = options.render_samples;
    return evaluate::render_mesh(mesh, coloring, view, settings);
  }

  void compare(const RenderTask& task, const evaluate::RenderedView& picture,
               evaluate::ViewReport& report) const {
    cv::Mat1b mask = picture.known;
    if (truth) {
      const cv::Mat1b covered = evaluate::covered_pixels(*truth, task.view, {1});
      report.truth_covered = share(covered);
      mask = mask & covered;
    }
    report.photograph = task.photograph.string();
    report.compared = share(mask);
    report.difference =
        evaluate::compare_pictures(picture.image, io::read_color_image(task.photograph), mask);
  }

  void draw_colors(const RenderTask& task, evaluate::ViewReport& report) const {
    const auto picture =
        rendered(input.texture ? evaluate::texture_coloring(*input.texture)
                               : evaluate::vertex_coloring(input.mesh->faces, input.mesh->colors),
                 task.view);
    report.covered = share(picture.covered);
    if (!task.photograph.empty()) compare(task, picture, report);
    if (task.picture.empty()) return;
    write_picture(task.picture, picture.image);
    report.pictures.push_back(task.picture.string());
  }

  void draw_errors(const RenderTask& task, evaluate::ViewReport& report) const {
    const auto picture =
        rendered(evaluate::vertex_coloring(input.mesh->faces, error_colors), task.view);
    report.covered = share(picture.covered);
    write_picture(task.errors, evaluate::with_error_scale(picture.image, options.color_max));
    report.pictures.push_back(task.errors.string());
  }

  evaluate::ViewReport view_report(const RenderTask& task) const {
    evaluate::ViewReport report;
    report.view = task.view.name;
    if (has_colors(input)) draw_colors(task, report);
    if (!task.errors.empty()) draw_errors(task, report);
    return report;
  }
};

}  // namespace

std::vector<RenderTask> plan_rendering(const Options& options, const Input& input,
                                       std::span<const View> views, bool has_truth) {
  std::vector<RenderTask> tasks;
  if (options.rendered_views.empty()) return tasks;
  if (!has_colors(input) && !options.photographs.empty())
    fail_in(options.input, "the mesh has neither a texture nor colours, which --photographs needs");
  if (!has_colors(input) && !has_truth)
    fail_in(
        options.input,
        "the mesh has neither a texture nor colours; with --truth-file it is coloured by error");
  for (const View& view : chosen_views(options, views)) {
    RenderTask& task = tasks.emplace_back();
    task.view = view;
    if (options.render_width > 0) task.view.camera = with_width(view.camera, options.render_width);
    if (!options.render_folder.empty() && has_colors(input))
      task.picture = picture_path(options, view.name, "");
    if (!options.render_folder.empty() && has_truth)
      task.errors = picture_path(options, view.name, ".errors");
    if (options.photographs.empty()) continue;
    task.photograph = options.photographs / view.name;
    check_photograph(task.photograph, view);
  }
  check_pictures(options, tasks);
  return tasks;
}

nlohmann::ordered_json render(const Options& options, const Input& input,
                              std::span<const RenderTask> tasks, const geometry::Surface* truth,
                              std::span<const Rgb> error_colors) {
  const geometry::Surface mesh =
      naming(options.input, [&] { return geometry::Surface(*input.mesh); });
  const Renderer renderer{options, input, mesh, truth, error_colors};
  std::vector<evaluate::ViewReport> views;
  for (const RenderTask& task : tasks) views.push_back(renderer.view_report(task));
  fmt::print("{}", evaluate::table(std::span<const evaluate::ViewReport>(views)));
  return evaluate::to_json(std::span<const evaluate::ViewReport>(views));
}

}  // namespace axial::apps
