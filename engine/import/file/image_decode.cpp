#include "engine/import/file/image_decode.h"

#include <atomic>
#include <cstring>
#include <string_view>

namespace touchstone {
namespace {

using namespace std::string_view_literals;

bool startsWith(ByteSpan bytes, std::string_view magic, size_t at = 0) {
    return bytes.size() >= at + magic.size() &&
           std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
}

std::atomic<uint64_t> decodes{0};

} // namespace

uint64_t imageDecodes() noexcept {
    return decodes.load(std::memory_order_relaxed);
}

std::string sniffImageFormat(ByteSpan bytes) {
    if (startsWith(bytes, "\x89PNG\r\n\x1a\n"sv))
        return "png";
    if (startsWith(bytes, "\xFF\xD8\xFF"sv))
        return "jpeg";
    if (startsWith(bytes, "RIFF"sv) && startsWith(bytes, "WEBP"sv, 8))
        return "webp";
    if (startsWith(bytes, "II*\0"sv) || startsWith(bytes, "MM\0*"sv))
        return "tiff";
    if (startsWith(bytes, "\x76\x2f\x31\x01"sv))
        return "openexr";
    if (startsWith(bytes, "#?RADIANCE"sv) || startsWith(bytes, "#?RGBE"sv))
        return "hdr";
    return "";
}

DecodedImage decodeImage(ByteSpan encoded, bool headerOnly, const std::function<bool(uint64_t)>& mayTake) {
    DecodedImage image;
    const auto broken = [&](const std::string& why) {
        image.pixels = {};
        image.problem = why;
        return image;
    };
    const std::string format = sniffImageFormat(encoded);
    if (format.empty())
        return broken("its format is not known (PNG, JPEG, WebP, TIFF, OpenEXR and HDR are)");

    std::string missing;
    const ImageCodec* codec = imageCodec(missing);
    if (codec == nullptr)
        return broken(missing);
    return codec->decode(encoded, format, kMaxImageSide, headerOnly, [&](uint64_t bytes) {
        if (!mayTake(bytes))
            return std::string(kTooManyPixels);
        decodes.fetch_add(1, std::memory_order_relaxed);
        return std::string();
    });
}

} // namespace touchstone
