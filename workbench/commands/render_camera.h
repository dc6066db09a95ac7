#pragma once

#include "renderer/view.h"
#include "workbench/model/model.h"
#include "workbench/options/commands.h"

namespace touchstone {

/// The view of `render` for a picture of `size` pixels; `model` needs no haptics. Where nothing of the model
/// is in it stderr says why. `drawn`: bounds of all that is drawn, scene frame. Throws Error for a camera
/// that the file lacks, and for one that cannot stand where it is put.
[[nodiscard]] View chosenView(const CameraOptions& options, const Model& model, const glm::ivec2& size,
                              const Bounds& drawn);

} // namespace touchstone
