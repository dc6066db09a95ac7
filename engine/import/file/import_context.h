#pragma once
// Shared state of the steps of an import: the file's name for messages, the warnings, the memory limits. One
// import, one thread.

#include "engine/core/error.h"
#include "engine/core/progress.h"
#include "engine/import/file/load_options.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace touchstone {

// Limits of an import. A file beyond one of them is refused with a message that names the limit.

/// Largest file or buffer read, bytes. GLB lengths are 32 bit.
inline constexpr uint64_t kMaxFileBytes = 4'294'967'295ull;
/// JSON values (numbers, strings, objects, arrays) in the file. Each costs up to about 100 bytes while
/// loading.
inline constexpr size_t kMaxJsonValues = 2'000'000;
/// Nesting of the JSON. glTF itself needs about 10.
inline constexpr int kMaxJsonDepth = 64;
/// Entries of all top-level arrays together (nodes, accessors, materials, ...).
inline constexpr size_t kMaxJsonObjects = 400'000;
/// Materials of the file; a typed one takes about 3 KB.
inline constexpr size_t kMaxMaterials = 65'536;
/// Bytes of all the file's texts together, except data URIs, which count as data.
inline constexpr size_t kMaxTextBytes = 64u << 20;
/// Meshes placed in the scene.
inline constexpr size_t kMaxInstances = 262'144;
/// Copies of meshes that the nodes of any file may place together (EXT_mesh_gpu_instancing); beyond it, one
/// for every kFileBytesPerCopy of the file's own data, which is less than the size of a copy's translation.
inline constexpr uint64_t kFreeCopies = 10'000;
inline constexpr uint64_t kFileBytesPerCopy = 8;
/// Triangles that any file may place, over all instances; beyond it, one for every byte of the file's own
/// data. Structures built from a scene (BVHs, vertex buffers) grow with them.
inline constexpr uint64_t kFreePlacedTriangles = 5'000'000;
/// Bytes of geometry that any file may expand to; beyond it, kGeometryExpansion times the file's own data.
/// Sparse and absent buffer views, many primitives on one accessor and compression can all expand a small
/// file.
inline constexpr uint64_t kFreeGeometryBytes = 256ull << 20;
inline constexpr uint64_t kGeometryExpansion = 16;
/// Bytes of decoded pixels that any file may hold; beyond it, kPixelExpansion times the file's own data.
inline constexpr uint64_t kFreePixelBytes = 320ull << 20;
inline constexpr uint64_t kPixelExpansion = 32;
/// Longest side of an image, pixels.
inline constexpr int kMaxImageSide = 16'384;

class ImportContext {
  public:
    ImportContext(std::string file, const LoadOptions& options) : file_(std::move(file)), options_(options) {}

    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] const LoadOptions& options() const { return options_; }

    /// Ends the import.
    [[noreturn]] void fail(const std::string& place, const std::string& problem,
                           const std::string& remedy = "re-export the model") const {
        throw Error(file_, place, problem, remedy);
    }

    /// One warning per kind of flaw: places and messages that differ in numbers only are one warning, which
    /// lists the next places and counts the rest. At most kMaxWarnings kinds are kept, which bounds the
    /// output and the memory for a broken file.
    void warn(std::string place, const std::string& message);

    /// Runs `work`, which reads a part that neither geometry nor safety depends on. If it throws Error, adds
    /// a warning, "PROBLEM; CONSEQUENCE", and returns false. Cancellation still ends the import.
    template <class Work>
    bool attempt(const char* consequence, Work&& work) {
        try {
            std::forward<Work>(work)();
            return true;
        } catch (const Error& error) {
            stopIfCancelled();
            warn(error.place(), error.problem() + "; " + consequence);
            return false;
        }
    }

    /// Reports progress and stops a cancelled import; `fraction` of the whole import.
    void step(double fraction, const char* what) const { progress().step(fraction, what); }
    void stopIfCancelled() const { progress().stopIfCancelled(); }
    [[nodiscard]] Progress progress() const { return {&options_.progress, options_.cancel}; }
    /// Sets the current part of the import, for reports inside it.
    void enter(const Progress& part) { part_ = part; }
    [[nodiscard]] const Progress& part() const { return part_; }

    /// The sizes of the file's own data, which scale the limits above.
    [[nodiscard]] uint64_t fileBytes() const { return fileBytes_; }
    void countFileBytes(uint64_t bytes) { fileBytes_ += bytes; }
    /// Reserves memory that the geometry expands to; fails beyond the limit.
    void spendGeometry(uint64_t bytes, const std::string& place);
    /// Reserves memory for pixels; false beyond the limit.
    [[nodiscard]] bool spendPixels(uint64_t bytes);

    [[nodiscard]] std::vector<Warning> takeWarnings();

  private:
    /// A warning and the further places of its kind; the first kListedPlaces of them are kept.
    struct Kind {
        Warning first;
        std::vector<std::string> others;
        size_t otherCount = 0;
    };
    static constexpr size_t kMaxWarnings = 200, kListedPlaces = 3;
    /// Warnings that are remembered, so that a flaw found twice counts once. Beyond, counts may be too high.
    static constexpr size_t kMaxRemembered = 1u << 16;
    std::string file_;
    const LoadOptions& options_;
    std::vector<Kind> kinds_;
    std::unordered_map<std::string, size_t> kindOf_; ///< by place and message without their numbers
    std::unordered_set<size_t> told_;                ///< hashes of place and message
    size_t droppedWarnings_ = 0;
    Progress part_ = progress();
    uint64_t fileBytes_ = 0, geometrySpent_ = 0, pixelsSpent_ = 0;
};

/// "meshes[3]".
[[nodiscard]] std::string element(std::string_view array, size_t index);

} // namespace touchstone
