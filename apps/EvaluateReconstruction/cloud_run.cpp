// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/log.h"
#include "cloud_parts.h"
#include "evaluate/alignment.h"
#include "evaluate/cloud_evaluation.h"
#include "evaluate/mesh_evaluation.h"
#include "evaluate/pictures.h"
#include "evaluate/report.h"
#include "evaluate/strip.h"
#include "geometry/icp.h"
#include "geometry/sampling.h"
#include "inputs.h"
#include "io/images/image.h"
#include "io/ply/ply.h"
#include "io/textured/textured_mesh.h"
#include "rendered_views.h"
#include "runs.h"

namespace axial::apps {
namespace {

using evaluate::Similarity;

Similarity align_by_centres(const Options& options, const Models& models,
                            nlohmann::ordered_json& report) {
  const auto result = naming(options.estimated, [&] {
    return evaluate::align_centres(models.estimated, models.reference);
  });
  for (const std::string& line : evaluate::not_matched(result, models.reference))
    log_warning("{}: {}", options.cameras.string(), line);
  for (const std::string& line : result.outliers)
    log_warning("{}: {}", options.cameras.string(), line);
  log_info("Aligned by {} camera centres: scale {:.9g}, RMS residual {:.3f} mm",
           result.names.size(), result.similarity.scale, result.rms * 1e3);
  report["centres"] = result.names.size();
  report["rms_residual"] = result.rms;
  return result.similarity;
}

Similarity align_by_icp(const Options& options, const Input& input,
                        const geometry::Surface& surface, nlohmann::ordered_json& report) {
  geometry::IcpOptions settings;
  settings.seed = options.seed;
  const auto result = naming(options.input, [&] {
    if (!input.mesh) return geometry::refine_rigid(input.positions(), surface, settings);
    return geometry::refine_rigid(
        geometry::sample_surface(*input.mesh, settings.samples, settings.seed), surface, settings);
  });
  log_info("Aligned by ICP in {} steps{}: median distance {:.3f} mm before, {:.3f} mm after",
           result.iterations, result.converged ? "" : " (not converged)",
           result.median_before * 1e3, result.median_after * 1e3);
  report["iterations"] = result.iterations;
  report["converged"] = result.converged;
  return result.transform;
}

// Distant clouds cannot be compared, and the search would be slow: no part of a search tree is
// nearer than the others. One distant vertex of a mesh is enough, because the samples of a mesh are
// spread by area.
void refuse_if_far(const Options& options, const Input& input, const Mesh& truth) {
  constexpr float kFar = 1e5;
  const auto is_far = [&](const Eigen::Vector3f& x) {
    return !((x - truth.vertices.front()).norm() <= kFar);
  };
  const std::span<const Eigen::Vector3f> all = input.positions();
  if (2 * std::ranges::count_if(all, is_far) > std::ssize(all))
    fail_in(options.input,
            "most of its points are more than {:.0f} km away from {}: the two files do not have "
            "the same coordinates",
            kFar / 1000, options.truth.string());
  const auto far = std::ranges::find_if(all, is_far);
  if (input.mesh && far != all.end())
    fail_in(options.input, "vertex {} is more than {:.0f} km away from {}", far - all.begin(),
            kFar / 1000, options.truth.string());
}

struct Alignment {
  Similarity similarity;  // from the input's world to the truth's world
  nlohmann::ordered_json report;
};

// Moves the input from its own frame to the truth's frame.
Alignment align(const Options& options, Input& input, const geometry::Surface& surface,
                const Models& models) {
  const Frames& frames = models.frames;
  nlohmann::ordered_json report{{"method", options.align}};
  Similarity similarity;
  if (options.align == "centres") similarity = align_by_centres(options, models, report);
  if (options.align == "icp") similarity = align_by_icp(options, input, surface, report);
  if (options.align != "none") input.move(similarity);
  similarity = evaluate::between_worlds(similarity, frames.input, frames.truth);
  report["transform"] = evaluate::to_json(similarity);
  return {similarity, std::move(report)};
}

// Called after the measurement, which may refuse the input. `input` still has all its points.
void write_alignment(const Options& options, const Input& input, const Similarity& similarity,
                     const LocalFrame& frame) {
  if (!options.transform.empty())
    write_atomically(options.transform, evaluate::matrix_text(similarity));
  const io::PlyPlacement placement{frame, false};
  if (!options.aligned.empty() && input.mesh)
    io::write_mesh_ply(options.aligned, *input.mesh, placement);
  if (!options.aligned.empty() && !input.mesh)
    io::write_cloud_ply(options.aligned, input.cloud, true, placement);
}

// Keeps the elements whose `keep` is true. The array may be empty.
template <class T>
void keep_only(std::vector<T>& all, const std::vector<bool>& keep) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (keep[i]) all[kept++] = all[i];
  all.resize(kept);
}

// The points (and normals) that are evaluated. Removes the properties of the other points from
// `input`.
PointCloud counted_points(const Options& options, Input& input,
                          std::span<const evaluate::View> views) {
  PointCloud counted;
  counted.positions = input.cloud.positions;
  counted.normals = input.cloud.normals;
  if (!options.framed_only) return counted;
  std::vector<bool> keep;
  for (const std::uint32_t frames : evaluate::count_frames(counted.positions, views))
    keep.push_back(frames >= options.least_views);
  keep_only(counted.positions, keep);
  keep_only(counted.normals, keep);
  keep_only(input.uncertainty.views, keep);
  keep_only(input.uncertainty.error, keep);
  keep_only(input.uncertainty.confidence, keep);
  if (counted.positions.empty()) fail_in(options.input, "no point lies in enough of the images");
  return counted;
}

// The view of the picture. Null if there are no views.
const evaluate::View* view_of_picture(const Options& options,
                                      std::span<const evaluate::View> views) {
  if (views.empty()) return nullptr;
  const auto view = std::find_if(views.begin(), views.end(), [&](const evaluate::View& candidate) {
    return options.picture_camera.empty() || candidate.name == options.picture_camera;
  });
  if (view == views.end())
    fail("{} {}: no such image in {}", setting("picture_camera"), options.picture_camera,
         options.cameras.string());
  return &*view;
}

void draw(const Options& options, const PointCloud& cloud, std::span<const evaluate::View> views) {
  const evaluate::View* view = view_of_picture(options, views);
  const evaluate::Viewpoint viewpoint =
      view ? evaluate::viewpoint_of(*view, options.picture_width)
           : evaluate::principal_viewpoint(cloud.positions, cloud.normals, options.picture_width,
                                           options.picture_width * 3 / 4);
  const cv::Mat3b picture = evaluate::draw_cloud(cloud.positions, cloud.colors, viewpoint);
  io::write_png(options.picture, evaluate::with_error_scale(picture, options.color_max));
}

evaluate::CloudOptions settings_of(const Options& options) {
  evaluate::CloudOptions settings;
  settings.tolerances = options.tolerances;
  settings.samples = options.samples;
  settings.seed = options.seed;
  settings.least_views = options.least_views;
  settings.gross = options.gross;
  return settings;
}

struct Measured {
  evaluate::CloudEvaluation whole;
  std::optional<evaluate::MeshEvaluation> mesh;
};

// Measures the aligned input. `colored` gets the points that count, without colours.
Measured measure(const Options& options, Input& input, const Mesh& truth,
                 const geometry::Surface& surface, std::span<const evaluate::View> views,
                 PointCloud& colored) {
  const evaluate::CloudOptions settings = settings_of(options);
  return naming(options.input, [&]() -> Measured {
    if (!input.mesh) {
      colored = counted_points(options, input, views);
      return {evaluate::evaluate_cloud(colored.positions, truth, surface, views, settings), {}};
    }
    std::vector<std::uint32_t> faces;
    evaluate::CloudEvaluation whole = evaluate::evaluate_mesh(*input.mesh, truth, surface, views,
                                                              settings, colored.positions, &faces);
    evaluate::MeshEvaluation parts = evaluate::evaluate_mesh_parts(
        *input.mesh, {colored.positions, faces}, surface, views, settings, whole);
    return {std::move(whole), std::move(parts)};
  });
}

// The colours of the vertices of the mesh by their distances to the truth. Writes the mesh with
// these colours. Empty for a cloud, and if nothing needs the colours.
std::vector<Rgb> vertex_errors(const Options& options, const Input& input,
                               const geometry::Surface& surface, const LocalFrame& frame) {
  const bool is_needed = !options.error_mesh.empty() || !options.rendered_views.empty();
  if (!input.mesh || !is_needed) return {};
  std::vector<Rgb> colors = evaluate::error_colors(
      geometry::distances_to(surface, input.mesh->vertices), options.color_max);
  if (!options.error_mesh.empty())
    io::write_mesh_ply(options.error_mesh, {input.mesh->vertices, colors, input.mesh->faces},
                       {frame, false});
  return colors;
}

// Writes the points coloured by their errors, and the picture of them.
void write_errors(const Options& options, const PointCloud& colored, const LocalFrame& frame,
                  std::span<const evaluate::View> views) {
  if (!options.error_cloud.empty())
    io::write_cloud_ply(options.error_cloud, colored, true, {frame, false});
  if (!options.picture.empty()) draw(options, colored, views);
}

void require_kind(const Options& options, const Input& input) {
  if (options.framed_only && input.mesh) fail("--framed-only is for clouds, not for a mesh");
  const std::pair<const char*, bool> for_meshes[] = {{"--render", !options.rendered_views.empty()},
                                                     {"--error-mesh", !options.error_mesh.empty()}};
  for (const auto& [name, given] : for_meshes)
    if (given && !input.mesh)
      fail("{} is for meshes, but {} has no faces", name, options.input.string());
}

}  // namespace

nlohmann::ordered_json run_cloud(const Options& options, const Context& context) {
  const Models models = read_models(options, context);
  Input input = read_input(options, models.frames.input, context);
  const Mesh truth = io::read_shape(options.truth, models.frames.truth);
  const geometry::Surface surface = naming(options.truth, [&] { return geometry::Surface(truth); });
  naming(options.truth,
         [&] { geometry::sample_surface(truth, 1, options.seed); });  // needs an area
  const std::vector<evaluate::View> views = read_views(options, models, context);
  if (options.strip) naming(options.cameras_model, [&] { evaluate::require_strip(views); });
  require_kind(options, input);
  if (!options.picture.empty()) view_of_picture(options, views);  // an error before the work
  const std::vector<RenderTask> tasks = plan_rendering(options, input, views, true);
  nlohmann::ordered_json report{{"kind", input.mesh ? "mesh" : "cloud"}};
  // Only an alignment by known centres brings together input and truth that are far apart.
  if (options.align != "centres") refuse_if_far(options, input, truth);
  Alignment alignment = align(options, input, surface, models);
  report["align"] = std::move(alignment.report);
  if (options.align == "centres") refuse_if_far(options, input, truth);

  PointCloud colored;
  const auto [result, mesh] = measure(options, input, truth, surface, views, colored);
  fmt::print("{}", evaluate::table(result));
  if (mesh) fmt::print("{}", evaluate::table(*mesh));
  const evaluate::CloudEvaluation& evaluation = result;  // a lambda cannot capture a binding
  const auto parts = naming(options.input, [&] {
    return report_parts(options,
                        {colored.positions, input.uncertainty, truth, surface, views, evaluation});
  });
  write_alignment(options, input, alignment.similarity, models.frames.truth);
  colored.colors = evaluate::error_colors(result.distances, options.color_max);
  write_errors(options, colored, models.frames.truth, views);
  const std::vector<Rgb> of_vertices = vertex_errors(options, input, surface, models.frames.truth);
  report["color_max"] = options.color_max;
  report.update(evaluate::to_json(result));
  if (mesh) report.update(evaluate::to_json(*mesh));
  report.update(parts);
  if (!tasks.empty()) report["render"] = render(options, input, tasks, &surface, of_vertices);
  return report;
}

nlohmann::ordered_json run_rendering(const Options& options, const Context& context) {
  const Models models = read_models(options, context);
  const Input input = read_input(options, models.frames.input, context);
  const std::vector<evaluate::View> views = read_views(options, models, context);
  require_kind(options, input);
  const std::vector<RenderTask> tasks = plan_rendering(options, input, views, false);
  return {{"kind", "mesh"}, {"render", render(options, input, tasks, nullptr, {})}};
}

}  // namespace axial::apps
