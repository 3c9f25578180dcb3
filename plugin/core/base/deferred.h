#pragma once
// Values that are made when they are first asked for.

#include <memory>
#include <mutex>
#include <optional>

namespace anistar {

/// Safe for concurrent use: whoever asks first makes it, and the others wait.
template <class T> class Deferred {
public:
  template <class Make> [[nodiscard]] const T &get(Make make) const {
    std::call_once(state_->once, [&] { state_->value.emplace(make()); });
    return *state_->value;
  }

private:
  struct State {
    std::once_flag once;
    std::optional<T> value;
  };
  std::unique_ptr<State> state_ = std::make_unique<State>();
};

} // namespace anistar
