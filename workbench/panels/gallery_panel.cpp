#include "workbench/panels/card.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/panels.h"
#include "workbench/screen/keys.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace touchstone {

namespace {

// Layout units. A picture has its native size, so that no filter blurs it.
constexpr float kPictureWidth = 208.0f, kPictureHeight = 130.0f, kLines = 60.0f, kGap = 14.0f, kInset = 4.0f,
                kGalleryMargin = 24.0f;
constexpr ImU32 kCardGround = IM_COL32(44, 48, 54, 255), kHovered = IM_COL32(60, 68, 80, 255);

/// Layout of the entries: our own first; the recent ones start a new row.
struct Grid {
    size_t columns = 1, samples = 0, count = 0;

    [[nodiscard]] size_t below(size_t at) const { return moved(at, 1); }
    [[nodiscard]] size_t above(size_t at) const { return moved(at, -1); }

  private:
    [[nodiscard]] size_t sampleRows() const { return (samples + columns - 1) / columns; }
    [[nodiscard]] size_t moved(size_t at, int rows) const {
        const bool sample = at < samples;
        const size_t place = sample ? at : at - samples, column = place % columns;
        const auto row = static_cast<int>(place / columns + (sample ? 0 : sampleRows())) + rows;
        if (row < 0)
            return at;
        const auto wanted = static_cast<size_t>(row);
        if (wanted < sampleRows())
            return std::min(wanted * columns + column, samples - 1);
        const size_t first = samples + (wanted - sampleRows()) * columns;
        return first < count ? std::min(first + column, count - 1) : at;
    }
};

void moveChoice(const Grid& grid, PanelState& state) {
    size_t& at = state.galleryAt;
    at = std::min(at, grid.count - 1);
    if (keyPressed(GLFW_KEY_RIGHT))
        at = std::min(at + 1, grid.count - 1);
    if (keyPressed(GLFW_KEY_LEFT) && at > 0)
        --at;
    if (keyPressed(GLFW_KEY_DOWN))
        at = grid.below(at);
    if (keyPressed(GLFW_KEY_UP))
        at = grid.above(at);
}

void choose(const GalleryEntry& entry, PanelState& state) {
    if (entry.state == GalleryState::Missing) {
        if (!entry.sample)
            state.forget = entry.file;
        return;
    }
    state.open = entry.file;
    state.gallery = false; // also where it first prompts for unsaved materials
}

/// Text in place of a missing picture.
const char* signOf(const GalleryEntry& entry) {
    switch (entry.state) {
    case GalleryState::Waiting:
        return "…";
    case GalleryState::NoPicture:
        return "no picture";
    case GalleryState::Broken:
        return "no picture: it cannot be drawn";
    case GalleryState::Missing:
        return entry.sample ? "it is gone" : "it is gone: remove";
    case GalleryState::Shown:
        break;
    }
    return "";
}

/// Broken between words into two lines at most; what goes on ends with an ellipsis.
std::string inTwoLines(const std::string& text, float width) {
    constexpr const char* kMore = " …";
    std::string lines = brokenLines(text, width);
    const size_t first = lines.find('\n');
    if (first == std::string::npos || lines.find('\n', first + 1) == std::string::npos)
        return lines;
    lines = brokenLines(text, width - ImGui::CalcTextSize(kMore).x);
    return lines.substr(0, lines.find('\n', lines.find('\n') + 1)) + kMore;
}

/// Its note or its location.
std::string lineOf(const GalleryEntry& entry) {
    return !entry.note.empty() ? entry.note : entry.sample ? "" : entry.file.parent_path().string();
}

void drawCell(const PanelInput& input, size_t index, bool chosen, bool hovered, const ImVec2& at,
              const Widgets& widgets) {
    const GalleryEntry& entry = input.gallery[index];
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float inset = widgets.units(kInset), width = widgets.units(kPictureWidth),
                height = widgets.units(kPictureHeight);
    const ImVec2 from(at.x + inset, at.y + inset), to(from.x + width, from.y + height);
    const ImVec2 end(to.x + inset, to.y + widgets.units(kLines));
    if (hovered)
        draw.AddRectFilled(at, end, kHovered, widgets.units(6.0f));
    draw.AddRectFilled(from, to, kCardGround);
    if (entry.state == GalleryState::Shown)
        input.showPicture(index, {from.x, from.y}, {to.x, to.y});
    const char* sign = signOf(entry);
    const ImVec2 size = ImGui::CalcTextSize(sign);
    const ImU32 grey = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    draw.AddText(ImVec2(0.5f * (from.x + to.x - size.x), 0.5f * (from.y + to.y - size.y)),
                 entry.state == GalleryState::Broken ? kAmber : grey, sign);
    if (chosen)
        draw.AddRect(at, end, kBlue, widgets.units(6.0f), 0, widgets.units(2.0f));
    const ImVec2 name(from.x + widgets.units(2.0f), to.y + widgets.units(6.0f));
    const ImVec4 clip(name.x, name.y, to.x, end.y - widgets.units(4.0f));
    ImFont* font = ImGui::GetFont();
    const float line = ImGui::GetFontSize();
    const std::string title = entry.sample ? entry.file.stem().string() : entry.file.filename().string();
    draw.AddText(font, line, name,
                 entry.state == GalleryState::Missing ? grey : ImGui::GetColorU32(ImGuiCol_Text),
                 title.c_str(), nullptr, 0.0f, &clip);
    const std::string note = inTwoLines(lineOf(entry), to.x - name.x);
    draw.AddText(font, line, ImVec2(name.x, name.y + line + widgets.units(3.0f)), grey, note.c_str(), nullptr,
                 0.0f, &clip);
}

void cell(const PanelInput& input, size_t index, bool scrollTo, PanelState& state, Widgets& widgets) {
    const GalleryEntry& entry = input.gallery[index];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(static_cast<int>(index));
    const bool pressed =
        ImGui::InvisibleButton("##cell", ImVec2(widgets.units(kPictureWidth + 2.0f * kInset),
                                                widgets.units(kPictureHeight + kInset + kLines)));
    ImGui::PopID();
    const bool hovered = ImGui::IsItemHovered();
    widgets.mark(((entry.sample ? "gallery:" : "recent:") + entry.file.filename().string()).c_str());
    if (hovered)
        ImGui::SetTooltip("%s%s%s", entry.file.c_str(), entry.note.empty() ? "" : "\n", entry.note.c_str());
    if (scrollTo)
        ImGui::SetScrollHereY(0.5f);
    drawCell(input, index, index == state.galleryAt, hovered, at, widgets);
    if (pressed) {
        state.galleryAt = index;
        choose(entry, state);
    }
}

void cells(const PanelInput& input, const Grid& grid, bool moved, PanelState& state, Widgets& widgets) {
    for (size_t i = 0; i < grid.count; ++i) {
        const bool first = i == 0 || i == grid.samples;
        if (first)
            widgets.section(i < grid.samples ? "OUR OWN SCENES" : "OPENED BEFORE");
        else if ((i < grid.samples ? i : i - grid.samples) % grid.columns != 0)
            ImGui::SameLine(0.0f, widgets.units(kGap));
        cell(input, i, moved && i == state.galleryAt, state, widgets);
    }
}

} // namespace

void drawGallery(const PanelInput& input, PanelState& state, const WidgetRect& place, Widgets& widgets) {
    if (!state.gallery)
        return;
    const float cellWidth = widgets.units(kPictureWidth + 2.0f * kInset + kGap),
                margin = widgets.units(kGalleryMargin);
    const float frame = 2.0f * ImGui::GetStyle().WindowPadding.x + ImGui::GetStyle().ScrollbarSize;
    Grid grid{.count = input.gallery.size()};
    grid.columns = static_cast<size_t>(std::max(1.0f, (place.width - 2.0f * margin - frame) / cellWidth));
    grid.columns = std::min<size_t>(grid.columns, 6);
    grid.samples = static_cast<size_t>(std::ranges::count(input.gallery, true, &GalleryEntry::sample));
    const float width = static_cast<float>(grid.columns) * cellWidth + frame;
    ImGui::SetNextWindowPos(ImVec2(place.x + 0.5f * place.width, place.y + margin), ImGuiCond_Always,
                            ImVec2(0.5f, 0.0f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0.0f), ImVec2(width, place.height - 2.0f * margin));
    if (beginCardWindow("gallery", widgets, kAnsweredCard)) {
        ImGui::TextUnformatted("What would you like to touch?");
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - Widgets::buttonWidth("x"));
        if (widgets.button("galleryClose", "x"))
            state.gallery = false;
        widgets.wrapped(
            "Arrow keys and Enter, or a click; Escape goes back. A file may be dropped here, too.",
            ImGui::GetColorU32(ImGuiCol_TextDisabled));
        if (grid.count > 0) {
            const size_t before = state.galleryAt;
            moveChoice(grid, state);
            cells(input, grid, before != state.galleryAt, state, widgets);
            if (keyPressed({GLFW_KEY_ENTER, GLFW_KEY_KP_ENTER}))
                choose(input.gallery[state.galleryAt], state);
            if (keyPressed(GLFW_KEY_DELETE) && !input.gallery[state.galleryAt].sample)
                state.forget = input.gallery[state.galleryAt].file;
        }
        ImGui::GetIO().WantCaptureKeyboard = true; // the arrows do not move the camera in this frame
    }
    ImGui::End();
}

} // namespace touchstone
