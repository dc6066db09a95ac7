#include "renderer/png.h"

#include "engine/core/error.h"

#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <system_error>

namespace touchstone {

void writePng(const std::filesystem::path& file, const PixelData& pixels) {
    if (pixels.width <= 0 || pixels.height <= 0 || pixels.type == ComponentType::F32)
        throw Error(file.string(), "", "there is no 8 or 16 bit picture to write", "");
    // The file extension selects the format, so the temporary name keeps ".png".
    std::filesystem::path temporary = file;
    temporary.replace_filename(file.stem().string() + ".part-" + std::to_string(::getpid()) + ".png");
    const OIIO::TypeDesc type =
        pixels.type == ComponentType::U8 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16;
    OIIO::ImageSpec spec(pixels.width, pixels.height, pixels.channels, type);
    spec.attribute("oiio:ColorSpace", "sRGB");
    // Alpha is straight; without this attribute the writer would divide by it.
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("png:compressionLevel", 6);
    const auto failed = [&](const std::string& why) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw Error(file.string(), "", "the picture cannot be written: " + why,
                    "check that the folder exists, is writable and has room");
    };
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("png");
    if (!output)
        failed("OpenImageIO has no PNG writer: " + OIIO::geterror());
    if (!output->open(temporary.string(), spec))
        failed(output->geterror());
    if (!output->write_image(type, pixels.bytes.data()))
        failed(output->geterror());
    if (!output->close())
        failed(output->geterror());
    std::error_code problem;
    std::filesystem::rename(temporary, file, problem);
    if (problem)
        failed(problem.message());
}

} // namespace touchstone
