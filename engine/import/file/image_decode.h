#pragma once
// Encoded images to pixels, through OpenImageIO, out of memory.

#include "engine/import/file/gltf_file.h"

#include <cstdint>
#include <functional>
#include <string>

namespace touchstone {

/// Why an image has no pixels when the limit of import_context.h is reached.
inline constexpr const char* kTooManyPixels = "the model's images together need more memory than is allowed";

struct DecodedImage {
    PixelData pixels;    ///< empty when `problem` is set
    std::string problem; ///< why there are no pixels, as the end of a sentence
};

/// Decodes PNG, JPEG, WebP, TIFF, OpenEXR or Radiance HDR, told apart by their first bytes, as stored: no
/// colour conversion, alpha not multiplied in, no EXIF rotation. `mayTake` is asked for the pixels' bytes
/// before they are allocated. With `headerOnly` nothing but the header is read (`pixels` then has its sizes
/// and no bytes). Does not throw for broken images.
[[nodiscard]] DecodedImage decodeImage(ByteSpan encoded, bool headerOnly,
                                       const std::function<bool(uint64_t)>& mayTake);

/// Images whose pixels this process has decoded so far, broken ones too; headers do not count. Any thread.
[[nodiscard]] uint64_t imageDecodes() noexcept;

/// "png", "jpeg", ... by the first bytes, empty if unknown.
[[nodiscard]] std::string sniffImageFormat(ByteSpan encoded);

} // namespace touchstone
