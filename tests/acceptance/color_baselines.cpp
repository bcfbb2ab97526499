// SPDX-License-Identifier: GPL-3.0-or-later
// Restores photographs one by one, as methods do that do not know what the photographs have in
// common. RestoreColors is compared with them. Usage:
//
//     color_baselines METHOD TRUTH PHOTOGRAPHS OUT
//
// TRUTH is the folder "water" of SimulateUnderwater --water, with NAME.distance.tiff; PHOTOGRAPHS
// has NAME.jpg. Writes OUT/NAME.jpg. METHOD:
//   - "grey-world": red gets the part of green that it lacks (Ancuti et al. 2018), each channel the
//     mean of all, and the values are stretched, so that 0.05 % are clipped at each end. No
//     distance is used.
//   - "one-by-one": I = J exp(-a d) + B (1 - exp(-b d)) is fitted to each photograph with the true
//     distances d. B and b are those of the darkest pixels, a is the loss by which the rest of the
//     light gets weaker with the distance in the median: the seabed's colour is taken as
//     independent of the distance.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/order_statistics.h"
#include "check_program.h"
#include "color/transfer.h"
#include "io/images/image.h"

namespace {

using namespace axial;
namespace fs = std::filesystem;

constexpr int kJpegQuality = 95;

// By the name of the photograph.
using Photographs = std::map<std::string, cv::Mat3f>;

std::vector<float> channel_of(const cv::Mat3f& image, int channel) {
  std::vector<float> values;
  for (const cv::Vec3f& pixel : image) values.push_back(pixel[channel]);
  return values;
}

// `values`: B G R, 0 to 1.
void balance_by_grey_world(cv::Mat3f& values) {
  constexpr int kGreen = 1, kRed = 2;
  cv::Scalar mean = cv::mean(values);
  const auto lacking = static_cast<float>(mean[kGreen] - mean[kRed]);
  for (cv::Vec3f& pixel : values) pixel[kRed] += lacking * (1 - pixel[kRed]) * pixel[kGreen];
  mean = cv::mean(values);
  const double grey = (mean[0] + mean[1] + mean[2]) / 3;
  for (cv::Vec3f& pixel : values)
    for (int k = 0; k < 3; ++k) pixel[k] *= static_cast<float>(grey / std::max(mean[k], 1e-3));
}

// With the same limits in all channels, so that the balance stays.
void stretch(cv::Mat3f& values) {
  constexpr double kClipped = 0.0005;
  std::vector<float> all;
  for (const cv::Vec3f& pixel : values) all.insert(all.end(), {pixel[0], pixel[1], pixel[2]});
  const float low = lower_quantile(all, kClipped), high = lower_quantile(all, 1 - kClipped);
  if (!(high > low)) return;
  for (cv::Vec3f& pixel : values)
    for (int k = 0; k < 3; ++k) pixel[k] = (pixel[k] - low) / (high - low);
}

// Pixels of a photograph at about the same distance. Light is linear, R G B.
struct Layer {
  double dark_distance = 0, distance = 0;  // of the darkest hundredth, and of all: medians [m]
  std::array<double, 3> dark{};            // the median of the darkest hundredth
  std::vector<std::size_t> pixels;
};

// Ten layers of equally many pixels. Pixels without surface are left out.
std::vector<Layer> layers_of(const cv::Mat3f& light, const cv::Mat1f& distance) {
  constexpr std::size_t kLayers = 10;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < distance.total(); ++i)
    if (distance(static_cast<int>(i)) > 0) order.push_back(i);
  const auto at = [&](std::size_t i) { return distance(static_cast<int>(i)); };
  std::ranges::sort(order, {}, at);
  std::vector<Layer> layers(kLayers);
  for (std::size_t n = 0; n < kLayers; ++n) {
    Layer& layer = layers[n];
    const auto part = [&](std::size_t i) {
      return order.begin() + static_cast<std::ptrdiff_t>(order.size() * i / kLayers);
    };
    layer.pixels.assign(part(n), part(n + 1));
    if (layer.pixels.size() < 100) fail("a layer of distances has less than 100 pixels");
    layer.distance = at(layer.pixels[layer.pixels.size() / 2]);
    std::vector<std::size_t> dark = layer.pixels;
    std::ranges::sort(dark, {}, [&](std::size_t i) {
      const cv::Vec3f& pixel = light(static_cast<int>(i));
      return pixel[0] + pixel[1] + pixel[2];
    });
    dark.resize(dark.size() / 100);
    std::vector<float> distances;
    for (const std::size_t i : dark) distances.push_back(at(i));
    layer.dark_distance = upper_median(std::move(distances));
    for (int k = 0; k < 3; ++k) {
      std::vector<float> values;
      for (const std::size_t i : dark) values.push_back(light(static_cast<int>(i))[k]);
      layer.dark[static_cast<std::size_t>(k)] = upper_median(std::move(values));
    }
  }
  return layers;
}

// B (1 - exp(-b d)).
struct Veil {
  double light = 0, rate = 0;  // B, b [1/m]
  double at(double distance) const { return light * (1 - std::exp(-rate * distance)); }
};

// The veil and the dark surface with the least squares of B (1 - s) + J s, s = exp(-b d), to the
// dark pixels of the layers, neither below 0.
struct DarkFit {
  Veil veil;
  double surface = 0;  // J
  double squares = std::numeric_limits<double>::infinity();
};

DarkFit fit_dark(std::span<const Layer> layers, std::size_t channel, double rate) {
  const auto share = [&](const Layer& layer) { return Veil{1, rate}.at(layer.dark_distance); };
  double vv = 0, vs = 0, ss = 0, vy = 0, sy = 0;
  for (const Layer& layer : layers) {
    const double v = share(layer), s = 1 - v, y = layer.dark[channel];
    vv += v * v;
    vs += v * s;
    ss += s * s;
    vy += v * y;
    sy += s * y;
  }
  const double determinant = vv * ss - vs * vs;
  DarkFit fit{{(vy * ss - sy * vs) / determinant, rate}, (sy * vv - vy * vs) / determinant, 0};
  if (!(fit.veil.light >= 0)) fit = {{0, rate}, sy / ss, 0};
  if (!(fit.surface >= 0)) fit = {{vy / vv, rate}, 0, 0};
  for (const Layer& layer : layers)
    fit.squares += std::pow(
        layer.dark[channel] - fit.veil.at(layer.dark_distance) - fit.surface * (1 - share(layer)),
        2);
  return fit;
}

// The best of the veils with b from 0.05 to 5 /m.
Veil veil_of(std::span<const Layer> layers, std::size_t channel) {
  constexpr double kFirst = 0.05, kLast = 5, kStep = 1.1;
  DarkFit best;
  for (double rate = kFirst; rate < kLast; rate *= kStep) {
    const DarkFit fit = fit_dark(layers, channel, rate);
    if (fit.squares < best.squares) best = fit;
  }
  return best.veil;
}

// a [1/m]: the slope of the logarithm of the layers' median light without veil, 0 at least.
double loss_of(std::span<const Layer> layers, const cv::Mat3f& light, const cv::Mat1f& distance,
               const Veil& veil, int channel) {
  std::vector<std::array<double, 2>> line;
  for (const Layer& layer : layers) {
    std::vector<double> values;
    for (const std::size_t i : layer.pixels)
      values.push_back(light(static_cast<int>(i))[channel] -
                       veil.at(distance(static_cast<int>(i))));
    const double median = upper_median(std::move(values));
    if (median > 0) line.push_back({layer.distance, std::log(median)});
  }
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [d, value] : line) {
    x += d;
    y += value;
    xx += d * d;
    xy += d * value;
  }
  const auto n = static_cast<double>(line.size());
  const double spread = n * xx - x * x;
  return spread > 0 ? std::max(0.0, -(n * xy - x * y) / spread) : 0;
}

// Replaces the light, R G B, by J. Pixels without surface are taken to be at the middle distance.
void remove_water(cv::Mat3f& light, cv::Mat1f distance) {
  const std::vector<Layer> layers = layers_of(light, distance);
  const auto middle = static_cast<float>(layers[layers.size() / 2].distance);
  std::array<Veil, 3> veils;
  std::array<double, 3> losses{};
  for (std::size_t k = 0; k < 3; ++k) {
    veils[k] = veil_of(layers, k);
    losses[k] = loss_of(layers, light, distance, veils[k], static_cast<int>(k));
  }
  for (std::size_t i = 0; i < light.total(); ++i) {
    cv::Vec3f& pixel = light(static_cast<int>(i));
    const float d = distance(static_cast<int>(i));
    const double way = d > 0 ? d : middle;
    for (std::size_t k = 0; k < 3; ++k) {
      float& value = pixel[static_cast<int>(k)];
      value = static_cast<float>((value - veils[k].at(way)) * std::exp(losses[k] * way));
    }
  }
}

// From light, R G B, to values, B G R. Each channel gets the same factor in all photographs, so
// that 98 % of its light are below 0.7.
void develop(Photographs& photographs) {
  std::array<float, 3> gains{};
  for (int k = 0; k < 3; ++k) {
    std::vector<float> all;
    for (const auto& [name, light] : photographs) {
      const std::vector<float> values = channel_of(light, k);
      all.insert(all.end(), values.begin(), values.end());
    }
    gains[static_cast<std::size_t>(k)] =
        0.7f / std::max(lower_quantile(std::move(all), 0.98), 1e-6f);
  }
  for (auto& [name, image] : photographs)
    for (cv::Vec3f& pixel : image) {
      cv::Vec3f values;
      for (int k = 0; k < 3; ++k)
        values[2 - k] = color::Transfer().value(pixel[k] * gains[static_cast<std::size_t>(k)]);
      pixel = values;
    }
}

cv::Mat1f read_distance(const fs::path& truth, const std::string& name, cv::Size size) {
  const fs::path file = truth / (name + ".distance.tiff");
  const cv::Mat1f distance = io::read_float_tiff(file);
  if (distance.size() != size) fail_in(file, "has another size than the photograph");
  return distance;
}

std::vector<std::string> names_in(const fs::path& truth) {
  constexpr std::string_view kEnd = ".distance.tiff";
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(truth)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(kEnd)) names.push_back(name.substr(0, name.size() - kEnd.size()));
  }
  if (names.empty()) fail_in(truth, "has no distances (NAME.distance.tiff)");
  return names;
}

int run(int, char** argv) {
  const std::string method = argv[1];
  const fs::path truth = argv[2], folder = argv[3], out = argv[4];
  if (method != "grey-world" && method != "one-by-one")
    fail("METHOD is '{}', but must be grey-world or one-by-one", method);
  Photographs photographs;
  for (const std::string& name : names_in(truth)) {
    const cv::Mat pixels = io::read_photograph(folder / (name + ".jpg")).pixels;
    cv::Mat3f& image = photographs[name];
    if (method == "grey-world") {
      pixels.convertTo(image, CV_32F, 1 / 255.0);
      balance_by_grey_world(image);
      stretch(image);
    } else {
      image = color::light_of(pixels, 8, {});
      remove_water(image, read_distance(truth, name, image.size()));
    }
  }
  if (method == "one-by-one") develop(photographs);
  fs::create_directories(out);
  for (const auto& [name, values] : photographs) {
    cv::Mat3b pixels;
    values.convertTo(pixels, CV_8U, 255);
    io::write_jpeg(out / (name + ".jpg"), pixels, kJpegQuality);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return check_program(argc, argv, 4, 4, "color_baselines METHOD TRUTH PHOTOGRAPHS OUT", run);
}
