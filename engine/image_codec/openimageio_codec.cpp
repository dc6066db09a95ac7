// touchstone_images.so: images by OpenImageIO.

#include "engine/image/image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>

namespace touchstone {

namespace {

/// Storage format of the image, and its format in memory: 8 and 16 bit unchanged, everything else as float.
std::pair<ComponentType, OIIO::TypeDesc> keptAs(const OIIO::TypeDesc& stored) {
    if (stored.basetype == OIIO::TypeDesc::UINT8)
        return {ComponentType::U8, OIIO::TypeUInt8};
    if (stored.basetype == OIIO::TypeDesc::UINT16)
        return {ComponentType::U16, OIIO::TypeUInt16};
    return {ComponentType::F32, OIIO::TypeFloat};
}

OIIO::TypeDesc typeOf(ComponentType type) {
    return type == ComponentType::U8    ? OIIO::TypeUInt8
           : type == ComponentType::U16 ? OIIO::TypeUInt16
                                        : OIIO::TypeFloat;
}

std::string lastError(OIIO::ImageInput& input) {
    std::string text = input.geterror();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? "the data are broken" : text.substr(0, 200);
}

class OpenImageIoCodec final : public ImageCodec {
  public:
    DecodedImage decode(std::span<const uint8_t> encoded, const std::string& format, int maxSide,
                        bool headerOnly, const std::function<std::string(uint64_t)>& refusal) const override {
        DecodedImage image;
        const auto broken = [&](const std::string& why) {
            image.pixels = {};
            image.problem = why;
            return image;
        };
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

        if (spec.width < 1 || spec.height < 1 || spec.width > maxSide || spec.height > maxSide ||
            spec.depth > 1)
            return broken("its size of " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                          " pixels is beyond the limit of " + std::to_string(maxSide));
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
        if (std::string why = refusal(bytes); !why.empty())
            return broken(why);
        image.pixels.bytes.resize(bytes);
        if (!input->read_image(0, 0, 0, channels, read, image.pixels.bytes.data()))
            return broken(lastError(*input));
        return image;
    }

    EncodedImage encode(const ImageToEncode& image) const override {
        EncodedImage result;
        OIIO::Filesystem::IOVecOutput memory(result.bytes);
        const auto failed = [&](const std::string& why) { return EncodedImage{{}, why}; };
        const OIIO::TypeDesc type = typeOf(image.type);
        OIIO::ImageSpec spec(image.width, image.height, image.channels, type);
        for (const auto& [name, value] : image.numbers)
            spec.attribute(name, value);
        for (const auto& [name, value] : image.texts)
            spec.attribute(name, value);
        const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(image.format);
        if (!output || !output->supports("ioproxy")) {
            (void)OIIO::geterror();
            return failed("OpenImageIO has no " + image.format + " writer");
        }
        output->set_ioproxy(&memory);
        if (!output->open("picture." + image.format, spec) || !output->write_image(type, image.pixels) ||
            !output->close())
            return failed("the picture cannot be encoded: " + output->geterror());
        return result;
    }

    std::string readRows(const std::string& file, const std::function<std::string(const ImageSize&)>& refusal,
                         const std::function<void(int, const float*)>& row) const override {
        const auto input = OIIO::ImageInput::open(file);
        if (!input)
            return "cannot be read: " + OIIO::geterror().substr(0, 200);
        const OIIO::ImageSpec spec = input->spec();
        if (std::string why = refusal({spec.width, spec.height, spec.depth, spec.nchannels}); !why.empty())
            return why;
        const bool tiled = spec.tile_width > 0;
        const int rowsAtOnce =
            tiled ? std::clamp(spec.tile_height, 1, spec.height) : std::min(16, spec.height);
        const size_t length = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.nchannels);
        std::vector<float> rows(length * static_cast<size_t>(rowsAtOnce));
        for (int y = 0; y < spec.height; y += rowsAtOnce) {
            const int count = std::min(rowsAtOnce, spec.height - y), first = spec.y + y;
            const bool read =
                tiled ? input->read_tiles(0, 0, spec.x, spec.x + spec.width, first, first + count, 0, 1, 0,
                                          spec.nchannels, OIIO::TypeDesc::FLOAT, rows.data())
                      : input->read_scanlines(0, 0, first, first + count, 0, 0, spec.nchannels,
                                              OIIO::TypeDesc::FLOAT, rows.data());
            if (!read)
                return "is damaged: " + input->geterror().substr(0, 200);
            for (int i = 0; i < count; ++i)
                row(y + i, rows.data() + static_cast<size_t>(i) * length);
        }
        return {};
    }
};

} // namespace

} // namespace touchstone

extern "C" [[gnu::visibility("default")]] const touchstone::ImageCodec* touchstoneImageCodec() {
    static const touchstone::OpenImageIoCodec codec;
    return &codec;
}
