#pragma once
// What there is to change and to move, as answers.

#include "server/messages.h"
#include "touchstone/touchstone.hpp"

namespace touchstone::server {

/// `changed`: values by name.
[[nodiscard]] Json settingsTable(const Json& changed);
/// The numbers that may change, and what the materials have of them now; null: not stated. `scene`: that the
/// session touches, or null.
[[nodiscard]] Json materialsTable(ts_session session, const ts::Scene* scene);
/// A number of each material, as it is now.
[[nodiscard]] Json numberOfMaterials(ts_session session, const ts::Scene& scene, const std::string& name);
[[nodiscard]] Json objectsTable(const ts::Scene* scene);

} // namespace touchstone::server
