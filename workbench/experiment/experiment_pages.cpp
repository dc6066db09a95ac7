#include "workbench/experiment/experiment_pages.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

namespace touchstone {

namespace {

using experiment::SessionFlow;

constexpr ImU32 kSolid = IM_COL32(96, 108, 124, 255), kOutline = IM_COL32(200, 206, 214, 255),
                kFinger = IM_COL32(226, 176, 140, 255);

/// Lines of text, centred, each wrapped to three quarters of the window.
class Text {
  public:
    explicit Text(const PageInput& input) : input_(input), y_(0.12f * input.window.y) {}

    void large(const std::string& text) {
        line(text, ImGui::GetIO().Fonts->Fonts.back(), ImGui::GetColorU32(ImGuiCol_Text));
    }
    void plain(const std::string& text) {
        line(text, ImGui::GetIO().Fonts->Fonts.front(), ImGui::GetColorU32(ImGuiCol_Text));
    }
    void faint(const std::string& text) {
        line(text, ImGui::GetIO().Fonts->Fonts.front(), ImGui::GetColorU32(ImGuiCol_TextDisabled));
    }
    void warning(const std::string& text) {
        line(text, ImGui::GetIO().Fonts->Fonts.front(), IM_COL32(240, 180, 90, 255));
    }
    void gap(float lines = 1.0f) { y_ += lines * 18.0f * input_.scale; }
    [[nodiscard]] float y() const { return y_; }

  private:
    void line(const std::string& text, ImFont* font, ImU32 color) {
        const float width = 0.75f * input_.window.x;
        const ImVec2 size = font->CalcTextSizeA(font->FontSize, width, width, text.c_str());
        ImGui::GetWindowDrawList()->AddText(
            font, font->FontSize, ImVec2(std::floor(0.5f * (input_.window.x - size.x)), std::floor(y_)),
            color, text.c_str(), nullptr, width);
        y_ += size.y + 8.0f * input_.scale;
    }

    const PageInput& input_;
    float y_;
};

/// The reference object of training [004 Fig. 10], a circle's top or a polyline, with the finger on it.
void drawReference(const PageInput& input, const experiment::PlanarStimulus& reference, float top) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    std::vector<glm::dvec2> points = reference.points;
    if (reference.curve != experiment::PlanarStimulus::Curve::Points) {
        points.clear();
        constexpr int kPieces = 96;
        for (int i = 0; i <= kPieces; ++i)
            points.push_back(
                reference.arc.point(reference.arc.angle * (static_cast<double>(i) / kPieces - 0.5)));
    }
    glm::dvec2 low = points.front(), high = low;
    for (const glm::dvec2& point : points) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    // Room for the finger above, and a base below.
    low.y -= 0.15 * (high.x - low.x);
    high.y += 0.03;
    const double bottom = 0.92 * input.window.y;
    const double scale = std::min(0.7 * input.window.x / std::max(high.x - low.x, 1e-6),
                                  (bottom - top) / std::max(high.y - low.y, 1e-6));
    const auto at = [&](const glm::dvec2& p) {
        return ImVec2(static_cast<float>(0.5 * input.window.x + scale * (p.x - 0.5 * (low.x + high.x))),
                      static_cast<float>(bottom - scale * (p.y - low.y)));
    };
    list.Flags &= ~ImDrawListFlags_AntiAliasedFill; // else the pieces show seams
    if (!reference.closed)
        for (size_t i = 0; i + 1 < points.size(); ++i)
            list.AddQuadFilled(at(points[i]), at(points[i + 1]), at({points[i + 1].x, low.y}),
                               at({points[i].x, low.y}), kSolid);
    for (size_t i = 0; i + (reference.closed ? 0 : 1) < points.size(); ++i)
        list.AddLine(at(points[i]), at(points[(i + 1) % points.size()]), kOutline, 2.0f * input.scale);
    if (!input.finger)
        return;
    const ArcFinger finger;
    std::vector<ImVec2> pad;
    for (int i = -16; i <= 16; ++i)
        pad.push_back(at(finger.skin(*input.finger, 0.5 * finger.length * i / 16.0)));
    list.AddPolyline(pad.data(), static_cast<int>(pad.size()), kFinger, 0, 4.0f * input.scale);
}

void welcome(const PageInput& input, Text& text) {
    text.large(input.plan.name);
    text.gap();
    if (input.resumed)
        text.plain("This session goes on where it ended.");
    text.plain(
        "You will feel pairs of objects, one after the other, as long as you like. One of each pair is the "
        "reference object, the other one differs from it. After the second one you answer:");
    text.large(input.plan.question);
    text.plain(
        "Explore the first object, raise your finger, and press Enter. Explore the second, raise your "
        "finger, "
        "press 1 or 2, then Enter. There is no way back to the first object; where you are not sure, guess.");
    text.gap();
    text.plain("Put on the headphones. Space or Escape takes the force away at any time.");
    text.large("Press Enter to begin");
    text.gap();
    text.faint("Hand: " + input.hand);
    for (const std::string& warning : input.warnings)
        text.warning(warning);
}

void training(const PageInput& input, Text& text) {
    text.large("Part " + std::to_string(input.flow.part() + 1) + " of " + std::to_string(input.flow.parts()) +
               ": the reference object");
    text.plain("Feel the reference object until you know it. Then raise your finger and press Enter.");
    text.gap();
    if (const auto* planar =
            std::get_if<experiment::PlanarStimulus>(&input.plan.conditions[input.condition].reference))
        drawReference(input, *planar, text.y());
}

void interval(const PageInput& input, Text& text, bool second) {
    text.gap(4.0f);
    text.large(second ? "Object 2" : "Object 1");
    text.gap();
    if (!second) {
        text.plain("Explore the object. Then raise your finger and press Enter for the second one.");
        return;
    }
    text.plain("Explore the object. Then raise your finger and answer with 1 or 2, then Enter.");
    text.gap();
    text.large(input.plan.question);
    const int chosen = input.flow.chosen();
    text.large(chosen == 0 ? "1 or 2" : "Your answer: " + std::to_string(chosen) + ".  Enter to confirm");
}

} // namespace

void drawPage(const PageInput& input) {
    ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(input.window.x, input.window.y));
    ImGui::Begin("page", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoInputs);
    Text text(input);
    switch (input.flow.page()) {
    case SessionFlow::Page::Welcome:
        welcome(input, text);
        break;
    case SessionFlow::Page::Training:
        training(input, text);
        break;
    case SessionFlow::Page::First:
        interval(input, text, false);
        break;
    case SessionFlow::Page::Second:
        interval(input, text, true);
        break;
    case SessionFlow::Page::Finished:
        text.gap(4.0f);
        text.large("Thank you. That was all.");
        text.plain("Your answers are saved. The window can be closed.");
        break;
    }
    text.gap();
    if (!input.forceOn)
        text.warning("The force is off. Press Space for the force; the keys of the experiment wait for it.");
    if (!input.problem.empty())
        text.warning(input.problem);
    ImGui::End();
}

} // namespace touchstone
