// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/coordinate_system.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "base/file_extension.h"
#include "base/parse_number.h"
#include "base/split.h"

namespace axial::control {
namespace {

// GDAL's messages are not printed while it exists.
class QuietGdal {
 public:
  QuietGdal() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

// "EPSG:32616" for "WGS84 UTM 16N", as OpenDroneMap writes it; other texts unchanged.
std::string with_utm_as_code(const std::string& text) {
  std::string words = lower_case(std::string(trimmed(text)));
  for (const std::string_view start : {"wgs84 utm ", "wgs 84 utm ", "wgs84 / utm zone "}) {
    if (!words.starts_with(start) || words.size() < start.size() + 2) continue;
    const bool south = words.back() == 's';
    words.pop_back();
    const auto zone = parse_number<int>(trimmed(std::string_view(words).substr(start.size())));
    if (zone && *zone >= 1 && *zone <= 60)
      return "EPSG:" + std::to_string((south ? 32700 : 32600) + *zone);
  }
  if (words == "wgs84" || words == "wgs 84") return "EPSG:4326";
  return text;
}

std::string wkt_of(OGRSpatialReferenceH system) {
  char* text = nullptr;
  OSRExportToWkt(system, &text);
  const std::string wkt = text ? text : "";
  CPLFree(text);
  return wkt;
}

// The length of a short way between two places, of which longitude and latitude are given [rad],
// with the radii of curvature along the meridian and across it.
double length_on_ellipsoid(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double semi_major,
                           double inverse_flattening) {
  const double flattening = inverse_flattening > 0 ? 1 / inverse_flattening : 0;
  const double squared_eccentricity = flattening * (2 - flattening);
  const double latitude = (a.y() + b.y()) / 2;
  const double w = std::sqrt(1 - squared_eccentricity * std::pow(std::sin(latitude), 2));
  const double along = semi_major * (1 - squared_eccentricity) / (w * w * w);
  const double across = semi_major / w * std::cos(latitude);
  const double east = std::remainder(b.x() - a.x(), 2 * std::numbers::pi);
  return std::hypot(along * (b.y() - a.y()), across * east);
}

using SystemPtr = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>,
                                  decltype(&OSRDestroySpatialReference)>;

// Whether the system of this code is `system`. A text may state the code of another system.
bool is_of_code(OGRSpatialReferenceH system, int code) {
  const SystemPtr known(OSRNewSpatialReference(nullptr), &OSRDestroySpatialReference);
  if (OSRImportFromEPSG(known.get(), code) != OGRERR_NONE) return false;
  constexpr std::array<const char*, 3> kOptions{
      "CRITERION=EQUIVALENT", "IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", nullptr};
  return OSRIsSameEx(system, known.get(), kOptions.data()) != 0;
}

std::string name_of_system(OGRSpatialReferenceH system) {
  if (OSRIsLocal(system)) return {};
  OSRAutoIdentifyEPSG(system);
  const char* authority = OSRGetAuthorityName(system, nullptr);
  const char* text = OSRGetAuthorityCode(system, nullptr);
  const auto code = text ? parse_number<int>(text) : std::nullopt;
  if (authority && code && std::string(authority) == "EPSG" && is_of_code(system, *code))
    return std::string("EPSG:") + text;
  return wkt_of(system);
}

}  // namespace

std::optional<CoordinateSystem> CoordinateSystem::from_text(const std::string& text) {
  const QuietGdal quiet;
  CoordinateSystem result;
  result.system_ = {OSRNewSpatialReference(nullptr), [](void* system) {
                      OSRDestroySpatialReference(static_cast<OGRSpatialReferenceH>(system));
                    }};
  std::string allow_network = "ALLOW_NETWORK_ACCESS=NO", allow_file = "ALLOW_FILE_ACCESS=NO";
  std::array<char*, 3> options{allow_network.data(), allow_file.data(), nullptr};
  const std::string definition = with_utm_as_code(text);
  auto* const system = static_cast<OGRSpatialReferenceH>(result.system_.get());
  if (definition.find('\0') != std::string::npos ||
      OGRSpatialReference::FromHandle(system)->SetFromUserInput(definition.c_str(),
                                                                options.data()) != OGRERR_NONE)
    return {};
  OSRSetAxisMappingStrategy(system, OAMS_TRADITIONAL_GIS_ORDER);
  result.name_ = name_of_system(system);
  return result;
}

std::string CoordinateSystem::wkt() const {
  return wkt_of(static_cast<OGRSpatialReferenceH>(system_.get()));
}

bool CoordinateSystem::is_local() const {
  return OSRIsLocal(static_cast<OGRSpatialReferenceH>(system_.get())) != 0;
}

bool CoordinateSystem::is_geographic() const {
  return OSRIsGeographic(static_cast<OGRSpatialReferenceH>(system_.get())) != 0;
}

bool CoordinateSystem::is_metric() const {
  auto* const system = static_cast<OGRSpatialReferenceH>(system_.get());
  return (OSRIsProjected(system) || OSRIsLocal(system)) &&
         std::abs(OSRGetLinearUnits(system, nullptr) - 1) < 1e-12;
}

double CoordinateSystem::map_scale(const Eigen::Vector2d& place) const {
  auto* const system = static_cast<OGRSpatialReferenceH>(system_.get());
  if (!OSRIsProjected(system)) return 1;
  CoordinateSystem geographic;
  geographic.system_ = {OSRCloneGeogCS(system), [](void* one) {
                          OSRDestroySpatialReference(static_cast<OGRSpatialReferenceH>(one));
                        }};
  auto* const base = static_cast<OGRSpatialReferenceH>(geographic.system_.get());
  OSRSetAxisMappingStrategy(base, OAMS_TRADITIONAL_GIS_ORDER);
  constexpr double kStep = 100;  // on the map, to either side
  const std::array<Eigen::Vector2d, 4> around{
      place - Eigen::Vector2d(kStep, 0), place + Eigen::Vector2d(kStep, 0),
      place - Eigen::Vector2d(0, kStep), place + Eigen::Vector2d(0, kStep)};
  std::vector<Eigen::Vector2d> there = transformed(around, *this, geographic);
  const double unit = OSRGetAngularUnits(base, nullptr);  // degree or grad [rad]
  for (Eigen::Vector2d& one : there) one *= unit;
  const double radius = OSRGetSemiMajor(system, nullptr);
  const double flattening = OSRGetInvFlattening(system, nullptr);
  return kStep * (1 / length_on_ellipsoid(there[0], there[1], radius, flattening) +
                  1 / length_on_ellipsoid(there[2], there[3], radius, flattening));
}

std::vector<Eigen::Vector2d> transformed(std::span<const Eigen::Vector2d> places,
                                         const CoordinateSystem& from, const CoordinateSystem& to) {
  const QuietGdal quiet;
  std::vector<Eigen::Vector2d> result(places.begin(), places.end());
  const auto destroy = [](OGRCoordinateTransformationH t) {
    OCTDestroyCoordinateTransformation(t);
  };
  const std::unique_ptr<std::remove_pointer_t<OGRCoordinateTransformationH>, decltype(destroy)>
      transformation(
          OCTNewCoordinateTransformation(static_cast<OGRSpatialReferenceH>(from.system_.get()),
                                         static_cast<OGRSpatialReferenceH>(to.system_.get())),
          destroy);
  for (Eigen::Vector2d& place : result) {
    int works = 0;
    if (transformation)
      OCTTransformEx(transformation.get(), 1, &place.x(), &place.y(), nullptr, &works);
    if (!works) place.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return result;
}

std::string utm_zone(double longitude, double latitude) {
  const double turned = longitude - 360 * std::floor((longitude + 180) / 360);  // -180 to 180
  const int zone = std::clamp(static_cast<int>(std::floor((turned + 180) / 6)) + 1, 1, 60);
  return "EPSG:" + std::to_string((latitude < 0 ? 32700 : 32600) + zone);
}

}  // namespace axial::control
