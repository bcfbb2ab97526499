// SPDX-License-Identifier: GPL-3.0-or-later
#include "survey/photograph_check.h"

#include "base/error.h"

namespace axial::survey {
namespace {

constexpr std::size_t kEnoughSamples = 100;  // a correlation by chance is then 0 +- 0.1
constexpr double kLeastAgreement = 0.15;

bool can_be_judged(const PhotographFacts& facts) {
  return facts.looked_at && (facts.is_blank || facts.samples >= kEnoughSamples);
}

bool is_foreign(const PhotographFacts& facts) {
  return can_be_judged(facts) && (facts.is_blank || facts.agreement < kLeastAgreement);
}

void warn_of(const std::string& name, const PhotographFacts& facts, const Context& context) {
  if (facts.is_blank)
    return context.warning("{}: the photograph is blank: all of it has one grey value", name);
  context.warning(
      "{}: the photograph does not show the ground that the scene's other photographs show: was it "
      "exchanged? (correlation {:.2f} at {} sparse points; photographs of the scene have 0.5 or "
      "more)",
      name, facts.agreement, facts.samples);
}

}  // namespace

PhotographCheck::PhotographCheck(const Scene& scene, std::filesystem::path scene_file)
    : samples_(scene), scene_file_(std::move(scene_file)) {
  for (const SceneImage& image : scene.images) names_.push_back(image.path);
}

void PhotographCheck::report(const Context& context) const {
  const std::vector<PhotographFacts> all = samples_.facts();
  std::size_t taken = 0, judged = 0, blank = 0, foreign = 0;
  for (const PhotographFacts& facts : all) {
    taken += facts.looked_at ? 1 : 0;
    blank += facts.looked_at && facts.is_blank ? 1 : 0;
    judged += can_be_judged(facts) ? 1 : 0;
    foreign += is_foreign(facts) ? 1 : 0;
  }
  if (2 * blank > taken)
    fail_in(scene_file_, "{} of {} photographs are blank: all of each has one grey value", blank,
            taken);
  if (2 * foreign > judged)
    return context.warning(
        "{}: {} of {} photographs do not show the same ground at the scene's sparse points: do the "
        "photographs, the lenses and the ports belong to this scene?",
        scene_file_.string(), foreign, judged);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (is_foreign(all[i])) warn_of(names_[i], all[i], context);
}

}  // namespace axial::survey
