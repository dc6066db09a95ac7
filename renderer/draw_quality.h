#pragma once
// As good a picture as the time of a frame allows. Pure arithmetic.

#include <glm/glm.hpp>

namespace touchstone {

/// Chooses how large the scene image is and by how much simplified meshes may differ in it, both together,
/// from how long frames take. Falls at once when frames are late, rises slowly when there is room, and does
/// not swing: a rise that failed is taken back, and tried again only after a wait that doubles each time.
class DrawQuality {
  public:
    struct Limits {
        double budget = 1.0 / 30.0; ///< s, from one frame to the next
        double headroom = 0.85; ///< share of the budget that a frame may use before the picture gets worse
        int largestPixels = 1920 * 1080; ///< of the scene image; software devices: about 800 * 450
        double smallestScale = 0.35;     ///< of the window; below it nothing can be recognised
        double finestError = 0.0, coarsestError = 1.5; ///< pixels of the scene image
    };
    explicit DrawQuality(const Limits& limits) : limits_(limits) {}

    /// `busy`: s that the last frame took of the device or of the thread that draws, whichever is more,
    /// without the pause to the next frame.
    void frameDone(double busy);
    /// Size of the scene image for an area of the window in pixels; multiples of 8, at least 16.
    [[nodiscard]] glm::ivec2 sceneSize(const glm::ivec2& area) const;
    /// By how much simplified meshes may differ, pixels of the scene image (View::allowedError).
    [[nodiscard]] double allowedError() const;
    /// 1: the largest image and the least error, 0: the other ends.
    [[nodiscard]] double quality() const { return quality_; }
    /// Linear, on top of `largestPixels`: smallestScale..1.
    [[nodiscard]] double scale() const { return scaleAt(quality_); }

  private:
    [[nodiscard]] double scaleAt(double quality) const {
        return limits_.smallestScale + (1.0 - limits_.smallestScale) * quality;
    }
    void fall(double excess);
    void rise(double allowed);

    Limits limits_;
    double quality_ = 1.0;
    double beforeRise_ = 1.0; ///< quality from which the last rise began
    double smoothed_ = 0.0;
    int framesAtQuality_ = 0;
    int framesToWait_ = 30;
    bool lastChangeWasRise_ = false;
};

} // namespace touchstone
