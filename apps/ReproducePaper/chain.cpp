// SPDX-License-Identifier: GPL-3.0-or-later
#include "chain.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/subprocess.h"
#include "evaluate/depth_evaluation.h"
#include "evaluate/statistics.h"
#include "io/colmap.h"
#include "io/dmap.h"
#include "io/housing.h"
#include "io/image.h"
#include "io/svg.h"
#include "results.h"

namespace axial {
namespace {

namespace fs = std::filesystem;

constexpr int kPictureWidth = 960;  // of depth pictures [px]

Words& operator+=(Words& words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// `folder` as `make` fills it, unless it was made from the same `inputs` before.
template <class Make>
void step(const fs::path& folder, const Json& inputs, Make make) {
  const fs::path mark = folder / "made-from.json";
  if (fs::is_regular_file(mark) && read_file(mark) == inputs.dump()) return;
  fs::remove_all(folder);
  make_folder(folder);
  make();
  write_atomically(mark, inputs.dump());
}

void run_sibling(const Chain& chain, const std::string& program, const Words& arguments,
                 const fs::path& log) {
  Words command{(program_folder() / program).string()};
  command += arguments;
  command += {"--max-threads", std::to_string(chain.max_threads)};
  run_subprocess(command, log);
}

Words options_of(const SceneOptions& o) {
  Words words{"--preset", o.preset, "--seed", fmt::format("{}", o.seed), "--medium", o.medium};
  const auto add = [&](const char* name, auto value) { words += {name, fmt::format("{}", value)}; };
  add("--views", o.views);
  add("--width", o.width);
  add("--height", o.height);
  add("--samples", o.samples);
  add("--fov-degrees", o.fov_degrees);
  add("--scale", o.scale);
  add("--relief", o.relief);
  add("--coarseness", o.coarseness);
  add("--truth", o.truth ? 1 : 0);
  words += o.port;
  return words;
}

std::vector<fs::path> files_ending_in(const fs::path& folder, const std::string& end) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().string().ends_with(end)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

// The model with the most images; empty if there is none.
fs::path largest_model(const fs::path& models) {
  fs::path best;
  std::size_t most = 0;
  for (const auto& entry : fs::directory_iterator(models)) {
    const std::size_t images = io::read_colmap_model(entry.path()).images.size();
    if (images <= most) continue;
    most = images;
    best = entry.path();
  }
  return best;
}

void extract_and_match(const Chain& chain, const fs::path& folder, const fs::path& images,
                       const Calibration& calibration) {
  const std::string threads = std::to_string(chain.max_threads > 0 ? int(chain.max_threads) : -1);
  const Words database{"--database_path", (folder / "database.db").string()};
  Words features{"colmap", "feature_extractor"};
  features += database;
  features += {"--image_path",
               images.string(),
               "--ImageReader.single_camera",
               "1",
               "--ImageReader.camera_model",
               calibration.model,
               "--ImageReader.camera_params",
               calibration.parameters,
               "--SiftExtraction.use_gpu",
               "0",
               "--SiftExtraction.num_threads",
               threads};
  run_subprocess(features, folder / "features.log");
  Words matches{"colmap", "exhaustive_matcher"};
  matches += database;
  matches += {"--SiftMatching.use_gpu", "0", "--SiftMatching.num_threads", threads};
  run_subprocess(matches, folder / "matches.log");
}

// COLMAP's mapper fails where it finds no poses: that is a result, and no error.
void map(const Chain& chain, const fs::path& folder, const fs::path& images, bool refine) {
  const std::string flag = refine ? "1" : "0";
  try {
    run_subprocess(
        {"colmap", "mapper", "--database_path", (folder / "database.db").string(), "--image_path",
         images.string(), "--output_path", (folder / "models").string(), "--Mapper.num_threads",
         std::to_string(chain.max_threads > 0 ? int(chain.max_threads) : -1),
         "--Mapper.ba_refine_focal_length", flag, "--Mapper.ba_refine_principal_point", "0",
         "--Mapper.ba_refine_extra_params", flag},
        folder / "mapper.log");
  } catch (const Error& error) {
    spdlog::warn("{}", error.what());
  }
}

std::string joined(const std::vector<double>& values) {
  std::string text;
  for (const double value : values)
    text += fmt::format("{}{:.17g}", text.empty() ? "" : ",", value);
  return text;
}

// Small enough to be kept among the numbers.
std::string small_picture(const fs::path& png) {
  cv::Mat picture = cv::imread(png.string(), cv::IMREAD_COLOR);
  if (picture.empty()) fail("{}: cannot be read", png.string());
  const double factor = std::min(1.0, static_cast<double>(kPictureWidth) / picture.cols);
  cv::resize(picture, picture, {}, factor, factor, cv::INTER_AREA);
  return io::png_in_base64(picture);
}

fs::path truth_of(const SimulatedScene& scene, const std::string& medium, const fs::path& image) {
  return scene.images(medium) / (image.stem().string() + ".distance.tiff");
}

}  // namespace

Json to_json(const SceneOptions& options) {
  return options_of(options);
}

Json to_json(const EvaluationOptions& options) {
  return {{"tolerance", options.tolerance},
          {"samples", options.samples},
          {"picture_width", options.picture_width}};
}

SimulatedScene simulated(const Chain& chain, const SceneOptions& options) {
  const Json inputs = to_json(options);
  const std::string key = Fingerprint().add(inputs.dump()).hex().substr(0, 8);
  const SimulatedScene scene{chain.work /
                             fmt::format("{}-{}-{}", options.preset, options.seed, key)};
  step(scene.folder, inputs, [&] {
    Words arguments = options_of(options);
    arguments += {"-o", scene.folder.string()};
    run_sibling(chain, "SimulateUnderwater", arguments, scene.folder / "simulate.log");
    for (const char* medium : {"air", "water"})
      if (fs::is_directory(scene.images(medium)))
        for (const fs::path& file : files_ending_in(scene.images(medium), ".normal.tiff"))
          fs::remove(file);
  });
  return scene;
}

SceneDistances scene_distances(const SimulatedScene& scene, const std::string& medium) {
  std::vector<float> distances;
  for (const fs::path& file : files_ending_in(scene.images(medium), ".distance.tiff"))
    for (const float distance : cv::Mat1f(io::read_float_tiff(file)))
      if (distance > 0) distances.push_back(distance);
  std::sort(distances.begin(), distances.end());
  const auto percentile = [&](double p) { return evaluate::percentile_of_sorted(distances, p); };
  return {percentile(50), percentile(95) / percentile(5)};
}

refractive::FlatPort<double> port_of(const SimulatedScene& scene) {
  const io::Housing housing = io::read_housing(scene.housing());
  return std::get<refractive::FlatPort<double>>(housing.ports.at(housing.default_port));
}

Calibration true_lens(const SimulatedScene& scene) {
  return calibration_of(scene.model());
}

Calibration self_calibration(const SimulatedScene& scene) {
  std::vector<double> parameters = io::read_colmap_model(scene.model()).cameras.at(0).params;
  for (const std::size_t focal : {0u, 1u}) parameters.at(focal) *= port_of(scene).n_water;
  parameters.insert(parameters.end(), {0, 0, 0, 0});
  return {"OPENCV", joined(parameters), true};
}

Calibration calibration_of(const fs::path& colmap_model) {
  const io::ColmapCamera camera = io::read_colmap_model(colmap_model).cameras.at(0);
  return {camera.model, joined(camera.params), false};
}

ColmapPoses colmap_poses(const Chain& chain, const std::string& name, const SimulatedScene& scene,
                         const std::string& medium, const Calibration& calibration) {
  const fs::path folder = scene.folder / name, metric = folder / "metric";
  const Json inputs{medium, calibration.model, calibration.parameters, calibration.refine};
  step(folder, inputs, [&] {
    extract_and_match(chain, folder, scene.images(medium), calibration);
    make_folder(folder / "models");
    map(chain, folder, scene.images(medium), calibration.refine);
    const fs::path model = largest_model(folder / "models");
    if (model.empty() || io::read_colmap_model(model).images.size() < 3) return;
    run_sibling(
        chain, "AlignModel",
        {"-i", model.string(), "--reference", scene.model().string(), "-o", metric.string()},
        folder / "align.log");
  });
  if (!fs::is_directory(metric)) return {};
  return {metric, io::read_colmap_model(metric).images.size()};
}

fs::path densified(const Chain& chain, const std::string& name, const SimulatedScene& scene,
                   const fs::path& model, const std::string& medium, const DenseOptions& options) {
  const fs::path folder = scene.folder / name;
  Words import{"-i",
               model.string(),
               "--image-folder",
               scene.images(medium).string(),
               "-o",
               (folder / "scene.mvs").string()};
  Words densify{"-i", "scene.mvs", "-w", folder.string()};
  if (!options.housing.empty()) {
    import += {"--housing", options.housing.string()};
    densify += {"--refractive"};
  }
  densify += options.more;
  step(folder, {import, densify}, [&] {
    run_sibling(chain, "InterfaceCOLMAP", import, folder / "import.log");
    run_sibling(chain, "DensifyPointCloud", densify, folder / "densify.log");
  });
  return folder;
}

Json evaluated(const Chain& chain, const fs::path& dense, const SimulatedScene& scene,
               const EvaluationOptions& options) {
  const fs::path file = dense / "evaluation.json", picture = dense / "evaluation.png";
  Words arguments{"-i",
                  (dense / "scene_dense.ply").string(),
                  "--framed-only",
                  "-m",
                  scene.mesh().string(),
                  "--cameras",
                  scene.model().string(),
                  "--housing",
                  scene.housing().string(),
                  "--tolerance",
                  fmt::format("{}", options.tolerance),
                  "--samples",
                  std::to_string(options.samples),
                  "--json",
                  file.string()};
  if (options.icp) arguments += {"--align", "icp"};
  if (options.picture_width > 0)
    arguments +=
        {"--picture", picture.string(), "--picture-width", std::to_string(options.picture_width)};
  run_sibling(chain, "EvaluateReconstruction", arguments, dense / "evaluate.log");
  const Json all = Json::parse(read_file(file));
  const Json &accuracy = all.at("accuracy"), &score = all.at("scores").at(0);
  Json result{{"points", accuracy.at("count")},  {"mean", accuracy.at("mean")},
              {"median", accuracy.at("median")}, {"variance", accuracy.at("variance")},
              {"recall", score.at("recall")},    {"f_score", score.at("f_score")}};
  if (options.picture_width > 0) result["picture"] = small_picture(picture);
  return result;
}

Json ring_errors(const fs::path& dense, const SimulatedScene& scene, const std::string& medium) {
  constexpr std::size_t kRings = 8;
  std::vector<evaluate::DepthEvaluation> maps;
  for (const fs::path& file : files_ending_in(dense, ".dmap")) {
    const DepthMap map = io::read_dmap(file).map;
    const cv::Mat1f truth = io::read_float_tiff(truth_of(scene, medium, map.image_path));
    maps.push_back(evaluate::evaluate_depth(map.depth, truth, {}));
  }
  Json rings = Json::array();
  for (const evaluate::RelativeRing& ring : evaluate::relative_rings(maps, kRings))
    rings.push_back({{"inner", ring.inner},
                     {"outer", ring.outer},
                     {"count", ring.count},
                     {"median", ring.signed_median}});
  return rings;
}

std::string depth_picture(const Chain& chain, const fs::path& dense, const SimulatedScene& scene,
                          const std::string& medium, double tolerance) {
  const fs::path file = files_ending_in(dense, ".dmap").at(0), picture = dense / "depth.png";
  const fs::path truth = truth_of(scene, medium, io::read_dmap(file).map.image_path);
  run_sibling(chain, "EvaluateReconstruction",
              {"-i", file.string(), "-m", truth.string(), "--tolerance",
               fmt::format("{}", tolerance), "--picture", picture.string()},
              dense / "depth.log");
  return small_picture(picture);
}

}  // namespace axial
