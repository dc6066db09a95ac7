#pragma once

#include "experiment/people/session_flow.h"
#include "haptics/finger/arc_finger.h"

#include <glm/glm.hpp>

#include <optional>
#include <string>

namespace touchstone {

/// What the pages show. Nothing in it depends on which stimulus is felt, but in training, where it is the
/// reference.
struct PageInput {
    const experiment::StudyPlan& plan;
    const experiment::SessionFlow& flow;
    size_t condition = 0; ///< of training
    bool forceOn = true;
    bool resumed = false;
    std::string hand{};                  ///< its name
    std::vector<std::string> warnings{}; ///< for the experimenter, before the first key
    std::string problem{};               ///< the answer could not be written, for example
    std::optional<FingerPose> finger{};  ///< in training
    glm::vec2 window{1.0f};              ///< window coordinates
    float scale = 1.0f;
};

/// Draws the page over the ImGui frame. Main thread.
void drawPage(const PageInput& input);

} // namespace touchstone
