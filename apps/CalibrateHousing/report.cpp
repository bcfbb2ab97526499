// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/bytes/json.h"
#include "pose/adjust/free_numbers.h"

namespace axial::apps {
namespace {

using calibrate::Calibration;
using Json = nlohmann::ordered_json;

struct Photograph {
  std::string name;
  std::size_t found = 0, used = 0;  // corners
  double rms = 0;                   // [px]
  bool piece = false;
  calibrate::BoardPlace place;
};

std::vector<Photograph> photographs_of(const Calibration& calibration) {
  const pose::Bundle& bundle = calibration.bundle.bundle;
  const auto errors = pose::reprojection_errors_by_image(bundle);
  std::vector<Photograph> rows;
  for (std::size_t i = 0; i < errors.size(); ++i)
    rows.push_back({bundle.images[i].name, calibration.views[i].corners.size(), errors[i].size(),
                    pose::root_mean_square(errors[i]), calibration.views[i].piece,
                    calibrate::board_place(bundle, i, calibration.views[i])});
  return rows;
}

std::vector<pose::HousingNumber> values_of(const Calibration& calibration) {
  return pose::free_values(calibration.bundle.bundle, calibration.uncertainty.camera_sigmas,
                           calibration.adjust);
}

double rms_of(const Calibration& calibration) {
  return pose::root_mean_square(reprojection_errors(calibration.bundle.bundle));
}

// JSON has no infinity: null means that no photograph determines the number.
Json finite_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace

std::vector<std::string> report_lines(const Calibration& calibration,
                                      const std::string& port_name) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{:<32} {:>8} {:>9} {:>13} {:>15}", "photograph", "corners",
                              "RMS [px]", "distance [m]", "tilt [degrees]"));
  for (const Photograph& row : photographs_of(calibration))
    lines.push_back(fmt::format("{:<32} {:>8} {:>9.3f} {:>13.3f} {:>15.1f}{}", row.name, row.used,
                                row.rms, row.place.distance, row.place.tilt_degrees,
                                row.piece ? "  piece" : ""));
  lines.push_back(fmt::format("{:<32} {:>8} {:>9.3f}", "all",
                              calibration.bundle.bundle.observations.size(), rms_of(calibration)));
  if (const std::size_t pieces = calibration.pieces(); pieces > 0)
    lines.push_back(fmt::format("{} photographs show the whole board, {} a piece of the board",
                                calibration.views.size() - pieces, pieces));
  for (const pose::HousingNumber& value : values_of(calibration))
    lines.push_back(fmt::format("Port {}: {} {:.6g} +- {:.2g} {}", port_name, value.name, value.now,
                                value.sigma, value.unit));
  return lines;
}

std::string report_json(const Calibration& calibration, const calibrate::Limits& limits) {
  Json json{{"rms_px", rms_of(calibration)},
            {"pixel_sigma", calibration.uncertainty.pixel_sigma},
            {"converged", calibration.last.converged}};
  json["free"] = Json::array();
  for (const pose::HousingNumber& value : values_of(calibration))
    json["free"].push_back({{"name", value.name},
                            {"unit", value.unit},
                            {"value", value.now},
                            {"sigma", finite_or_null(value.sigma)}});
  json["photographs"] = Json::array();
  for (const Photograph& row : photographs_of(calibration))
    json["photographs"].push_back({{"name", row.name},
                                   {"corners_found", row.found},
                                   {"corners_used", row.used},
                                   {"rms_px", row.rms},
                                   {"distance_m", row.place.distance},
                                   {"tilt_degrees", row.place.tilt_degrees},
                                   {"piece", row.piece}});
  json["pieces"] = calibration.pieces();
  json["left_out"] = json["left_out_reasons"] = Json::array();
  for (const auto& [image, reason] : calibration.left_out) {
    json["left_out"].push_back(image);
    json["left_out_reasons"].push_back(reason);
  }
  json["missing"] = calibrate::gaps(calibration);
  if (const auto next = calibrate::next_photograph(calibration, limits))
    json["next_photograph"] = calibrate::words_for(next->board);
  // to_text() replaces bytes that are not UTF-8: such a name must not prevent the report.
  return io::to_text(json, 1) + "\n";
}

}  // namespace axial::apps
