#pragma once
// Images encoded as a file would hold them.

#include "tests/support/gltf_maker.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace touchstone::test {

/// Pixels written with OpenImageIO into a file of the given name and read back as bytes.
template <class T>
std::vector<uint8_t> encodedImage(const std::string& name, int width, int height, int channels,
                                  const std::vector<T>& values) {
    TemporaryFolder folder;
    const std::string path = (folder.path() / name).string();
    const auto output = OIIO::ImageOutput::create(path);
    if (!output) {
        ADD_FAILURE() << OIIO::geterror();
        return {};
    }
    OIIO::ImageSpec spec(width, height, channels, OIIO::BaseTypeFromC<T>::value);
    spec["oiio:UnassociatedAlpha"] = 1;
    EXPECT_TRUE(output->open(path, spec) &&
                output->write_image(OIIO::BaseTypeFromC<T>::value, values.data()) && output->close())
        << output->geterror();
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

} // namespace touchstone::test
