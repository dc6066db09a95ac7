#pragma once
// Building blocks of the panels. Main thread, within an ImGui frame.

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace touchstone {

/// Rectangle of a widget in window coordinates, from the upper left corner, and the text of its tooltip.
struct WidgetRect {
    float x = 0.0f, y = 0.0f, width = 0.0f, height = 0.0f;
    std::string note{};
};

/// The widget under the pointer, from frame to frame: its tooltip appears when the pointer has rested on it.
struct HoveredWidget {
    std::string name;
    double since = 0.0; ///< s, ImGui's time
    int frame = -1;     ///< the last one in which it was hovered
    std::string shown;  ///< text of the tooltip in that frame; empty: none yet
};

struct SliderRange {
    float low, high;
    bool logarithmic = false; ///< low > 0
    bool clamp = false;       ///< typed values, too
};

/// Rectangles of a frame's widgets by name: for tooltips, scripts and tests (`--status-json`).
class Widgets {
  public:
    /// `scale`: window coordinates per layout unit. `hovered`: null: no tooltips.
    explicit Widgets(float scale, HoveredWidget* hovered = nullptr) : scale_(scale), hovered_(hovered) {}

    [[nodiscard]] float units(float n) const { return n * scale_; }
    /// Records the rectangle of the last widget, the one with keyboard focus also as "focused", and shows its
    /// tooltip: `note`, else the text of panels/notes.h.
    void mark(const char* name, std::string_view note = {});
    void place(const char* name, const WidgetRect& rect) { rects_[name] = rect; }
    [[nodiscard]] std::map<std::string, WidgetRect> take() { return std::move(rects_); }

    void section(const char* title) const;
    /// The next widget, `width` wide, goes on the same line where it fits. `end`: width kept free at the end
    /// of the line.
    void beside(float width, float end = 0.0f) const;
    /// The same in the first line of a panel, whose end is the arrow that folds it.
    void besideArrow(float width) const;
    /// Text in lines of the available width, broken between words only: ImGui also breaks behind points and
    /// commas, in the middle of a number. `color`: ImU32; 0: that of text.
    void wrapped(std::string_view text, unsigned color = 0) const;
    /// Whether the last widget is dragged, or was let go in this frame after a move: a slow frame may have
    /// the last way of the pointer together with its release.
    [[nodiscard]] static bool dragged();
    /// Of a button with this label.
    [[nodiscard]] static float buttonWidth(const char* label);
    [[nodiscard]] float lampWidth(const char* label) const;

    /// A button, a checkbox; mark `name`. True where it was pressed.
    bool button(const char* name, const char* label, std::string_view note = {});
    bool check(const char* name, const char* label, bool& on);
    /// As wide as the window; marks `name`. True where the choice changed.
    bool combo(const char* name, int& chosen, std::span<const char* const> labels);
    /// A button with a lamp, lit in `color` (ImU32) while `on`; marks `name`. `widest`: a label for which it
    /// has room, where its own changes and nothing beside it must move. True where it was pressed.
    bool lampButton(const char* name, const char* label, bool on, unsigned color, const char* widest = "",
                    std::string_view note = {});
    /// A bar filled up to the value, with `label` at its left and `shown`, the value as text, at its right:
    /// nothing lies over the number. As wide as the next item; Ctrl + click types a value. Marks `name`. True
    /// where the value changed.
    bool slider(const char* name, const char* label, float& value, const SliderRange& range,
                const std::string& shown, std::string_view note = {});

  private:
    void hover(const char* name, const std::string& note);

    float scale_;
    HoveredWidget* hovered_;
    std::map<std::string, WidgetRect> rects_;
};

/// `text` with line breaks so that no line is wider than `width` window coordinates in the current font.
/// Lines break at spaces; a longer word (a path) breaks anywhere.
[[nodiscard]] std::string brokenLines(std::string_view text, float width);

/// `text`, or as much of its beginning as fits with an ellipsis into `width` window coordinates.
[[nodiscard]] std::string shortened(std::string_view text, float width);

/// Tooltip of wrapped text over the last widget. Nothing for an empty text.
void showNote(std::string_view text);

} // namespace touchstone
