#pragma once

#include <mutex>

namespace touchstone {

/// hidapi keeps its last global error in a global variable: calls that do not concern one open device must
/// hold this lock. Never taken on the servo thread.
[[nodiscard]] std::mutex& hidapiMutex();

} // namespace touchstone
