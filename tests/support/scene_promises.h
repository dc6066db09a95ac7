#pragma once

#include "engine/scene/scene.h"

#include <optional>
#include <string>

namespace touchstone::test {

/// Which of the promises of scene.h a loaded scene breaks; nothing if it keeps them.
[[nodiscard]] std::optional<std::string> brokenPromise(const Scene& scene);

} // namespace touchstone::test
