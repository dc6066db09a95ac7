#pragma once
// Decodes images in memory to pixels, through OpenImageIO.

#include "engine/image/image_codec.h"
#include "engine/import/file/gltf_file.h"

#include <cstdint>
#include <functional>
#include <string>

namespace touchstone {

/// The problem reported when the pixel limit of import_context.h is reached.
inline constexpr const char* kTooManyPixels = "the model's images together need more memory than is allowed";

/// Decodes PNG, JPEG, WebP, TIFF, OpenEXR or Radiance HDR, identified by their first bytes, as stored: no
/// colour conversion, alpha not premultiplied, no EXIF rotation. `mayTake` must approve the pixels' size in
/// bytes before they are allocated. With `headerOnly` only the header is read (`pixels` then has its sizes
/// and no bytes). Does not throw for broken images.
[[nodiscard]] DecodedImage decodeImage(ByteSpan encoded, bool headerOnly,
                                       const std::function<bool(uint64_t)>& mayTake);

/// Number of images whose pixels this process has decoded so far, including broken ones; headers do not
/// count. Any thread.
[[nodiscard]] uint64_t imageDecodes() noexcept;

/// "png", "jpeg", ... by the first bytes, empty if unknown.
[[nodiscard]] std::string sniffImageFormat(ByteSpan encoded);

} // namespace touchstone
