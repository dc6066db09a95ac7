#pragma once

#include <string>

namespace touchstone {

/// The user's choice of sound.
struct SoundChoice {
    bool on = false;
    float volume = 0.5f; ///< 0..1 of the slider
    bool operator==(const SoundChoice&) const = default;

    /// Fraction of full scale that is never exceeded: equal steps of the slider sound equal.
    [[nodiscard]] float level() const { return volume * volume; }
};

/// State of the sound.
struct SoundStatus {
    const char* state = "off"; ///< "off", "opening", "playing", "failed"
    std::string problem;       ///< with its remedy, while it failed
    std::string card;          ///< its name, while it plays
    double latency = 0.0;      ///< s from a tick to the sound
    float peak = 0.0f;         ///< 0..1, of the latest block
    unsigned long runsDry = 0, leftOut = 0;
};

} // namespace touchstone
