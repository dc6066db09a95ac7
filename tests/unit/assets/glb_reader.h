#pragma once
// As much of a glTF reader as our own scenes need, independent of the engine's loader and of the writer.

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace touchstone::test {

struct Primitive {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uv;
    std::vector<glm::vec4> tangents;
    std::vector<uint32_t> indices;
};

class GlbReader {
  public:
    /// Throws std::runtime_error if the container is broken.
    explicit GlbReader(const std::vector<std::byte>& file);

    [[nodiscard]] const nlohmann::json& json() const { return json_; }
    /// Every primitive of every mesh that is a list of triangles.
    [[nodiscard]] std::vector<Primitive> primitives() const;
    /// The encoded bytes of images[index].
    [[nodiscard]] std::vector<std::byte> image(size_t index) const;

  private:
    [[nodiscard]] std::vector<std::byte> view(size_t index) const;
    template <class T>
    [[nodiscard]] std::vector<T> accessor(size_t index) const;
    [[nodiscard]] std::vector<uint32_t> indices(size_t index) const;

    nlohmann::json json_;
    std::vector<std::byte> binary_;
};

} // namespace touchstone::test
