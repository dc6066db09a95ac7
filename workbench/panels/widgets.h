#pragma once
// Building blocks of the panels. Main thread, within an ImGui frame.

#include <map>
#include <span>
#include <string>
#include <utility>

namespace touchstone {

/// Rectangle of a widget in window coordinates, from the upper left corner.
struct WidgetRect {
    float x = 0.0f, y = 0.0f, width = 0.0f, height = 0.0f;
};

/// Rectangles of a frame's widgets by name: for scripts and tests (`--status-json`).
class Widgets {
  public:
    /// `scale`: window coordinates per layout unit.
    explicit Widgets(float scale) : scale_(scale) {}

    [[nodiscard]] float units(float n) const { return n * scale_; }
    /// Records the rectangle of the last widget; the one with keyboard focus also as "focused".
    void mark(const char* name);
    void place(const char* name, const WidgetRect& rect) { rects_[name] = rect; }
    [[nodiscard]] std::map<std::string, WidgetRect> take() { return std::move(rects_); }

    void section(const char* title) const;
    /// As wide as the window; marks `name`. True where the choice changed.
    bool combo(const char* name, int& chosen, std::span<const char* const> labels);
    /// A button with a lamp, lit in `color` (ImU32) while `on`; marks `name`. True where it was pressed.
    bool lampButton(const char* name, const char* label, bool on, unsigned color);

  private:
    float scale_;
    std::map<std::string, WidgetRect> rects_;
};

} // namespace touchstone
