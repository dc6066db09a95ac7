#include "renderer/picture_file.h"

#include "engine/core/error.h"
#include "engine/core/output_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

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
    const bool bytes = pixels.type == ComponentType::U8;
    const OIIO::TypeDesc type = bytes ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16;
    const std::vector<std::byte> rgb = format.opaque ? withoutAlpha(pixels) : std::vector<std::byte>();
    OIIO::ImageSpec spec(pixels.width, pixels.height, format.opaque ? 3 : pixels.channels, type);
    spec.attribute("oiio:ColorSpace", "sRGB");
    // Alpha is straight; without this attribute the writer would divide by it.
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("png:compressionLevel", 6);
    if (format.opaque)
        spec.attribute("Compression", "jpeg:95");
    std::vector<unsigned char> result;
    OIIO::Filesystem::IOVecOutput memory(result);
    const std::string writer(format.writer);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(writer);
    if (!output || !output->supports("ioproxy"))
        throw Error(file.string(), "", "OpenImageIO has no " + writer + " writer", "");
    output->set_ioproxy(&memory);
    const std::string name = "picture" + std::string(format.ending);
    if (!output->open(name, spec) ||
        !output->write_image(type, format.opaque ? rgb.data() : pixels.bytes.data()) || !output->close())
        throw Error(file.string(), "", "the picture cannot be encoded: " + output->geterror(), "");
    return result;
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
