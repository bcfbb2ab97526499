// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "evaluate/report.h"

namespace axial::evaluate {
namespace {

using Json = nlohmann::ordered_json;

// "2", "4 or more", "up to 2".
std::string range_of_views(std::uint32_t least, std::uint32_t most) {
  if (most == 0) return fmt::format("{} or more", least);
  return least == most ? fmt::format("{}", least) : fmt::format("up to {}", most);
}

std::string range_of_thickness(const RecallOfThickness& one) {
  if (one.most == 0) return one.least == 0 ? "not thin" : fmt::format("from {:.1f}", one.least);
  return fmt::format("{:.1f} to {:.1f}", one.least, one.most);
}

Json shares_or_null(const std::vector<double>& shares, std::size_t of) {
  Json list = Json::array();
  for (const double value : shares) list.push_back(of > 0 ? Json(value) : Json());
  return list;
}

std::string head(const char* title, const char* counted, const char* share,
                 std::span<const double> tolerances) {
  std::string text = fmt::format("{:<22}{:>10}", title, counted);
  for (const double tolerance : tolerances)
    text += fmt::format("{:>18}", fmt::format("{} {:.3g} mm", share, tolerance * 1e3));
  return text;
}

std::string share_cells(const std::vector<double>& shares, std::size_t of) {
  std::string text;
  for (const double share : shares)
    text += of > 0 ? fmt::format("{:>18.4f}", share) : fmt::format("{:>18}", "-");
  return text;
}

void add(const NormalisedErrors& errors, Json& json) {
  json["points"] = errors.points;
  json["rms"] = errors.points > 0 ? Json(errors.rms) : Json();
  json["median"] = errors.points > 0 ? Json(errors.median) : Json();
  json["within_1_2_3"] = errors.within;
}

std::string cells(const NormalisedErrors& errors) {
  const auto& [one, two, three] = errors.within;
  return fmt::format("{:>10}{:>10.3f}{:>10.3f}{:>10.4f}{:>10.4f}{:>10.4f}\n", errors.points,
                     errors.rms, errors.median, one, two, three);
}

}  // namespace

Json to_json(std::span<const RecallOfViews> classes) {
  Json list = Json::array();
  for (const RecallOfViews& one : classes)
    list.push_back({{"least", one.least},
                    {"most", one.most > 0 ? Json(one.most) : Json()},
                    {"places", one.places},
                    {"recall", shares_or_null(one.recall, one.places)}});
  return list;
}

Json to_json(std::span<const RecallOfThickness> classes) {
  Json list = Json::array();
  for (const RecallOfThickness& one : classes) {
    const bool thin = one.least > 0 || one.most > 0;
    list.push_back({{"least", thin ? Json(one.least) : Json()},
                    {"most", one.most > 0 ? Json(one.most) : Json()},
                    {"places", one.places},
                    {"recall", shares_or_null(one.recall, one.places)}});
  }
  return list;
}

Json to_json(std::span<const ErrorsOfViews> classes) {
  Json list = Json::array();
  for (const ErrorsOfViews& one : classes)
    list.push_back({{"least", one.least},
                    {"most", one.most > 0 ? Json(one.most) : Json()},
                    {"points", one.points},
                    {"share", one.share},
                    {"mean", one.points > 0 ? Json(one.mean) : Json()},
                    {"median", one.points > 0 ? Json(one.median) : Json()},
                    {"gross_share", one.points > 0 ? Json(one.gross_share) : Json()},
                    {"within", shares_or_null(one.within, one.points)}});
  return list;
}

Json to_json(const Calibration& calibration) {
  Json classes = Json::array();
  for (const Reliability& one : calibration.reliability)
    classes.push_back({{"begin", one.begin},
                       {"end", one.end},
                       {"points", one.points},
                       {"mean_confidence", one.points > 0 ? Json(one.mean_confidence) : Json()},
                       {"within", one.points > 0 ? Json(one.within) : Json()}});
  Json by_views = Json::array();
  for (const NormalisedErrorsOfViews& one : calibration.by_views) {
    by_views.push_back({{"least", one.least}, {"most", one.most > 0 ? Json(one.most) : Json()}});
    add(one.errors, by_views.back());
  }
  Json json;
  add(calibration.all, json);
  json["by_views"] = by_views;
  json["reliability"] = classes;
  return json;
}

Json to_json(const Strip& strip) {
  Json pieces = Json::array();
  for (const StripPiece& piece : strip.pieces)
    pieces.push_back({{"begin", piece.begin},
                      {"end", piece.end},
                      {"points", piece.points},
                      {"places", piece.places}});
  return {{"direction", {strip.direction.x(), strip.direction.y(), strip.direction.z()}},
          {"least", strip.least},
          {"most", strip.most},
          {"ratio", strip.least > 0 ? Json(strip.most / strip.least) : Json()},
          {"pieces", pieces}};
}

std::string table(std::span<const RecallOfViews> classes, std::span<const double> tolerances) {
  std::string text = head("seen by views", "samples", "recall", tolerances) + "\n";
  for (const RecallOfViews& one : classes)
    text += fmt::format("{:<22}{:>10}", range_of_views(one.least, one.most), one.places) +
            share_cells(one.recall, one.places) + "\n";
  return text;
}

std::string table(std::span<const RecallOfThickness> classes, std::span<const double> tolerances) {
  std::string text = head("thickness [px]", "samples", "recall", tolerances) + "\n";
  for (const RecallOfThickness& one : classes)
    text += fmt::format("{:<22}{:>10}", range_of_thickness(one), one.places) +
            share_cells(one.recall, one.places) + "\n";
  return text;
}

std::string table(std::span<const ErrorsOfViews> classes, std::span<const double> tolerances) {
  std::string text = head("points of views", "points", "within", tolerances) +
                     fmt::format("{:>10}{:>10}{:>10}{:>10}\n", "share", "mean", "median", "gross");
  for (const ErrorsOfViews& one : classes)
    text += fmt::format("{:<22}{:>10}", range_of_views(one.least, one.most), one.points) +
            share_cells(one.within, one.points) +
            fmt::format("{:>10.4f}{:>10.3f}{:>10.3f}{:>10.5f}\n", one.share, one.mean * 1e3,
                        one.median * 1e3, one.gross_share);
  return text;
}

std::string table(const Calibration& calibration) {
  std::string text = fmt::format("{:<22}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n", "expected errors",
                                 "points", "RMS", "median", "within 1", "within 2", "within 3");
  text += fmt::format("{:<22}", "all points") + cells(calibration.all);
  for (const NormalisedErrorsOfViews& one : calibration.by_views)
    if (one.errors.points > 0)
      text += fmt::format("{:<22}", "of " + range_of_views(one.least, one.most) + " views") +
              cells(one.errors);
  if (calibration.reliability.empty()) return text;
  text += fmt::format("{:<22}{:>10}{:>18}{:>18}\n", "confidence", "points", "its mean",
                      fmt::format("within {:g} errors", kReliableErrors));
  for (const Reliability& bin : calibration.reliability)
    if (bin.points > 0)
      text += fmt::format("{:<22}{:>10}{:>18.4f}{:>18.4f}\n",
                          fmt::format("{:.1f} to {:.1f}", bin.begin, bin.end), bin.points,
                          bin.mean_confidence, bin.within);
  return text;
}

std::string table(const Strip& strip) {
  const std::string ratio =
      strip.least > 0 ? fmt::format("{:.2f}", strip.most / strip.least) : "without bound";
  return fmt::format(
      "density along the strip, in {} pieces: {:.3f} to {:.3f} times the mean, ratio {}\n",
      strip.pieces.size(), strip.least, strip.most, ratio);
}

}  // namespace axial::evaluate
