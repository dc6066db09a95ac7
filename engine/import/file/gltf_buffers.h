#pragma once
// The bytes of buffers and buffer views, from any source: the GLB's chunk, a data URI, a file beside the
// model, or compressed with EXT_meshopt_compression.

#include "engine/import/file/gltf_file.h"

#include <map>
#include <vector>

namespace touchstone {

class BufferStore {
  public:
    /// Loads every buffer and decompresses every compressed view. Throws Error for missing or too short data.
    /// Needs a validated file, and refers to it.
    BufferStore(ImportContext& context, const GltfFile& file);

    /// The bytes of bufferViews[index]: exactly byteLength of them.
    [[nodiscard]] ByteSpan view(size_t index) const { return views_[index]; }

    /// False for a view of a buffer that the file declares without bytes, which is legal: an extension may
    /// supply them. `view` is then empty.
    [[nodiscard]] bool hasData(size_t index) const { return !views_[index].empty(); }

  private:
    void loadBuffers(ImportContext& context, const GltfFile& file);
    ByteSpan bytesOfUri(ImportContext& context, const GltfFile& file, const std::string& uri,
                        const std::string& place);
    void loadViews(ImportContext& context, const GltfFile& file);

    std::vector<std::vector<uint8_t>> owned_;
    std::map<std::filesystem::path, ByteSpan> files_;
    std::vector<ByteSpan> buffers_; ///< empty: declared without bytes
    std::vector<ByteSpan> views_;
};

} // namespace touchstone
