#pragma once
// What the program knows of touchstone_images.so, the one part that links OpenImageIO: 260 shared libraries,
// 0.2 s of every start, which a model without images does not need.

#include "engine/scene/image.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {

struct DecodedImage {
    PixelData pixels;    ///< empty when `problem` is set
    std::string problem; ///< why there are no pixels, as the end of a sentence
};

/// An image to be encoded: its pixels, rows from the top, as `type` holds them.
struct ImageToEncode {
    std::string format; ///< of OpenImageIO: "png", "jpeg", "webp", "tiff", "openexr", "hdr"
    int width = 0, height = 0, channels = 0;
    ComponentType type = ComponentType::U8;
    const void* pixels = nullptr;
    std::vector<std::pair<std::string, int>> numbers; ///< attributes of OpenImageIO
    std::vector<std::pair<std::string, std::string>> texts;
};

struct EncodedImage {
    std::vector<unsigned char> bytes; ///< of the file; empty when `problem` is set
    std::string problem;
};

/// The size of an image by its header.
struct ImageSize {
    int width = 0, height = 0, depth = 0, channels = 0;
};

/// Implemented in the library. Every function may be called on any thread; none throws for broken input.
class ImageCodec {
  public:
    virtual ~ImageCodec() = default;

    /// decodeImage of engine/import/file/image_decode.h, of a known format.
    [[nodiscard]] virtual DecodedImage decode(std::span<const uint8_t> encoded, const std::string& format,
                                              int maxSide, bool headerOnly,
                                              const std::function<std::string(uint64_t)>& refusal) const = 0;
    [[nodiscard]] virtual EncodedImage encode(const ImageToEncode& image) const = 0;
    /// Reads a file row by row: `refusal` of its size, empty to go on, then each row from the top as floats,
    /// all channels interleaved. Returns the problem; empty: none.
    [[nodiscard]] virtual std::string readRows(const std::string& file,
                                               const std::function<std::string(const ImageSize&)>& refusal,
                                               const std::function<void(int, const float*)>& row) const = 0;
};

/// Loads the library at its first call. Null: it cannot be loaded; `problem` then says why. Any thread but
/// the servo's.
[[nodiscard]] const ImageCodec* imageCodec(std::string& problem);

/// The name of the function that the library exports: `const ImageCodec* touchstoneImageCodec()`.
inline constexpr const char* kImageCodecSymbol = "touchstoneImageCodec";

} // namespace touchstone
