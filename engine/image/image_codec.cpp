#include "engine/image/image_codec.h"

#include "engine/process/loaded_module.h"

namespace touchstone {

namespace {

struct Loaded {
    const ImageCodec* codec = nullptr;
    std::string problem;
};

Loaded load() {
    std::string why;
    void* const function = functionOfModule("touchstone_images.so", kImageCodecSymbol, why);
    if (function == nullptr)
        return {nullptr, "the image library cannot be loaded (" + why +
                             "); build touchstone_images and leave it beside touchstone"};
    return {reinterpret_cast<const ImageCodec* (*)()>(function)(), ""};
}

} // namespace

const ImageCodec* imageCodec(std::string& problem) {
    static const Loaded loaded = load();
    problem = loaded.problem;
    return loaded.codec;
}

} // namespace touchstone
