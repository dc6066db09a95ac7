#include "engine/scene/scene.h"
#include "engine/volume/volume.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace touchstone {

namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.5g", value);
    return text;
}

/// Voxels by value, on a logarithmic scale: air is most of a scan. A line stands at the value of the surface.
void histogram(const Volume& volume, double iso, Widgets& widgets) {
    std::array<float, Volume::kBins> heights{};
    for (size_t bin = 0; bin < heights.size(); ++bin)
        heights[bin] = std::log1p(static_cast<float>(volume.histogram()[bin]));
    const float most = *std::ranges::max_element(heights);
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::PlotHistogram("##histogram", heights.data(), static_cast<int>(heights.size()), 0, nullptr, 0.0f,
                         most, ImVec2(width, widgets.units(64.0f)));
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const auto share = static_cast<float>((iso - volume.low()) / (volume.high() - volume.low()));
    const float x = low.x + std::clamp(share, 0.0f, 1.0f) * (high.x - low.x);
    ImGui::GetWindowDrawList()->AddLine(ImVec2(x, low.y), ImVec2(x, high.y),
                                        ImGui::GetColorU32(ImVec4(0.45f, 0.82f, 0.55f, 1.0f)),
                                        widgets.units(2.0f));
    widgets.mark("histogram");
}

} // namespace

void drawVolume(const PanelInput& input, PanelState& state, Widgets& widgets) {
    if (input.scene == nullptr || input.scene->volume == nullptr)
        return;
    const Volume& volume = *input.scene->volume;
    widgets.section("VOLUME");
    const glm::ivec3 size = volume.size();
    widgets.wrapped(volume.facts().format + ", " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                    " x " + std::to_string(size.z) + " of " + volume.facts().fileType);
    // While it is dragged the value is here: the surface is built for it as often as the worker is done. What
    // was asked for last counts until nothing is loading any more, or else going back to the value that is
    // shown would leave the worker at another one.
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID dragged = ImGui::GetID("isoDragged"), held = ImGui::GetID("isoHeld"),
                  asked = ImGui::GetID("isoAsked");
    const bool holding = storage.GetBool(held);
    if (!holding && !input.loading)
        storage.SetFloat(asked, NAN);
    const float pending = storage.GetFloat(asked, NAN);
    const float current = std::isnan(pending) ? static_cast<float>(input.scene->iso) : pending;
    float iso = holding ? storage.GetFloat(dragged) : current;
    histogram(volume, static_cast<double>(iso), widgets);
    ImGui::PushItemWidth(-1.0f);
    const auto low = static_cast<float>(volume.low()), high = static_cast<float>(volume.high());
    if (widgets.slider("iso", "surface at", iso, {.low = low, .high = high, .clamp = true},
                       number(static_cast<double>(iso))))
        // At the lowest value there is no surface, nor above it by less than a normal number: the servo takes
        // that for zero (engine/core/float_mode.h).
        iso = std::min(high,
                       std::max({iso, std::nextafter(low, high), low + std::numeric_limits<float>::min()}));
    ImGui::PopItemWidth();
    const bool released = ImGui::IsItemDeactivatedAfterEdit(), active = ImGui::IsItemActive();
    if (iso != current && (released || (active && !input.loading && !input.typing))) {
        state.iso = static_cast<double>(iso);
        storage.SetFloat(asked, iso);
    }
    storage.SetBool(held, active);
    storage.SetFloat(dragged, iso);
}

} // namespace touchstone
