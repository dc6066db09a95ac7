#include "tests/screenshot/text_audit.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

namespace touchstone::test {

namespace {

constexpr float kSlack = 1.0f; // window coordinates

struct Rect {
    float x0, y0, x1, y1;

    [[nodiscard]] bool meets(const Rect& other) const {
        return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
    }
};

/// A line of text that was drawn at once.
struct Run {
    std::string text;
    Rect rect;  ///< from the top of its line to the bottom
    Rect seen;  ///< where its window shows it
    float size; ///< height of type
};

/// A letter of a font, and how much of its picture is used.
struct Letter {
    const ImFont* font = nullptr;
    const ImFontGlyph* glyph = nullptr;
    float lost = 0.0f; ///< pixels, at the side that has lost most
};

/// The letter that has these texture coordinates in its picture: text that is cut while it is drawn uses a
/// part.
Letter letterAt(const ImVec2& low, const ImVec2& high) {
    const ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const auto width = static_cast<float>(atlas.TexWidth), height = static_cast<float>(atlas.TexHeight);
    constexpr float kRounding = 1e-6f;
    for (const ImFont* font : atlas.Fonts)
        for (const ImFontGlyph& glyph : font->Glyphs) {
            const std::array<float, 4> lost{low.x - glyph.U0, low.y - glyph.V0, glyph.U1 - high.x,
                                            glyph.V1 - high.y};
            if (std::ranges::min(lost) > -kRounding)
                return {font, &glyph,
                        std::max(width * std::max(lost[0], lost[2]), height * std::max(lost[1], lost[3]))};
        }
    return {};
}

std::string utf8(unsigned code) {
    char text[5];
    return ImTextCharToUtf8(text, code);
}

/// A text of any width that is typed, and scrolls.
bool isTypedText(std::string_view window) {
    return window.find("/##program_") != std::string_view::npos;
}

class Audit {
  public:
    explicit Audit(float smallest) : smallest_(smallest) {}

    std::vector<std::string> all() {
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int i = 0; i < data.CmdListsCount; ++i)
            list(*data.CmdLists[i]);
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
            if (window->WasActive && !window->Hidden)
                content(*window);
        return {complaints_.begin(), complaints_.end()};
    }

  private:
    void complain(const std::string& where, const std::string& what) {
        complaints_.insert(where + ": " + what);
    }

    /// A quad of four corners in the order that ImGui's texts have, with a texture that varies both ways.
    void list(const ImDrawList& list) {
        owner_ = list._OwnerName != nullptr ? list._OwnerName : "background";
        if (isTypedText(owner_))
            return;
        const ImGuiWindow* const window = ImGui::FindWindowByName(owner_.c_str());
        scrolls_ = window != nullptr && window->ScrollMax.y > 0.0f;
        runs_.clear();
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const Rect clip{command.ClipRect.x, command.ClipRect.y, command.ClipRect.z, command.ClipRect.w};
            const ImDrawIdx* const index = list.IdxBuffer.Data + command.IdxOffset;
            for (unsigned i = 0; i + 5 < command.ElemCount;) {
                const ImDrawVert* const a = &list.VtxBuffer[static_cast<int>(index[i] + command.VtxOffset)];
                const bool quad = index[i + 1] == index[i] + 1 && index[i + 2] == index[i] + 2 &&
                                  index[i + 3] == index[i] && index[i + 4] == index[i] + 2 &&
                                  index[i + 5] == index[i] + 3 && a[0].uv.x != a[2].uv.x &&
                                  a[0].uv.y != a[2].uv.y;
                if (quad)
                    letter(a[0], a[2], clip);
                i += quad ? 6 : 3;
            }
        }
        for (size_t i = 0; i < runs_.size(); ++i)
            for (size_t j = i + 1; j < runs_.size(); ++j)
                compare(runs_[i], runs_[j]);
    }

    void letter(const ImDrawVert& low, const ImDrawVert& high, const Rect& clip) {
        const Rect quad{low.pos.x, low.pos.y, high.pos.x, high.pos.y};
        if (!quad.meets(clip))
            return;
        const Letter found = letterAt(low.uv, high.uv);
        if (found.glyph == nullptr)
            return; // another picture
        // The deepest letters of this font reach a fraction of a pixel out of their line.
        if (found.lost > 1.5f * kSlack * smallest_ / 11.0f)
            return complain(owner_, "a letter behind '" + (runs_.empty() ? "" : runs_.back().text) +
                                        "' is cut by its widget");
        const ImFontGlyph& glyph = *found.glyph;
        const float drawn = (high.uv.y - low.uv.y) / (glyph.V1 - glyph.V0); // of the letter's height
        const float size = found.font->FontSize * (quad.y1 - quad.y0) / (drawn * (glyph.Y1 - glyph.Y0));
        const float top = quad.y0 - glyph.Y0 * size / found.font->FontSize;
        const bool goesOn = !runs_.empty() && std::abs(runs_.back().rect.y0 - top) < 1.5f &&
                            quad.x0 > runs_.back().rect.x1 - 2.0f &&
                            quad.x0 < runs_.back().rect.x1 + 0.75f * size;
        if (!goesOn)
            runs_.push_back({"", {quad.x0, top, quad.x1, top + size}, clip, size});
        Run& run = runs_.back();
        run.text += utf8(glyph.Codepoint);
        run.rect.x1 = std::max(run.rect.x1, quad.x1);
        if (quad.x0 < clip.x0 - kSlack || quad.x1 > clip.x1 + kSlack)
            complain(owner_, "'" + run.text + "' is cut at the side");
        if (!scrolls_ && (quad.y0 < clip.y0 - kSlack || quad.y1 > clip.y1 + kSlack))
            complain(owner_, "'" + run.text + "' is cut above or below");
        if (size < smallest_ - 0.01f)
            complain(owner_, "'" + run.text + "' is " + std::to_string(size) + " high");
    }

    void compare(const Run& a, const Run& b) {
        const float wide = std::min(a.rect.x1, b.rect.x1) - std::max(a.rect.x0, b.rect.x0);
        const float high = std::min(a.rect.y1, b.rect.y1) - std::max(a.rect.y0, b.rect.y0);
        if (wide > 1.5f && high > 0.3f * std::min(a.size, b.size) && a.rect.meets(b.seen) &&
            b.rect.meets(a.seen))
            complain(owner_, "'" + a.text + "' and '" + b.text + "' overlap");
    }

    /// Widgets without text, too.
    void content(const ImGuiWindow& window) {
        if (isTypedText(window.Name))
            return;
        const ImRect inner = window.InnerRect;
        const float right = window.DC.CursorStartPos.x + window.Scroll.x + window.ContentSize.x,
                    below = window.DC.CursorStartPos.y + window.Scroll.y + window.ContentSize.y;
        if (right > inner.Max.x + kSlack && (window.Flags & ImGuiWindowFlags_HorizontalScrollbar) == 0)
            complain(window.Name, "its content is " + std::to_string(right - inner.Max.x) + " wider");
        if (below > inner.Max.y + kSlack && (window.Flags & ImGuiWindowFlags_NoScrollbar) != 0)
            complain(window.Name, "its content is " + std::to_string(below - inner.Max.y) + " higher");
        const ImVec2 display = ImGui::GetIO().DisplaySize;
        const bool outside = window.Pos.x < -kSlack || window.Pos.y < -kSlack ||
                             window.Pos.x + window.Size.x > display.x + kSlack ||
                             window.Pos.y + window.Size.y > display.y + kSlack;
        if (outside && (window.Flags & ImGuiWindowFlags_ChildWindow) == 0)
            complain(window.Name, "it reaches out of the window");
    }

    float smallest_;
    std::string owner_;
    bool scrolls_ = false; // the window up and down
    std::vector<Run> runs_;
    std::set<std::string> complaints_;
};

} // namespace

std::vector<std::string> auditText(float smallest) {
    return Audit(smallest).all();
}

} // namespace touchstone::test
