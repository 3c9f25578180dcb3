#include "remesh/agreement_text.h"

#include <iomanip>
#include <sstream>

namespace anistar {

template <std::size_t d> std::string text_of(const AgreementReport &report) {
  std::ostringstream text;
  text << std::setprecision(2);
  switch (report.outcome) {
  case AgreementOutcome::off:
    return "off";
  case AgreementOutcome::not_asked:
    return "skipped: not asked for, and in 3D it takes as long as the remeshing";
  case AgreementOutcome::stopped_before:
    return std::string("skipped: stopped by ") + name_of(report.stopped_by);
  case AgreementOutcome::varies_too_fast:
    text << "skipped: the metric varies too fast, ln gamma ";
    if (d == 2)
      text << "of " << 100 - report.percent << " % of the edges is above "
           << std::to_string(report.ln_gamma);
    else
      text << "p" << report.percent << " " << report.ln_gamma << " > "
           << report.largest_ln_gamma;
    return text.str();
  case AgreementOutcome::stopped:
    if (d == 2)
      return std::string("stopped by ") + name_of(report.stopped_by);
    [[fallthrough]];
  case AgreementOutcome::done:
    text << "done";
    if (d == 3 && report.counts.after > 0)
      text << ", " << name_of(report.counts.stop) << " with " << report.counts.after
           << " facets left";
    return text.str();
  }
  return "unknown";
}

template std::string text_of<2>(const AgreementReport &);
template std::string text_of<3>(const AgreementReport &);

} // namespace anistar
