// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/spectrum.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace axial::simulate {
namespace {

template <class Of>
Spectrum each_band(const Of& of) {
  Spectrum spectrum;
  for (int band = 0; band < kBands; ++band)
    spectrum[band] = static_cast<float>(of(wavelength(band)));
  return spectrum;
}

double bell(double nm, double middle, double width) {
  return std::exp(-0.5 * (nm - middle) * (nm - middle) / (width * width));
}

double step(double nm, double middle) {
  return 1 / (1 + std::exp(-(nm - middle) / 12));
}

Spectrum with_mean_1(const Spectrum& spectrum) {
  return spectrum / spectrum.mean();
}

// Blue, green and red parts of the spectrum. Their sum is 1 in each band, so that grey is flat.
const Eigen::Matrix<float, kBands, 3>& parts() {
  static const Eigen::Matrix<float, kBands, 3> parts = [] {
    Eigen::Matrix<float, kBands, 3> columns;
    columns.col(0) = each_band([](double nm) { return step(nm, 580); });
    columns.col(2) = each_band([](double nm) { return 1 - step(nm, 495); });
    columns.col(1) = 1 - (columns.col(0) + columns.col(2)).array();
    return columns;
  }();
  return parts;
}

}  // namespace

Spectrum spectrum_of(const std::array<double, 13>& values) {
  return each_band([&](double nm) {
    const double place = (nm - 400) / 25;
    const auto before = std::min<std::size_t>(static_cast<std::size_t>(place), values.size() - 2);
    const double part = place - static_cast<double>(before);
    return (1 - part) * values[before] + part * values[before + 1];
  });
}

const Eigen::Matrix<float, 3, kBands>& sensitivities() {
  static const Eigen::Matrix<float, 3, kBands> rows = [] {
    Eigen::Matrix<float, 3, kBands> bells;
    bells.row(0) =
        each_band([](double nm) { return bell(nm, 602, 30) + 0.04 * bell(nm, 440, 20); });
    bells.row(1) = each_band([](double nm) { return bell(nm, 536, 36); });
    bells.row(2) = each_band([](double nm) { return bell(nm, 460, 28); });
    for (int channel = 0; channel < 3; ++channel) bells.row(channel) /= bells.row(channel).sum();
    return bells;
  }();
  return rows;
}

Eigen::Vector3f color_of(const Spectrum& light) {
  return sensitivities() * light.matrix();
}

Spectrum reflectance_of(const Eigen::Vector3f& color) {
  static const Eigen::Matrix3f shares = Eigen::Matrix3f(sensitivities() * parts()).inverse();
  return (parts() * (shares * color)).array().max(0.002f).min(1.0f);
}

Spectrum daylight() {
  constexpr double kKelvin = 6500, kSecondRadiation = 1.4388e7;  // h c / k [nm K]
  return with_mean_1(each_band([](double nm) {
    return std::pow(nm / 550, -5) / (std::exp(kSecondRadiation / (nm * kKelvin)) - 1);
  }));
}

Spectrum white_led() {
  return with_mean_1(
      each_band([](double nm) { return 0.8 * bell(nm, 450, 14) + bell(nm, 565, 58) + 0.03; }));
}

}  // namespace axial::simulate
