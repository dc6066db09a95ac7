#include "renderer/png_encoding.h"

#include <png.h>

#include <array>
#include <bit>
#include <csetjmp>

namespace touchstone {

namespace {

constexpr int kCompression = 6;
constexpr std::array kColourTypes{PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                  PNG_COLOR_TYPE_RGB_ALPHA};

// libpng is C: no exception passes through it. Its errors jump to `write`.
void append(png_structp png, png_bytep data, png_size_t size) {
    auto& bytes = *static_cast<std::vector<unsigned char>*>(png_get_io_ptr(png));
    bool taken = true;
    try {
        bytes.insert(bytes.end(), data, data + size);
    } catch (...) {
        taken = false;
    }
    if (!taken)
        png_error(png, "no memory");
}

[[noreturn]] void jump(png_structp png, png_const_charp) {
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}
void flush(png_structp) {}

/// No object with a destructor lives here, since an error jumps over it.
bool write(const PixelData& pixels, std::vector<unsigned char>& bytes) noexcept {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, jump, ignore);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) {
        png_destroy_write_struct(&png, nullptr);
        return false;
    }
    if (setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    const size_t component = pixels.type == ComponentType::U16 ? 2 : 1;
    const size_t row = static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.channels) * component;
    png_set_write_fn(png, &bytes, append, flush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(pixels.width), static_cast<png_uint_32>(pixels.height),
                 static_cast<int>(8 * component), kColourTypes[static_cast<size_t>(pixels.channels - 1)],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_compression_level(png, kCompression);
    png_write_info(png, info);
    if (component == 2 && std::endian::native == std::endian::little)
        png_set_swap(png);
    for (int y = 0; y < pixels.height; ++y)
        png_write_row(png,
                      reinterpret_cast<png_const_bytep>(pixels.bytes.data()) + static_cast<size_t>(y) * row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return true;
}

} // namespace

std::vector<unsigned char> encodePng(const PixelData& pixels) {
    std::vector<unsigned char> bytes;
    if (!write(pixels, bytes))
        bytes.clear();
    return bytes;
}

} // namespace touchstone
