// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "base/error.h"
#include "private/cameras/port_json.h"
#include "private/colmap/colmap_parts.h"

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

}  // namespace axial::io
