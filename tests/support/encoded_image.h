#pragma once
// Images encoded as a file would hold them.

#include "engine/image/image_codec.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone::test {

/// Pixels as the bytes of a file of this name; its ending gives the format.
template <class T>
std::vector<uint8_t> encodedImage(const std::string& name, int width, int height, int channels,
                                  const std::vector<T>& values) {
    const std::string ending = name.substr(name.rfind('.') + 1);
    const std::string format = ending == "jpg"   ? "jpeg"
                               : ending == "exr" ? "openexr"
                               : ending == "tif" ? "tiff"
                                                 : ending;
    std::string problem;
    const ImageCodec* codec = imageCodec(problem);
    if (codec == nullptr) {
        ADD_FAILURE() << problem;
        return {};
    }
    EncodedImage image = codec->encode({.format = format,
                                        .width = width,
                                        .height = height,
                                        .channels = channels,
                                        .type = sizeof(T) == 1   ? ComponentType::U8
                                                : sizeof(T) == 2 ? ComponentType::U16
                                                                 : ComponentType::F32,
                                        .pixels = values.data(),
                                        .numbers = {{"oiio:UnassociatedAlpha", 1}},
                                        .texts = {}});
    EXPECT_EQ(image.problem, "");
    return std::move(image.bytes);
}

} // namespace touchstone::test
