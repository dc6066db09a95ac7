#include "engine/image/image_codec.h"

#include "engine/process/helper_program.h"

#include <dlfcn.h>

namespace touchstone {

namespace {

struct Loaded {
    const ImageCodec* codec = nullptr;
    std::string problem;
};

/// The library stays loaded: its own libraries keep state for each thread.
Loaded load() {
    const std::string file = helperProgram("touchstone_images.so").string();
    const auto failed = [] {
        const char* why = dlerror();
        return Loaded{nullptr, "the image library cannot be loaded (" +
                                   std::string(why != nullptr ? why : "no reason") +
                                   "); build touchstone_images and leave it beside touchstone"};
    };
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (library == nullptr)
        return failed();
    void* function = dlsym(library, kImageCodecSymbol);
    if (function == nullptr)
        return failed();
    return {reinterpret_cast<const ImageCodec* (*)()>(function)(), ""};
}

} // namespace

const ImageCodec* imageCodec(std::string& problem) {
    static const Loaded loaded = load();
    problem = loaded.problem;
    return loaded.codec;
}

} // namespace touchstone
