// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/port_sigmas.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cameras/private/port_json.h"

namespace axial::io {
namespace {

using Json = nlohmann::json;

// Far below any measurement; the inverse square of the value is finite.
constexpr double kLeast = 1e-12;
constexpr double kLargestAngle = 90, kLargestLength = 1, kLargestIndex = 1;

double sigma(const JsonPlace& place, double largest) {
  const bool possible =
      is_finite_number(place.json) && place.number() >= kLeast && place.number() <= largest;
  if (!possible) place.refuse(fmt::format("a standard deviation above 0 and at most {}", largest));
  return place.number();
}

std::optional<double> number(const JsonPlace& place, const char* key, double largest) {
  if (!place.has(key)) return {};
  return sigma(place.at(key), largest);
}

template <int Size>
std::optional<Eigen::Vector<double, Size>> list(const JsonPlace& place, const char* key,
                                                double largest) {
  if (!place.has(key)) return {};
  const JsonPlace value = place.at(key);
  if (!value.json.is_array()) return Eigen::Vector<double, Size>::Constant(sigma(value, largest));
  const std::vector<JsonPlace> list = value.elements();
  if (list.size() != Size) value.refuse(fmt::format("a number or {} numbers", Size));
  Eigen::Vector<double, Size> sigmas;
  for (std::size_t k = 0; k < Size; ++k)
    sigmas(static_cast<Eigen::Index>(k)) = sigma(list[k], largest);
  return sigmas;
}

template <class Vector>
Json to_json(const Vector& sigmas) {
  return std::vector<double>(sigmas.begin(), sigmas.end());
}

}  // namespace

PortSigmas scaled(PortSigmas sigmas, double factor) {
  if (sigmas.distance) *sigmas.distance *= factor;
  if (sigmas.centre) *sigmas.centre *= factor;
  if (sigmas.thickness) *sigmas.thickness *= factor;
  return sigmas;
}

PortSigmas sigmas_from_json(const JsonPlace& place, bool is_dome) {
  PortSigmas sigmas;
  if (is_dome) {
    place.require_object({"center_m", "thickness_m", "n_water"});
    sigmas.centre = list<3>(place, "center_m", kLargestLength);
  } else {
    place.require_object({"normal_degrees", "distance_m", "thickness_m", "n_water"});
    sigmas.normal_degrees = list<2>(place, "normal_degrees", kLargestAngle);
    sigmas.distance = number(place, "distance_m", kLargestLength);
  }
  sigmas.thickness = number(place, "thickness_m", kLargestLength);
  sigmas.index = number(place, "n_water", kLargestIndex);
  return sigmas;
}

Json sigmas_to_json(const PortSigmas& sigmas) {
  Json object = Json::object();
  if (sigmas.normal_degrees) object["normal_degrees"] = to_json(*sigmas.normal_degrees);
  if (sigmas.distance) object["distance_m"] = *sigmas.distance;
  if (sigmas.centre) object["center_m"] = to_json(*sigmas.centre);
  if (sigmas.thickness) object["thickness_m"] = *sigmas.thickness;
  if (sigmas.index) object["n_water"] = *sigmas.index;
  return object;
}

}  // namespace axial::io
