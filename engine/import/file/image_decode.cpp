#include "engine/import/file/image_decode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
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

/// Storage format of the image, and its format in memory: 8 and 16 bit unchanged, everything else as float.
std::pair<ComponentType, OIIO::TypeDesc> keptAs(const OIIO::TypeDesc& stored) {
    if (stored.basetype == OIIO::TypeDesc::UINT8)
        return {ComponentType::U8, OIIO::TypeUInt8};
    if (stored.basetype == OIIO::TypeDesc::UINT16)
        return {ComponentType::U16, OIIO::TypeUInt16};
    return {ComponentType::F32, OIIO::TypeFloat};
}

std::string lastError(OIIO::ImageInput& input) {
    std::string text = input.geterror();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? "the data are broken" : text.substr(0, 200);
}

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

    const auto input = OIIO::ImageInput::create(format);
    if (!input) {
        (void)OIIO::geterror();
        return broken("this installation cannot read " + format);
    }
    OIIO::Filesystem::IOMemReader memory(encoded.data(), encoded.size());
    if (!input->set_ioproxy(&memory))
        return broken(format + " images cannot be read out of memory");
    OIIO::ImageSpec asStored, spec;
    asStored["oiio:UnassociatedAlpha"] = 1;
    if (!input->open("image." + format, spec, asStored))
        return broken(lastError(*input));

    if (spec.width < 1 || spec.height < 1 || spec.width > kMaxImageSide || spec.height > kMaxImageSide ||
        spec.depth > 1)
        return broken("its size of " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                      " pixels is beyond the limit of " + std::to_string(kMaxImageSide));
    const auto [type, read] = keptAs(spec.format);
    const int channels = std::min(spec.nchannels, 4);
    image.pixels.width = spec.width;
    image.pixels.height = spec.height;
    image.pixels.channels = channels;
    image.pixels.type = type;
    if (headerOnly)
        return image;

    // All factors are bounded above: 2^14 * 2^14 * 4 * 4.
    const uint64_t bytes = static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.height) *
                           static_cast<uint64_t>(channels) * read.size();
    if (!mayTake(bytes))
        return broken(kTooManyPixels);
    decodes.fetch_add(1, std::memory_order_relaxed);
    image.pixels.bytes.resize(bytes);
    if (!input->read_image(0, 0, 0, channels, read, image.pixels.bytes.data()))
        return broken(lastError(*input));
    return image;
}

} // namespace touchstone
