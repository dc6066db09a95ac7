#include "renderer/picture_file.h"

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "engine/image/image_codec.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

namespace touchstone {

namespace {

struct PictureFormat {
    std::string_view ending, writer; ///< of OpenImageIO
    bool opaque;                     ///< 8 bit without alpha
};
constexpr std::array kFormats{PictureFormat{".png", "png", false}, PictureFormat{".jpg", "jpeg", true},
                              PictureFormat{".jpeg", "jpeg", true}};
constexpr const char* kRemedy = "end its name in .png, .jpg or .jpeg";

const PictureFormat* formatOf(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto* found = std::ranges::find(kFormats, ending, &PictureFormat::ending);
    return found != kFormats.end() ? found : nullptr;
}

std::vector<std::byte> withoutAlpha(const PixelData& pixels) {
    std::vector<std::byte> rgb;
    const auto channels = static_cast<size_t>(pixels.channels);
    rgb.reserve(pixels.bytes.size() / channels * 3);
    for (size_t at = 0; at < pixels.bytes.size(); at += channels)
        for (size_t c = 0; c < 3; ++c)
            rgb.push_back(pixels.bytes[at + std::min(c, channels >= 3 ? c : 0)]);
    return rgb;
}

/// The bytes of the file. In memory, so that one place writes files and cleans up behind itself.
std::vector<unsigned char> encoded(const std::filesystem::path& file, const PictureFormat& format,
                                   const PixelData& pixels) {
    std::string problem;
    const ImageCodec* codec = imageCodec(problem);
    if (codec == nullptr)
        throw Error(file.string(), "", problem, "");
    const std::vector<std::byte> rgb = format.opaque ? withoutAlpha(pixels) : std::vector<std::byte>();
    ImageToEncode image{.format = std::string(format.writer),
                        .width = pixels.width,
                        .height = pixels.height,
                        .channels = format.opaque ? 3 : pixels.channels,
                        .type = pixels.type,
                        .pixels = format.opaque ? rgb.data() : pixels.bytes.data(),
                        // Alpha is straight; without this attribute the writer would divide by it.
                        .numbers = {{"oiio:UnassociatedAlpha", 1}, {"png:compressionLevel", 6}},
                        .texts = {{"oiio:ColorSpace", "sRGB"}}};
    if (format.opaque)
        image.texts.emplace_back("Compression", "jpeg:95");
    EncodedImage result = codec->encode(image);
    if (!result.problem.empty())
        throw Error(file.string(), "", result.problem, "");
    return std::move(result.bytes);
}

} // namespace

std::string pictureNameProblem(const std::filesystem::path& file) {
    return formatOf(file) != nullptr ? std::string()
                                     : "'" + file.filename().string() + "' names no picture: " + kRemedy;
}

void writePicture(const std::filesystem::path& file, const PixelData& pixels) {
    const PictureFormat* format = formatOf(file);
    if (format == nullptr)
        throw Error(file.string(), "", "its ending names no picture", kRemedy);
    if (pixels.width <= 0 || pixels.height <= 0 || pixels.type == ComponentType::F32 ||
        (format->opaque && pixels.type != ComponentType::U8))
        throw Error(file.string(), "", "there is no picture to write that its format holds", "");
    // Encoded first: a process that is ended meanwhile leaves nothing.
    const std::vector<unsigned char> bytes = encoded(file, *format, pixels);
    OutputFile output(file);
    output.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    output.commit();
}

} // namespace touchstone
