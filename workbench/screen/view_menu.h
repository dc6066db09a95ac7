#pragma once

#include "workbench/screen/view_options.h"

#include <functional>

namespace touchstone {

/// The view options as ImGui widgets in the current window or menu: view, overlays, camera, magnifier,
/// picture. `mark` is called after each widget with its name ("view", "savePicture", "magnifier", …). Main
/// thread.
void drawViewMenu(ViewOptions& options, const std::function<void(const char*)>& mark);

} // namespace touchstone
