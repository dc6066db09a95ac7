// Reads panoramas from files.

#include "engine/core/error.h"
#include "renderer/environment.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

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

void checkSize(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
    const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height) + " texels";
    if (spec.width > kLargestSide || spec.height > kLargestSide / 2)
        fail(file, "the environment has " + size + ", which is too large");
    if (spec.width < 4 || spec.height < 2 || std::abs(spec.width - 2 * spec.height) > 2 || spec.depth > 1)
        fail(file, "the environment has " + size + ", which is no panorama");
    if (spec.nchannels < 1 || spec.nchannels > 64)
        fail(file, "the environment has " + std::to_string(spec.nchannels) + " channels");
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
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input)
        fail(file, "the environment cannot be read: " + OIIO::geterror().substr(0, 200));
    const OIIO::ImageSpec spec = input->spec();
    checkSize(file, spec);
    const bool tiled = spec.tile_width > 0;
    const int rowsAtOnce = tiled ? std::clamp(spec.tile_height, 1, spec.height) : std::min(16, spec.height);
    Reducer reducer(spec.width, spec.height, spec.nchannels);
    const size_t row = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.nchannels);
    std::vector<float> rows(row * static_cast<size_t>(rowsAtOnce));
    for (int y = 0; y < spec.height; y += rowsAtOnce) {
        const int count = std::min(rowsAtOnce, spec.height - y), first = spec.y + y;
        const bool read = tiled
                              ? input->read_tiles(0, 0, spec.x, spec.x + spec.width, first, first + count, 0,
                                                  1, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, rows.data())
                              : input->read_scanlines(0, 0, first, first + count, 0, 0, spec.nchannels,
                                                      OIIO::TypeDesc::FLOAT, rows.data());
        if (!read)
            fail(file, "the environment is damaged: " + input->geterror().substr(0, 200));
        for (int i = 0; i < count; ++i)
            reducer.add(y + i, rows.data() + static_cast<size_t>(i) * row);
    }
    return reducer.take();
}

} // namespace touchstone
