#include "renderer/picture_file.h"

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "engine/image/image_codec.h"
#include "renderer/png_encoding.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

namespace touchstone {

namespace {

struct PictureFormat {
    std::string_view ending;
    bool jpeg; ///< 8 bit without alpha; else PNG
};
constexpr std::array kFormats{PictureFormat{".png", false}, PictureFormat{".jpg", true},
                              PictureFormat{".jpeg", true}};
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

std::vector<unsigned char> encodeJpeg(const std::filesystem::path& file, const PixelData& pixels) {
    std::string problem;
    const ImageCodec* codec = imageCodec(problem);
    if (codec == nullptr)
        throw Error(file.string(), "", problem, "");
    const std::vector<std::byte> rgb = withoutAlpha(pixels);
    EncodedImage result = codec->encode({.format = "jpeg",
                                         .width = pixels.width,
                                         .height = pixels.height,
                                         .channels = 3,
                                         .type = pixels.type,
                                         .pixels = rgb.data(),
                                         .numbers = {},
                                         .texts = {{"oiio:ColorSpace", "sRGB"}, {"Compression", "jpeg:95"}}});
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
    if (pixels.width <= 0 || pixels.height <= 0 || pixels.bytes.empty() || pixels.channels < 1 ||
        pixels.channels > 4 || pixels.type == ComponentType::F32 ||
        (format->jpeg && pixels.type != ComponentType::U8))
        throw Error(file.string(), "", "there is no picture to write that its format holds", "");
    // Encoded first: a process that is ended meanwhile leaves nothing.
    const std::vector<unsigned char> bytes = format->jpeg ? encodeJpeg(file, pixels) : encodePng(pixels);
    if (bytes.empty())
        throw Error(file.string(), "", "it is too large a picture for the memory or for PNG",
                    "choose a smaller size");
    OutputFile output(file);
    output.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    output.commit();
}

} // namespace touchstone
