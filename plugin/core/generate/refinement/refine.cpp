#include "generate/refinement/rules/rules.h"

#include <stdexcept>

namespace anistar::generate {
namespace {

double progress_of(const Rules &rules) {
  const auto done = static_cast<double>(rules.mesh().points.size());
  return done / (done + static_cast<double>(rules.n_waiting()));
}

/// Apply one of the rules until no one applies; rule i has priority over j if i < j.
void apply_rules(Rules &rules, bool with_slivers, Monitor &monitor) {
  while (monitor.keep_going(rules.mesh().points.size(), progress_of(rules)))
    if (!(rules.apply_rule_1() || rules.apply_rule_2() || rules.apply_rule_3() ||
          (with_slivers && rules.apply_rule_4())))
      return;
}

} // namespace

Refined refine(const Tetrahedralisation &input, const Sizes &sizes,
               const RefinementSettings &settings, const Monitor::Progress &progress) {
  if (input.cells.empty())
    throw std::invalid_argument("there is no tetrahedron to refine");
  if (sizes.size() > 1 && sizes.size() != input.points.size())
    throw std::invalid_argument("sizes must be one, or one for each point");
  Monitor monitor(progress, settings.max_vertices, settings.max_seconds);
  Rules rules(input, sizes, settings);
  RefinementRecord &record = rules.record();

  monitor.enter("refine");
  rules.queue_all();
  apply_rules(rules, false, monitor);
  record.seconds_refining = monitor.elapsed();

  if (settings.slivers.are_eliminated && monitor.reason() == StopReason::finished) {
    monitor.enter("eliminate slivers");
    rules.begin_sliver_elimination();
    apply_rules(rules, true, monitor);
    record.seconds_eliminating = monitor.elapsed() - record.seconds_refining;
  }
  record.stop = monitor.reason();
  rules.finish_record();
  return {rules.mesh().extracted(), record};
}

} // namespace anistar::generate
