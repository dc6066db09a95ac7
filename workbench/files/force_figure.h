#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace touchstone {

/// Force and depth over time, one curve for each of several touches of the same path. One thread.
class ForceFigure {
  public:
    /// `titles`: of the touches, at least one.
    explicit ForceFigure(std::vector<std::string> titles);

    /// A tick: the first touch by `begin`, each further one by `add`, in order. `force`: N; `depth`: from the
    /// HIP to the proxy, m; `seconds`: not before those of the tick before.
    void begin(double seconds, double force, double depth);
    void add(double force, double depth);

    /// By gnuplot, as SVG or PNG by the file's ending; script and data stay beside it. Of many ticks the
    /// least and the most of each of 1500 intervals are drawn: no peak is lost. Throws Error where there are
    /// fewer than two ticks, or gnuplot does not draw.
    void draw(const std::filesystem::path& file, const std::string& subtitle) const;

  private:
    struct Touch {
        std::string title;
        std::vector<float> force, depth; ///< N, mm
    };
    [[nodiscard]] std::string data() const;

    std::vector<Touch> touches_;
    std::vector<double> seconds_;
    size_t next_ = 0; ///< the touch that `add` is about
};

} // namespace touchstone
