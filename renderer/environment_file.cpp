// Reads panoramas from files.

#include "engine/core/error.h"
#include "engine/image/image_codec.h"
#include "renderer/environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

namespace touchstone {

namespace {

constexpr int kLargestSide = 16384;
constexpr int kReducedWidth = 1024;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& problem) {
    throw Error(file.string(), "", problem,
                "give an OpenEXR or Radiance panorama, twice as wide as high, of up to 16384 x 8192 texels");
}

/// OpenEXR or Radiance by the first bytes: no other OpenImageIO reader opens the file.
bool isPanoramaFormat(const std::filesystem::path& file) {
    std::array<unsigned char, 4> magic{};
    std::FILE* stream = std::fopen(file.c_str(), "rb");
    if (stream == nullptr)
        fail(file, "the environment file cannot be opened");
    const size_t count = std::fread(magic.data(), 1, magic.size(), stream);
    std::fclose(stream);
    const bool exr = magic == std::array<unsigned char, 4>{0x76, 0x2f, 0x31, 0x01};
    const bool radiance = magic[0] == '#' && magic[1] == '?';
    return count == magic.size() && (exr || radiance);
}

/// What is wrong with the size; empty: nothing.
std::string refusalOf(const ImageSize& is) {
    const std::string size = std::to_string(is.width) + " x " + std::to_string(is.height) + " texels";
    if (is.width > kLargestSide || is.height > kLargestSide / 2)
        return "has " + size + ", which is too large";
    if (is.width < 4 || is.height < 2 || std::abs(is.width - 2 * is.height) > 2 || is.depth > 1)
        return "has " + size + ", which is no panorama";
    if (is.channels < 1 || is.channels > 64)
        return "has " + std::to_string(is.channels) + " channels";
    return {};
}

/// Averages blocks of `factor` x `factor` texels, row by row.
class Reducer {
  public:
    Reducer(int width, int height, int channels)
        : factor_(std::max(1, (width + kReducedWidth - 1) / kReducedWidth)), channels_(channels),
          rows_(height / factor_) {
        panorama_.width = width / factor_;
        panorama_.height = rows_;
        panorama_.texels.assign(static_cast<size_t>(panorama_.width) * static_cast<size_t>(rows_),
                                glm::vec3(0.0f));
    }

    void add(int row, const float* texels) {
        const int to = row / factor_;
        if (to >= rows_)
            return; // remainder of a size that is no multiple
        const float share = 1.0f / static_cast<float>(factor_ * factor_);
        for (int x = 0; x < panorama_.width * factor_; ++x) {
            const float* texel = texels + static_cast<size_t>(x) * static_cast<size_t>(channels_);
            glm::vec3& sum = panorama_.texels[static_cast<size_t>(to) * static_cast<size_t>(panorama_.width) +
                                              static_cast<size_t>(x / factor_)];
            for (int c = 0; c < 3; ++c) {
                const float value = texel[channels_ >= 3 ? c : 0];
                // Above the radiance of a sun, a float sum would lose the other values.
                sum[c] += std::isfinite(value) && value > 0.0f ? share * std::min(value, 1e6f) : 0.0f;
            }
        }
    }

    Panorama take() { return std::move(panorama_); }

  private:
    int factor_, channels_, rows_;
    Panorama panorama_;
};

} // namespace

Panorama readPanorama(const std::filesystem::path& file) {
    if (!isPanoramaFormat(file))
        fail(file, "the environment is neither OpenEXR nor Radiance");
    std::string problem;
    const ImageCodec* codec = imageCodec(problem);
    if (codec == nullptr)
        fail(file, problem);
    std::optional<Reducer> reducer;
    problem = codec->readRows(
        file.string(),
        [&](const ImageSize& size) {
            std::string refusal = refusalOf(size);
            if (refusal.empty())
                reducer.emplace(size.width, size.height, size.channels);
            return refusal;
        },
        [&](int row, const float* texels) { reducer->add(row, texels); });
    if (!problem.empty())
        fail(file, "the environment " + problem);
    return reducer->take();
}

} // namespace touchstone
