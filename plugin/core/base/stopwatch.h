#pragma once
// Wall time by phase.

#include "base/monitor.h"

#include <map>
#include <string>

namespace anistar {

/// Tells the monitor which phase begins, and adds up the time of each.
class Stopwatch {
public:
  Stopwatch(Monitor &monitor, std::map<std::string, double> &seconds)
      : monitor_(monitor), seconds_(seconds) {}
  void phase(const std::string &name) {
    stop();
    name_ = name;
    monitor_.enter(name);
  }
  void stop() {
    const double now = monitor_.elapsed();
    if (!name_.empty())
      seconds_[name_] += now - last_;
    last_ = now;
  }

private:
  Monitor &monitor_;
  std::map<std::string, double> &seconds_;
  std::string name_;
  double last_ = 0;
};

} // namespace anistar
