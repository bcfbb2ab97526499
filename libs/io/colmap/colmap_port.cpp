// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>
#include <utility>

#include "base/error.h"
#include "cameras/private/port_json.h"
#include "cameras/private/port_values.h"
#include "colmap/private/colmap_parts.h"

namespace axial::io {
namespace {

constexpr std::array<std::string_view, 2> kWords{"FLATPORT", "DOMEPORT"};

template <class Port>
PortNumbers numbers(const Eigen::Vector3d& first, double length, const Port& port) {
  return {first.x(),      first.y(),  first.z(),    length,
          port.thickness, port.n_air, port.n_glass, port.n_water};
}

struct Numbers {
  PortNumbers operator()(const refractive::FlatPort<double>& port) const {
    return numbers(port.normal, port.distance, port);
  }
  PortNumbers operator()(const refractive::DomePort<double>& port) const {
    return numbers(port.centre, port.inner_radius, port);
  }
};

}  // namespace

std::string_view port_word(const refractive::Port<double>& port) {
  return kWords.at(port.index());
}

std::string_view port_word(int number) {
  if (number < 0 || number >= static_cast<int>(kWords.size())) return {};
  return kWords[static_cast<std::size_t>(number)];
}

bool is_port_word(std::string_view word) {
  return std::ranges::find(kWords, word) != kWords.end();
}

int port_number(const refractive::Port<double>& port) {
  return static_cast<int>(port.index());
}

PortNumbers port_numbers(const refractive::Port<double>& port) {
  return std::visit(Numbers{}, port);
}

refractive::Port<double> port_from(std::string_view word, const PortNumbers& v,
                                   const std::string& where, const Context& context) {
  const Eigen::Vector3d first(v[0], v[1], v[2]);
  refractive::Port<double> port;
  if (word == kWords[0])
    port = refractive::FlatPort<double>{
        unit_normal(first, where, context), v[3], v[4], v[5], v[6], v[7]};
  else if (word == kWords[1])
    port = refractive::DomePort<double>{first, v[3], v[4], v[5], v[6], v[7]};
  else
    fail_in(where, "the port '{}' is neither FLATPORT nor DOMEPORT", word);
  check_port(port, where);
  return port;
}

void warn_of_port_values(std::span<const ColmapCamera> cameras, const std::string& file,
                         const Context& context) {
  std::set<std::pair<int, PortNumbers>> seen;
  for (const ColmapCamera& camera : cameras)
    if (camera.port && seen.emplace(port_number(*camera.port), port_numbers(*camera.port)).second)
      warn_of_port_values(to_housing_port(*camera.port),
                          fmt::format("{}: camera {}: port", file, camera.id), context);
}

}  // namespace axial::io
