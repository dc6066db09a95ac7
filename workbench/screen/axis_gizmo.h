#pragma once

#include "renderer/camera.h"
#include "workbench/screen/view_options.h"

#include <functional>
#include <optional>

namespace touchstone {

/// The workspace's axes as the camera sees them, in a corner of the picture: a click looks along one, at its
/// end from there. `corner`: upper right one of the picture, window coordinates; `scale`: window coordinates
/// per layout unit. `mark` is called after each end with its name ("axis:+x"). Within an ImGui frame.
[[nodiscard]] std::optional<CameraMove> drawAxisGizmo(const OrbitCamera& camera, const glm::vec2& corner,
                                                      float scale,
                                                      const std::function<void(const char*)>& mark);
/// The same without a click, into ImGui's background: for saved pictures.
void paintAxes(const OrbitCamera& camera, const glm::vec2& corner, float scale);

} // namespace touchstone
