// SPDX-License-Identifier: GPL-3.0-or-later
#include "rigs.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/error.h"
#include "io/cameras/photograph_numbers.h"
#include "io/colmap/rigs.h"
#include "pose/adjust/uncertainty.h"
#include "pose/bundle/rig_fit.h"

namespace axial::apps {
namespace {

using Json = nlohmann::ordered_json;
using pose::RigCamera;
using Known = RigCamera::Known;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kMillimetres = 1000, kMilliseconds = 1000;

// A camera of a rig that is not the reference camera, with what is known about it.
struct RigPart {
  const pose::Rig& rig;
  std::size_t index;            // of the camera
  const pose::RigSigma* sigma;  // null: not computed
  pose::RigFit fit;

  const RigCamera& camera() const { return rig.cameras[index]; }
};

void for_each_part(const pose::Bundle& bundle, const pose::Uncertainty& known,
                   const std::function<void(std::size_t rig, const RigPart& part)>& take) {
  for (std::size_t i = 0; i < bundle.rigs.size(); ++i)
    for (std::size_t k = 1; k < bundle.rigs[i].cameras.size(); ++k)
      take(i, {bundle.rigs[i], k, known.rig_sigmas.empty() ? nullptr : &known.rig_sigmas[i][k],
               fit_of(bundle, bundle.rigs[i], k)});
}

double turn_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.rotation * b.rotation.transpose()).angle() * kDegrees;
}

// The standard deviation of the distance between the camera and the reference camera [m].
double base_sigma(const RigPart& part) {
  if (!part.sigma) return 0;
  const Eigen::Vector3d& centre = part.camera().now.centre;
  if (!(centre.norm() > 0)) return part.sigma->translation.norm();
  return part.sigma->translation.cwiseProduct(centre.normalized()).norm();
}

std::string plus_minus(double sigma, int digits) {
  return std::isfinite(sigma) ? fmt::format(" +- {:.{}f}", sigma, digits) : " (not known)";
}

// The delay in words: a time, or without times a length along the track.
std::string delay_in_words(const RigPart& part) {
  const pose::RigFit& fit = part.fit;
  if (part.rig.has_seconds)
    return fmt::format("{:.2f} +- {:.2f} ms", std::abs(fit.delay) * kMilliseconds,
                       fit.delay_sigma * kMilliseconds);
  return fmt::format("{:.2f} +- {:.2f} mm of the track",
                     std::abs(fit.delay) * fit.speed * kMillimetres,
                     fit.delay_sigma * fit.speed * kMillimetres);
}

std::string pose_line(const RigPart& part) {
  const RigCamera& camera = part.camera();
  std::string line = fmt::format(
      "Rig: {} is {:.2f}{} mm from {}", camera.name, camera.now.centre.norm() * kMillimetres,
      part.camera().known == Known::fixed ? "" : plus_minus(base_sigma(part) * kMillimetres, 2),
      part.rig.cameras[0].name);
  if (camera.known == Known::fixed) line += ", fixed";
  if (camera.known == Known::stated)
    line += fmt::format(", stated: {:.2f} mm; it moved by {:.2f} mm and {:.3f} degrees",
                        camera.stated.centre.norm() * kMillimetres,
                        (camera.now.centre - camera.stated.centre).norm() * kMillimetres,
                        turn_between(camera.now, camera.stated));
  return line + fmt::format("; {} frames deviate by {:.2f} mm and {:.3f} degrees (RMS)",
                            part.fit.frames, part.fit.translation_rms * kMillimetres,
                            part.fit.rotation_rms * kDegrees);
}

// The components of the change of a stated pose, in its standard deviations.
double largest_contradiction(const RigCamera& camera) {
  const Eigen::Vector3d shift = (camera.now.centre - camera.stated.centre);
  const Eigen::AngleAxisd turn(camera.now.rotation * camera.stated.rotation.transpose());
  return std::max(shift.cwiseAbs().maxCoeff() / camera.sigma_translation,
                  turn.angle() / camera.sigma_rotation);
}

Json numbers_or_null(const Eigen::Vector3d& values, double unit) {
  Json list = Json::array();
  for (const double value : values)
    list.push_back(std::isfinite(value) ? Json(value * unit) : Json(nullptr));
  return list;
}

// The photographs of the camera in wrong frames, at most five by name.
std::string wrong_frames(const pose::Bundle& bundle, const RigPart& part) {
  constexpr std::size_t kMost = 5;
  std::vector<std::string> names;
  for (const std::size_t frame : part.fit.wrong) {
    const auto& images = part.rig.frames[frame].images;
    const auto image = std::ranges::find(images, part.index, &pose::RigFrame::Image::camera);
    if (names.size() < kMost) names.push_back(bundle.images[image->image].name);
  }
  const std::size_t more = part.fit.wrong.size() - names.size();
  return fmt::format("{}{}", fmt::join(names, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

// A pose in the form of rig_config.json.
Json pose_json(const Pose& pose) {
  const Eigen::Quaterniond q(pose.rotation);
  const Eigen::Vector3d t = -pose.rotation * pose.centre;
  return {{"cam_from_rig_rotation", {q.w(), q.x(), q.y(), q.z()}},
          {"cam_from_rig_translation", {t.x(), t.y(), t.z()}}};
}

Json timing_json(const RigPart& part) {
  if (!std::isfinite(part.fit.delay_sigma)) return nullptr;
  const bool seconds = part.rig.has_seconds;
  const double unit = seconds ? kMilliseconds : part.fit.speed;
  const char* const suffix = seconds ? "ms" : "m_of_track";
  return {{fmt::format("delay_{}", suffix), part.fit.delay * unit},
          {fmt::format("sigma_{}", suffix), part.fit.delay_sigma * unit},
          {seconds ? "speed_m_per_s" : "speed_m_per_frame", part.fit.speed},
          {"significant", part.fit.is_late()}};
}

Json part_json(const RigPart& part) {
  const RigCamera& camera = part.camera();
  const char* const kinds[] = {"fixed", "stated", "free"};
  Json json{{"name", camera.name}, {"pose", kinds[static_cast<int>(camera.known)]}};
  json.update(pose_json(camera.now));
  json["base_m"] = camera.now.centre.norm();
  if (camera.known != Known::free) json["stated"] = pose_json(camera.stated);
  json["sigma_translation_m"] =
      part.sigma ? numbers_or_null(part.sigma->translation, 1) : Json(nullptr);
  json["sigma_rotation_degrees"] =
      part.sigma ? numbers_or_null(part.sigma->rotation, kDegrees) : Json(nullptr);
  json["frames"] = part.fit.frames;
  json["wrong_frames"] = part.fit.wrong.size();
  json["rms_translation_m"] = part.fit.translation_rms;
  json["rms_rotation_degrees"] = part.fit.rotation_rms * kDegrees;
  json["timing"] = timing_json(part);
  return json;
}

}  // namespace

void declare_rigs(OptionList& visible, RigInput& rigs) {
  visible
      .add("rig", &rigs.file,
           "cameras that are mounted together: COLMAP's rig_config.json, or rigs.txt or rigs.bin "
           "beside frames.txt or frames.bin; a stated distance between two cameras [m] gives the "
           "model its scale")
      .add_with_default(
          "rig-poses", &rigs.poses,
          "poses of cameras in their rig: stated (near those of the file, as far as their standard "
          "deviations say, and estimated for cameras without one), fixed, or free (estimated)")
      .one_of({"stated", "fixed", "free"})
      .add("rig-frames", &rigs.frames,
           "regular expression whose first group is the same in the names of photographs that were "
           "taken at the same time; without it, names are the same behind image_prefix")
      .add("rig-times", &rigs.times,
           "file with a line NAME,SECONDS for each photograph of a rig: the photographs nearest in "
           "time belong together, unless --rig-frames is given")
      .add("rig-interval", &rigs.interval,
           "time between two frames of a rig [s], so that delays between its cameras are reported "
           "as times")
      .positive();
}

void check_rigs(const RigInput& rigs) {
  const auto require_rig = [&](bool given, const char* option, const std::string& value) {
    if (given && rigs.file.empty()) fail("--{} {}: needs --rig", option, value);
  };
  require_rig(rigs.poses != "stated", "rig-poses", rigs.poses);
  require_rig(!rigs.frames.empty(), "rig-frames", rigs.frames);
  require_rig(!rigs.times.empty(), "rig-times", rigs.times.string());
  require_rig(rigs.interval > 0, "rig-interval", fmt::format("{}", rigs.interval));
  if (!rigs.times.empty() && rigs.interval > 0)
    fail("--rig-interval {}: contradicts --rig-times, which states the times", rigs.interval);
  if (!rigs.frames.empty() && !rigs.file.empty() && rigs.file.extension() != ".json")
    fail("--rig-frames {}: contradicts --rig {}, which states the frames", rigs.frames,
         rigs.file.string());
}

std::vector<std::filesystem::path> files_of(const RigInput& rigs) {
  if (rigs.file.empty()) return {};
  std::vector<std::filesystem::path> files{rigs.file};
  if (rigs.file.extension() != ".json")
    files.push_back(rigs.file.parent_path() / ("frames" + rigs.file.extension().string()));
  if (!rigs.times.empty()) files.push_back(rigs.times);
  return files;
}

std::vector<pose::Rig> read_rigs(const RigInput& rigs, const io::ColmapModel& model) {
  if (rigs.file.empty()) return {};
  pose::RigOptions options;
  options.poses = rigs.poses == "fixed"  ? Known::fixed
                  : rigs.poses == "free" ? Known::free
                                         : Known::stated;
  options.frames = rigs.frames;
  options.interval = rigs.interval;
  if (!rigs.times.empty()) options.times = io::read_photograph_numbers(rigs.times, "seconds");
  return make_rigs(io::read_rigs(rigs.file), model.images, options, rigs.file.string());
}

void scale_stated(std::vector<pose::Rig>& rigs, double map_scale) {
  for (pose::Rig& rig : rigs)
    for (RigCamera& camera : rig.cameras) {
      if (!camera.is_metric()) continue;
      camera.stated.centre *= map_scale;
      camera.now.centre *= map_scale;
      camera.sigma_translation *= map_scale;
    }
}

std::vector<std::string> input_lines(const std::vector<pose::Rig>& rigs) {
  std::vector<std::string> lines;
  for (const pose::Rig& rig : rigs) {
    std::vector<std::string> names;
    for (const RigCamera& camera : rig.cameras) names.push_back(camera.name);
    const auto several = std::ranges::count_if(
        rig.frames, [](const pose::RigFrame& frame) { return frame.images.size() > 1; });
    lines.push_back(fmt::format("Rig of {}: {} of {} frames have several photographs",
                                fmt::join(names, ", "), several, rig.frames.size()));
  }
  return lines;
}

std::vector<std::string> rig_lines(const pose::Bundle& bundle, const pose::Uncertainty& known) {
  std::vector<std::string> lines;
  for_each_part(bundle, known, [&](std::size_t, const RigPart& part) {
    lines.push_back(pose_line(part));
    if (std::isfinite(part.fit.delay_sigma) && !part.fit.is_late())
      lines.push_back(
          fmt::format("Rig: {} and {} take their photographs at the same time, within {}",
                      part.camera().name, part.rig.cameras[0].name, delay_in_words(part)));
  });
  return lines;
}

std::vector<std::string> rig_warnings(const pose::Bundle& bundle, const pose::Uncertainty& known) {
  std::vector<std::string> lines;
  for_each_part(bundle, known, [&](std::size_t, const RigPart& part) {
    const RigCamera& camera = part.camera();
    if (part.fit.is_late())
      lines.push_back(fmt::format(
          "Rig: {} takes its photographs {} {} than {}, which moves it by {:.1f} mm: the poses "
          "allow for it, but synchronised cameras are more accurate",
          camera.name, delay_in_words(part), part.fit.delay > 0 ? "later" : "earlier",
          part.rig.cameras[0].name, std::abs(part.fit.delay) * part.fit.speed * kMillimetres));
    if (!part.fit.wrong.empty())
      lines.push_back(
          fmt::format("Rig: {} deviate from the rig, and count little: the photographs of a frame "
                      "may have been "
                      "taken at different times",
                      wrong_frames(bundle, part)));
    if (camera.known == Known::stated && largest_contradiction(camera) > 3)
      lines.push_back(fmt::format(
          "Rig: the photographs do not fit the stated pose of {}: it moved by {:.2f} mm and {:.3f} "
          "degrees, {:.1f} times its standard deviation; calibrate the rig again, or state a "
          "larger "
          "standard deviation",
          camera.name, (camera.now.centre - camera.stated.centre).norm() * kMillimetres,
          turn_between(camera.now, camera.stated), largest_contradiction(camera)));
  });
  return lines;
}

nlohmann::ordered_json rigs_json(const pose::Bundle& bundle, const pose::Uncertainty& known) {
  if (bundle.rigs.empty()) return nullptr;
  Json json = Json::array();
  for (const pose::Rig& rig : bundle.rigs)
    json.push_back({{"reference", rig.cameras[0].name},
                    {"frames", rig.frames.size()},
                    {"cameras", Json::array()}});
  for_each_part(bundle, known, [&](std::size_t rig, const RigPart& part) {
    json[rig]["cameras"].push_back(part_json(part));
  });
  return json;
}

}  // namespace axial::apps
