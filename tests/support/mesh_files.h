#pragma once
// Small OBJ, STL and PLY files: a tetrahedron with corners at the origin and at 1 on each axis, wound to the
// outside.

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace touchstone::test {

using Bytes = std::vector<uint8_t>;

inline constexpr std::array<std::array<float, 3>, 4> kTetrahedronCorners = {
    {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}}};
inline constexpr std::array<std::array<uint32_t, 3>, 4> kTetrahedronFaces = {
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

inline Bytes bytesOf(const std::string& text) {
    return {text.begin(), text.end()};
}

inline std::string cornerText(uint32_t corner) {
    std::string text;
    for (const float x : kTetrahedronCorners[corner])
        text += " " + std::to_string(x);
    return text;
}

/// With texture coordinates, normals from the middle outwards, and two materials of a library that is
/// elsewhere.
inline Bytes tetrahedronObj() {
    std::string text = "# a tetrahedron\nmtllib ../../etc/passwd\no solid\n";
    for (uint32_t i = 0; i < 4; ++i)
        text += "v" + cornerText(i) + "\n";
    text +=
        "vt 0 0\nvt 1 0\nvt 0 0.25\nvt 1 1\nvn -0.577350 -0.577350 -0.577350\nvn 1 0 0\nvn 0 1 0\nvn 0 0 1\n";
    for (size_t f = 0; f < 4; ++f) {
        text += f == 0 ? "usemtl cork\n" : f == 2 ? "usemtl steel\n" : "";
        text += "f";
        for (const uint32_t corner : kTetrahedronFaces[f]) {
            const std::string index = std::to_string(corner + 1);
            text += " " + index + "/" + index + "/" + index;
        }
        text += "\n";
    }
    return bytesOf(text);
}

inline Bytes tetrahedronAsciiStl() {
    std::string text = "solid tetrahedron\n";
    for (const auto& face : kTetrahedronFaces) {
        text += " facet normal 0 0 0\n  outer loop\n";
        for (const uint32_t corner : face)
            text += "   vertex" + cornerText(corner) + "\n";
        text += "  endloop\n endfacet\n";
    }
    return bytesOf(text + "endsolid tetrahedron\n");
}

template <class Number>
void append(Bytes& bytes, const Number& number) {
    const size_t at = bytes.size();
    bytes.resize(at + sizeof number);
    std::memcpy(bytes.data() + at, &number, sizeof number);
}

/// `header` fills the first 80 bytes.
inline Bytes tetrahedronBinaryStl(std::string header = "binary") {
    header.resize(80, ' ');
    Bytes bytes = bytesOf(header);
    append(bytes, uint32_t{4});
    for (const auto& face : kTetrahedronFaces) {
        append(bytes, std::array<float, 3>{});
        for (const uint32_t corner : face)
            append(bytes, kTetrahedronCorners[corner]);
        append(bytes, uint16_t{0});
    }
    return bytes;
}

inline std::string plyHeader(const std::string& form, const std::string& faces = "4") {
    return "ply\nformat " + form +
           " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face " +
           faces + "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline Bytes tetrahedronAsciiPly() {
    std::string text = plyHeader("ascii");
    for (uint32_t i = 0; i < 4; ++i)
        text += cornerText(i).substr(1) + " 255 " + std::to_string(60 * i) + " 0\n";
    for (const auto& face : kTetrahedronFaces)
        text += "3 " + std::to_string(face[0]) + " " + std::to_string(face[1]) + " " +
                std::to_string(face[2]) + "\n";
    return bytesOf(text);
}

/// `faces`: the number that the header claims.
inline Bytes tetrahedronBinaryPly(const std::string& faces = "4") {
    Bytes bytes = bytesOf(plyHeader("binary_little_endian", faces));
    for (const auto& corner : kTetrahedronCorners) {
        append(bytes, corner);
        append(bytes, std::array<uint8_t, 3>{255, 128, 0});
    }
    for (const auto& face : kTetrahedronFaces) {
        bytes.push_back(3);
        append(bytes, face);
    }
    return bytes;
}

} // namespace touchstone::test
