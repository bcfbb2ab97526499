// SPDX-License-Identifier: GPL-3.0-or-later
#include "given_exposures.h"

#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/cameras/photograph_numbers.h"
#include "survey/photograph_names.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The views whose photographs have a name, with one search of the names for most of them.
class Names {
 public:
  explicit Names(const survey::Survey& survey)
      : survey_(survey), names_(survey::photograph_names(survey)) {
    for (std::size_t view = 0; view < names_.size(); ++view)
      views_[names_[view].string()].push_back(view);
  }

  std::vector<std::size_t> views(const std::string& name) const {
    const auto found = views_.find(name);
    return found != views_.end() ? found->second : survey::views_named(name, survey_);
  }

  std::string of(std::size_t view) const { return names_[view].string(); }

 private:
  const survey::Survey& survey_;
  std::vector<fs::path> names_;
  std::map<std::string, std::vector<std::size_t>> views_;
};

}  // namespace

color::Exposures given_exposures(const fs::path& file, const survey::Survey& survey) {
  const Names names(survey);
  std::vector<double> exposures(survey.views.size(), 0);
  for (const auto& [name, exposure] : io::read_photograph_numbers(file, "exposure")) {
    if (!(exposure > 0))
      fail_in(file, "the exposure of {} is {}, but must be above 0", name, exposure);
    for (const std::size_t view : names.views(name)) {
      if (exposures[view] > 0) fail_in(file, "two lines are for the photograph {}", names.of(view));
      exposures[view] = exposure;
    }
  }
  for (std::size_t view = 0; view < exposures.size(); ++view)
    if (exposures[view] == 0) fail_in(file, "has no exposure of the photograph {}", names.of(view));
  return color::exposures_of(exposures);
}

}  // namespace axial::apps
