#include "shape.h"

namespace anistar {
std::size_t repair(Workspace &, Monitor &, double) { return 0; }
} // namespace anistar
