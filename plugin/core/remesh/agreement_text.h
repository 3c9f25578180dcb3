#pragma once
// What became of agreement, in words.

#include "stars/agreement.h"

#include <string>

namespace anistar {

template <std::size_t d>
[[nodiscard]] std::string text_of(const AgreementReport &report);

} // namespace anistar
