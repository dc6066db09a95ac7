#pragma once
// What the panels are made of. Main thread, within an ImGui frame.

#include <map>
#include <string>

namespace touchstone {

/// Where a widget is on the window, in its coordinates from the upper left corner.
struct WidgetRect {
    float x = 0.0f, y = 0.0f, width = 0.0f, height = 0.0f;
};

/// Where the widgets of a frame are, by name: for scripts and tests (`--status-json`).
class Widgets {
  public:
    /// `scale`: window coordinates for one unit of the layout.
    explicit Widgets(float scale) : scale_(scale) {}

    [[nodiscard]] float scale() const { return scale_; }
    [[nodiscard]] float units(float n) const { return n * scale_; }
    /// Notes where the last widget is.
    void mark(const char* name);
    [[nodiscard]] const std::map<std::string, WidgetRect>& rects() const { return rects_; }
    [[nodiscard]] std::map<std::string, WidgetRect> take() { return std::move(rects_); }

  private:
    float scale_;
    std::map<std::string, WidgetRect> rects_;
};

} // namespace touchstone
