#pragma once

#include <cstddef>
#include <cstdint>

namespace touchstone {

/// A scene of a recording that is another one with edits of its fields.
struct EditedScene {
    uint32_t root = 0;  ///< number of the scene that was edited
    uint64_t hash = 0;  ///< SceneSculptor::hash
    size_t entries = 0; ///< of the root's journal
};

} // namespace touchstone
