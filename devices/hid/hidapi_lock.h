#pragma once

#include <mutex>

namespace touchstone {

/// hidapi keeps its last global error in a variable of its own: whatever is not about one open device must
/// hold this. Never taken on the servo thread.
[[nodiscard]] std::mutex& hidapiMutex();

} // namespace touchstone
