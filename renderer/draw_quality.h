#pragma once
// Adapts the picture quality to the frame time. Pure arithmetic.

#include <glm/glm.hpp>

namespace touchstone {

/// Chooses the size of the scene image and the error of simplified meshes together, from the frame times.
/// Quality falls at once when frames are late, rises slowly when there is time left, and does not oscillate:
/// a failed rise is reverted, and repeated only after a wait that doubles each time. Where frames stay late
/// at the lowest quality, the highest is tried: if it costs little more, it is kept, since the time goes
/// elsewhere.
class DrawQuality {
  public:
    struct Limits {
        double budget = 1.0 / 30.0;      ///< s, between frames
        double headroom = 0.85;          ///< fraction of the budget above which quality falls
        int largestPixels = 1920 * 1080; ///< of the scene image; software devices: about 800 * 450
        double smallestScale = 0.35;     ///< of the window; a smaller picture is unrecognisable
        double finestError = 0.0, coarsestError = 1.5; ///< pixels of the scene image
    };
    explicit DrawQuality(const Limits& limits) : limits_(limits) {}

    /// `busy`: s of device time or of the drawing thread's time for the last frame, whichever is larger,
    /// without the pause to the next frame.
    void frameDone(double busy);
    /// Size of the scene image for a window area in pixels; multiples of 8, at least 16.
    [[nodiscard]] glm::ivec2 sceneSize(const glm::ivec2& area) const;
    /// Error of simplified meshes, pixels of the scene image (View::allowedError).
    [[nodiscard]] double allowedError() const;
    /// 1: the largest image and the smallest error; 0: the other ends.
    [[nodiscard]] double quality() const { return quality_; }
    /// Linear factor on `largestPixels`: smallestScale..1.
    [[nodiscard]] double scale() const { return scaleAt(quality_); }

  private:
    static constexpr int kFirstWait = 30; ///< frames at constant quality before a rise: one second at 30 Hz
    static constexpr int kFirstTolerance = 240; ///< late frames at the highest quality before it falls again

    [[nodiscard]] double scaleAt(double quality) const {
        return limits_.smallestScale + (1.0 - limits_.smallestScale) * quality;
    }
    void fall(double excess);
    void rise(double allowed);
    void tryHighest();
    void judgeHighest();
    [[nodiscard]] bool toleratesLateFrames() const;
    void setQuality(double quality);

    Limits limits_;
    double quality_ = 1.0;
    double beforeRise_ = 1.0; ///< quality before the last rise
    double smoothed_ = 0.0;
    int framesAtQuality_ = 0;
    int framesToWait_ = kFirstWait;
    bool lastChangeWasRise_ = false;
    // The highest quality against the lowest, where both are late.
    bool tryingHighest_ = false;
    int framesTooSlow_ = 0;     ///< in a row, of the trial
    double timeAtLowest_ = 0.0; ///< s, smoothed, when the trial began
    double tolerated_ = 0.0; ///< s, smoothed, at the highest quality, where the lowest saves little; 0: never
    int framesToTrial_ = kFirstWait;
    int framesTolerated_ = kFirstTolerance;
};

} // namespace touchstone
