// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/fingerprint.h"

#include <initializer_list>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "io/artifacts/artifact.h"
#include "io/bytes/json.h"
#include "survey/memory_survey.h"

namespace axial::survey {
namespace fs = std::filesystem;

namespace {

void add_numbers(Fingerprint& print, std::initializer_list<double> values) {
  for (const double value : values) print.add(value);
}

void add_port(Fingerprint& print, const refractive::FlatPort<double>& port) {
  add_numbers(print, {port.normal.x(), port.normal.y(), port.normal.z(), port.distance,
                      port.thickness, port.n_air, port.n_glass, port.n_water});
}

void add_port(Fingerprint& print, const refractive::DomePort<double>& port) {
  print.add("dome");
  add_numbers(print, {port.centre.x(), port.centre.y(), port.centre.z(), port.inner_radius,
                      port.thickness, port.n_air, port.n_glass, port.n_water});
}

void add_distortion(Fingerprint& print, refractive::LensDistortion<double> distortion) {
  print.add("distortion");
  distortion.each_field([&](double number) { print.add(number); });
}

void add_camera(Fingerprint& print, const CameraModel& camera) {
  print.add(static_cast<std::uint64_t>(camera.width))
      .add(static_cast<std::uint64_t>(camera.height));
  print.add(camera.lens.fx).add(camera.lens.fy).add(camera.lens.cx).add(camera.lens.cy);
  if (camera.distortion) add_distortion(print, *camera.distortion);
  print.add(std::uint64_t{camera.port.has_value()});
  if (!camera.port) return;
  std::visit([&](const auto& port) { add_port(print, port); }, *camera.port);
}

// The files whose pixels are matched or mask others.
std::vector<fs::path> files_of(const View& view, const Options& options) {
  std::vector<fs::path> files{view.file};
  if (!view.mask.empty()) files.push_back(view.mask);
  if (options.match_colors) files.push_back(view.colors);
  return files;
}

std::string content_of(const std::vector<fs::path>& files) {
  Fingerprint print;
  for (const fs::path& file : files) print.add(read_file(file));
  return print.hex();
}

std::string content_of(const MemorySurvey& survey, const View& view, const Options& options) {
  const io::Photograph photograph = photograph_of(survey, view.image);
  Fingerprint print;
  if (options.match_colors) print.add(read_file(view.colors));
  add_pixels(print, photograph.pixels);
  add_pixels(print, photograph.opaque);
  return print.hex();
}

// A fingerprint of names, sizes and times of change. Empty if a file does not exist.
std::string state_of(const std::vector<fs::path>& files) {
  Fingerprint state;
  for (const fs::path& file : files) {
    state.add(file.string());
    if (!io::add_state(state, file)) return {};
  }
  return state.hex();
}

std::string kept_or_read(const nlohmann::json& kept, const std::string& state,
                         const std::vector<fs::path>& files) {
  const auto found = kept.is_object() ? kept.find(state) : kept.end();
  if (!state.empty() && found != kept.end() && found->is_string()) return found->get<std::string>();
  return content_of(files);
}

}  // namespace

void add_pixels(Fingerprint& print, const cv::Mat& pixels) {
  print.add(static_cast<std::uint64_t>(pixels.rows)).add(static_cast<std::uint64_t>(pixels.cols));
  const std::size_t bytes = static_cast<std::size_t>(pixels.cols) * pixels.elemSize();
  for (int y = 0; y < pixels.rows; ++y)
    print.add({reinterpret_cast<const char*>(pixels.ptr(y)), bytes});
}

std::vector<std::string> contents_of_views(const Survey& survey, const KeptContents& kept,
                                           const Context& context) {
  const nlohmann::json old =
      kept.read ? io::read_object(kept.file).value("contents", nlohmann::json::object())
                : nlohmann::json::object();
  std::vector<std::string> prints(survey.views.size()), states(survey.views.size());
  ProgressCounter counter(context.stage("Fingerprints of images"), prints.size());
  parallel_for(prints.size(), [&](std::size_t v) {
    const View& view = survey.views[v];
    if (const auto& memory = survey.options.memory_survey; memory && !view.file.empty()) {
      prints[v] = content_of(*memory, view, survey.options);
    } else if (!view.file.empty()) {
      const std::vector<fs::path> files = files_of(view, survey.options);
      states[v] = kept.read ? state_of(files) : std::string();
      prints[v] = kept_or_read(old, states[v], files);
    }
    counter.add();
  });
  if (!kept.write) return prints;
  nlohmann::json contents = nlohmann::json::object();
  for (std::size_t v = 0; v < prints.size(); ++v)
    if (!states[v].empty()) contents[states[v]] = prints[v];
  if (contents != old) io::write_json(kept.file, {{"contents", contents}});
  return prints;
}

void add_view(Fingerprint& print, const Survey& survey, std::size_t index,
              const std::string& content) {
  const View& view = survey.views[index];
  print.add(std::uint64_t{view.id});
  add_camera(print, view.camera);
  for (const double value : view.pose.rotation.reshaped()) print.add(value);
  for (const double value : view.pose.centre) print.add(value);
  print.add(content);
  if (view.header.bits > 8) print.add(static_cast<std::uint64_t>(survey.bit_depth));
  if (view.header.alpha) print.add("transparent pixels are masked");
}

std::string fingerprint_of_views(const Survey& survey, const Context& context) {
  const Options& options = survey.options;
  Fingerprint print;
  print.add("AxialMVS views 1").add(static_cast<std::uint64_t>(options.ignore_mask_label));
  if (options.ignore_black_border) print.add("black borders are masked");
  const std::vector<std::string> contents = contents_of_views(survey, {}, context);
  for (std::size_t v = 0; v < contents.size(); ++v) add_view(print, survey, v, contents[v]);
  return print.hex();
}

}  // namespace axial::survey
