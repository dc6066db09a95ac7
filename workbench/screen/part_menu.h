#pragma once

#include "engine/scene/scene_part.h"

#include <functional>

namespace touchstone {

/// The menu of an object, in a popup: hide, isolate, show all. `mark` is called after each item with its
/// name.
void drawPartItems(const Scene& scene, int node, ScenePart& part,
                   const std::function<void(const char*)>& mark);

/// Hides and isolates what the pointer is over: keys as in Blender, and a menu on the right button. Main
/// thread, within an ImGui frame.
class PartMenu {
  public:
    struct Situation {
        const Scene* scene = nullptr; ///< null: no model
        bool covered = false;         ///< by an item that has the keyboard
        std::function<int()> pointed; ///< the node under the pointer; -1: none
    };
    void update(const Situation& now, ScenePart& part, const std::function<void(const char*)>& mark);

  private:
    int node_ = -1; ///< of the open menu
};

} // namespace touchstone
