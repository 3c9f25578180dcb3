#pragma once
// Whether a mesh is changed until its stars agree.

namespace anistar {

/// Whether vertices are moved until the stars agree. `when_possible` asks the metric:
/// it must not vary too fast from vertex to vertex.
enum class AgreementMode { off, when_possible, on };

} // namespace anistar
