// SPDX-License-Identifier: GPL-3.0-or-later
#include "light.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <span>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/parse_number.h"
#include "base/progress.h"
#include "base/split.h"
#include "io/bytes/json.h"
#include "io/bytes/json_place.h"
#include "io/images/image.h"
#include "write_scene.h"

namespace axial::apps {
namespace {

using nlohmann::json;

simulate::PlainWater plain_water(const std::string& text) {
  constexpr std::size_t kNumbers = 9;
  std::vector<float> numbers;
  for (const std::string_view word : split(text, ',')) {
    const auto number = parse_finite<double>(word);
    const double most = numbers.size() < 6 ? 20 : 1;
    if (!number || *number < 0 || *number > most)
      fail("--water {}: '{}' is not a number from 0 to {}", text, word, most);
    numbers.push_back(static_cast<float>(*number));
  }
  if (numbers.size() != kNumbers)
    fail("--water {}: must be a type of water, or nine numbers: a, b and B, each for R, G and B",
         text);
  const Eigen::Map<const Eigen::Array3f> a(numbers.data()), b(&numbers[3]), veil(&numbers[6]);
  return {a, b, veil};
}

simulate::Lamp lamp_of(const io::JsonPlace& place) {
  place.require_object({"place", "direction", "half_angle_degrees", "power"});
  simulate::Lamp lamp{place.at("place").vector(), place.at("direction").vector()};
  if (!(lamp.direction.norm() > 0)) place.at("direction").refuse("a direction");
  lamp.direction.normalize();
  lamp.half_angle = simulate::kRadians * place.number_or("half_angle_degrees", 40);
  lamp.power = place.number_or("power", 1);
  if (!(lamp.half_angle > 0 && lamp.half_angle < 170 * simulate::kRadians))
    place.at("half_angle_degrees").refuse("a number between 0 and 170");
  if (!(lamp.power > 0)) place.at("power").refuse("a number above 0");
  return lamp;
}

std::vector<simulate::Lamp> read_lamps(const std::filesystem::path& path) {
  const json file = io::read_json(path);
  const io::JsonPlace list = io::JsonPlace::of_file(file, path).at("lamps");
  std::vector<simulate::Lamp> lamps;
  for (const io::JsonPlace& place : list.elements()) lamps.push_back(lamp_of(place));
  if (lamps.empty()) list.refuse("a list of at least one lamp");
  return lamps;
}

simulate::Light light_of(const Arguments& a, const CommonOptions& common) {
  simulate::Light light;
  light.sun.depth = a.depth;
  constexpr std::string_view kFile = "lamp:";
  if (a.light == "lamp")
    light.lamps = simulate::usual_lamps();
  else if (a.light.starts_with(kFile))
    light.lamps = read_lamps(in_working_folder(common, a.light.substr(kFile.size())));
  else if (a.light != "sun")
    fail("--light is '{}', but must be sun, lamp or lamp:FILE", a.light);
  return light;
}

json numbers(const simulate::Spectrum& spectrum) {
  json list = json::array();
  for (const float value : spectrum) list.push_back(value);
  return list;
}

json numbers(const Eigen::Array3f& values) {
  return {values[0], values[1], values[2]};
}

json numbers(const Eigen::Vector3d& values) {
  return {values[0], values[1], values[2]};
}

json describe(const simulate::PlainWater& water) {
  return {{"model", "plain"},
          {"a", numbers(water.a)},
          {"b", numbers(water.b)},
          {"veil", numbers(water.veil)}};
}

json describe(const simulate::SpectralWater& lit) {
  json file = {{"model", "spectral"},
               {"type", lit.water.type},
               {"wavelengths_nm", json::array()},
               {"absorption_per_m", numbers(lit.water.absorption)},
               {"scattering_per_m", numbers(lit.water.scattering)},
               {"daylight_loss_per_m", numbers(lit.water.daylight_loss)},
               {"blurred_share", lit.water.blurred},
               {"lamps", json::array()}};
  for (int band = 0; band < simulate::kBands; ++band)
    file["wavelengths_nm"].push_back(simulate::wavelength(band));
  for (const simulate::Lamp& lamp : lit.light.lamps)
    file["lamps"].push_back({{"place", numbers(lamp.place)},
                             {"direction", numbers(lamp.direction)},
                             {"half_angle_degrees", lamp.half_angle / simulate::kRadians},
                             {"power", lamp.power}});
  if (lit.light.lamps.empty()) file["depth_m"] = lit.light.sun.depth;
  return file;
}

// One exposure for all photographs, from a few views that are rendered small.
double exposure_of(const simulate::Preset& preset, const simulate::LitScene& scene,
                   const simulate::AnyWater& water, const cv::Vec3f& balance) {
  constexpr std::size_t kViews = 5;
  constexpr int kSmaller = 8;
  simulate::Lens lens = preset.lens;
  lens.width = std::max(1, lens.width / kSmaller);
  lens.height = std::max(1, lens.height / kSmaller);
  lens.focal /= kSmaller;
  lens.cx = (lens.cx + 0.5) / kSmaller - 0.5;
  lens.cy = (lens.cy + 0.5) / kSmaller - 0.5;
  std::vector<cv::Mat3f> radiances;
  const std::size_t views = std::min(kViews, preset.views.size());
  for (std::size_t i = 0; i < views; ++i) {
    const simulate::View& view = preset.views[i * preset.views.size() / views];
    radiances.push_back(
        simulate::render_underwater(scene, water, lens, port_of_view(preset, view), view, 1)
            .radiance);
  }
  return simulate::exposure(radiances, balance);
}

// A factor within `stops` powers of two.
float exposure_within(double stops, std::mt19937& random) {
  constexpr double kRange = 4294967296.0;  // of the numbers of std::mt19937
  return static_cast<float>(std::exp2(stops * (2 * (static_cast<double>(random()) / kRange) - 1)));
}

// For `RestoreColors --exposures`.
void write_exposures(const std::filesystem::path& file, const simulate::Preset& preset,
                     std::span<const float> exposures) {
  std::string lines = "name,exposure\n";
  for (std::size_t i = 0; i < exposures.size(); ++i)
    lines += fmt::format("{}.jpg,{}\n", view_name(preset, i), exposures[i]);
  write_atomically(file, lines);
}

}  // namespace

simulate::AnyWater water_of(const Arguments& a, const CommonOptions& common) {
  if (a.water.find(',') != std::string::npos) return plain_water(a.water);
  std::optional<double> scattering;
  if (a.scattering >= 0) scattering = a.scattering;
  return simulate::SpectralWater{simulate::jerlov_water(a.water, scattering), light_of(a, common)};
}

void check_depth(const simulate::AnyWater& water, const simulate::Preset& preset,
                 const simulate::TriangleMesh& mesh) {
  const auto* spectral = std::get_if<simulate::SpectralWater>(&water);
  if (!spectral || !spectral->light.lamps.empty()) return;
  double highest = -1e9;
  for (const simulate::View& view : preset.views) highest = std::max(highest, view.centre.z());
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    highest = std::max(highest, static_cast<double>(vertex.z()));
  if (spectral->light.sun.depth <= highest)
    fail("--depth {}: must be above {:.2f} m, the height of the highest camera or ground",
         spectral->light.sun.depth, highest);
}

void photograph_with_light(const Arguments& a, const simulate::Preset& preset,
                           const simulate::LitScene& scene, const simulate::AnyWater& water,
                           std::uint32_t noise_seed, const std::filesystem::path& folder) {
  const simulate::Response response = simulate::parse_response(a.response);
  const cv::Vec3f balance = simulate::white_balance(water);
  const double bright = std::holds_alternative<simulate::PlainWater>(water)
                            ? 1
                            : exposure_of(preset, scene, water, balance);
  const cv::Vec3f gains = static_cast<float>(bright) * balance;
  json file = std::visit([](const auto& kind) { return describe(kind); }, water);
  file["gains"] = {gains[2], gains[1], gains[0]};
  file["response"] = a.response;
  std::mt19937 random(noise_seed);
  std::vector<float> exposures;
  for (std::size_t i = 0; i < preset.views.size(); ++i)
    exposures.push_back(exposure_within(a.exposure_stops, random));
  if (a.exposure_stops > 0) {
    file["exposures"] = exposures;
    write_exposures(folder / "exposures.csv", preset, exposures);
  }
  io::write_json(folder / "light.json", file);
  const ProgressSink progress = console_progress("Images (water)");
  for (std::size_t i = 0; i < preset.views.size(); ++i) {
    const simulate::View& view = preset.views[i];
    const simulate::Port port = port_of_view(preset, view);
    const std::string name = view_name(preset, i);
    simulate::LitImage image =
        simulate::render_underwater(scene, water, preset.lens, port, view, a.samples);
    const cv::Mat3f values =
        simulate::photograph_of(image.radiance, exposures[i] * gains, response);
    io::write_jpeg(folder / (name + ".jpg"),
                   simulate::develop(values, a.noise, simulate::noise_key(noise_seed, i, true)),
                   a.jpeg_quality);
    if (a.truth) {
      cv::cvtColor(image.albedo, image.albedo, cv::COLOR_BGR2RGB);
      io::write_float_tiff(folder / (name + ".albedo.tiff"), image.albedo);
      if (!image.lit.empty()) io::write_float_tiff(folder / (name + ".lit.tiff"), image.lit);
    }
    progress(i + 1, preset.views.size());
  }
}

}  // namespace axial::apps
