#include "tests/support/picture.h"

#include "engine/import/file/image_decode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

namespace touchstone::test {

PixelData readPicture(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
    DecodedImage image = decodeImage(bytes, false, [](uint64_t) { return true; });
    if (!image.problem.empty())
        ADD_FAILURE() << "cannot read " << file << ": " << image.problem;
    return std::move(image.pixels);
}

double failingShare(const PixelData& a, const PixelData& b) {
    if (a.width != b.width || a.height != b.height || a.channels != b.channels || a.bytes.empty() ||
        b.bytes.empty())
        return 1.0;
    size_t failing = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            bool fails = false;
            for (int c = 0; c < a.channels; ++c)
                fails = fails || std::abs(a.value(x, y, c) - b.value(x, y, c)) > kPixelTolerance;
            failing += fails ? 1 : 0;
        }
    return static_cast<double>(failing) / (static_cast<double>(a.width) * a.height);
}

double meanDifference(const PixelData& a, const PixelData& b, int channels) {
    if (a.width != b.width || a.height != b.height || std::min(a.channels, b.channels) < channels ||
        a.bytes.empty() || b.bytes.empty()) {
        ADD_FAILURE() << "these are no pictures of one size";
        return 1.0;
    }
    double sum = 0.0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (int c = 0; c < channels; ++c)
                sum += static_cast<double>(std::abs(a.value(x, y, c) - b.value(x, y, c)));
    return sum / (static_cast<double>(a.width) * a.height * channels);
}

} // namespace touchstone::test
