#pragma once
// Scene resolution apart from window size: as sharp as the frame budget allows. Pure arithmetic.

#include <glm/glm.hpp>

namespace touchstone {

/// Chooses the size of the scene image from how long frames take. Falls at once when frames are late, rises
/// slowly when there is room, and does not swing between two sizes: a rise that failed is tried again only
/// after a wait that doubles each time.
class AdaptiveResolution {
  public:
    struct Limits {
        double budget = 1.0 / 30.0; ///< s, from one frame to the next
        double headroom = 0.85;     ///< share of the budget that a frame may use before the image shrinks
        int largestPixels = 1920 * 1080; ///< of the scene image; software devices: about 800 * 450
        double smallestScale = 0.35;     ///< of the window; below it nothing can be recognised
    };
    explicit AdaptiveResolution(const Limits& limits) : limits_(limits) {}

    /// `busy`: s of work in the last frame (drawing and waiting for the device, without the pause to the next
    /// frame).
    void frameDone(double busy);
    /// Size of the scene image for an area of the window in pixels; multiples of 8, at least 16.
    [[nodiscard]] glm::ivec2 sceneSize(const glm::ivec2& area) const;
    [[nodiscard]] double scale() const {
        return scale_;
    } ///< linear, on top of `largestPixels`; smallestScale..1

  private:
    Limits limits_;
    double scale_ = 1.0;
    double smoothed_ = 0.0;
    int framesAtScale_ = 0;
    int framesToWait_ = 30;
    bool lastChangeWasRise_ = false;
};

} // namespace touchstone
