#include "engine/import/mesh_reader/flat_writer.h"

#include "engine/import/mesh_file/flat_format.h"
#include "engine/import/reader_child/standard_streams.h"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

namespace {

class FlatOutput {
  public:
    FlatOutput() { block_.reserve(kBlock); }

    template <class Number>
    void put(Number number) {
        static_assert(sizeof(Number) == 4);
        if (block_.size() + sizeof number > kBlock)
            flush();
        const auto* bytes = reinterpret_cast<const char*>(&number);
        block_.insert(block_.end(), bytes, bytes + sizeof number);
    }
    void name(std::string_view text) {
        text = text.substr(0, kMaxFlatNameBytes);
        put(static_cast<uint32_t>(text.size()));
        for (size_t at = 0; at < text.size(); at += 4) {
            uint32_t word = 0;
            std::memcpy(&word, text.data() + at, std::min<size_t>(4, text.size() - at));
            put(word);
        }
    }
    void flush() {
        writeOutput(block_.data(), block_.size());
        block_.clear();
    }

  private:
    static constexpr size_t kBlock = size_t{1} << 16;
    std::vector<char> block_;
};

bool isTriangle(const aiFace& face) {
    return face.mNumIndices == 3;
}

/// Of the mesh's faces; those that triangulation left with other numbers of corners are skipped.
uint32_t trianglesOf(const aiMesh& mesh) {
    return static_cast<uint32_t>(std::count_if(mesh.mFaces, mesh.mFaces + mesh.mNumFaces, isTriangle));
}

uint32_t arraysOf(const aiMesh& mesh) {
    return (mesh.HasNormals() ? kFlatNormals : 0u) |
           (mesh.HasTextureCoords(0) ? kFlatTextureCoordinates : 0u) |
           (mesh.HasVertexColors(0) ? kFlatColors : 0u);
}

void putVectors(FlatOutput& output, const aiVector3D* vectors, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i)
        for (unsigned axis = 0; axis < 3; ++axis)
            output.put(vectors[i][axis]);
}

void putArrays(FlatOutput& output, const aiMesh& mesh) {
    putVectors(output, mesh.mVertices, mesh.mNumVertices);
    if (mesh.HasNormals())
        putVectors(output, mesh.mNormals, mesh.mNumVertices);
    if (mesh.HasTextureCoords(0))
        for (uint32_t i = 0; i < mesh.mNumVertices; ++i)
            for (unsigned axis = 0; axis < 2; ++axis)
                output.put(mesh.mTextureCoords[0][i][axis]);
    if (mesh.HasVertexColors(0))
        for (uint32_t i = 0; i < mesh.mNumVertices; ++i)
            for (unsigned part = 0; part < 4; ++part)
                output.put(mesh.mColors[0][i][part]);
    for (uint32_t i = 0; i < mesh.mNumFaces; ++i)
        if (isTriangle(mesh.mFaces[i]))
            for (unsigned corner = 0; corner < 3; ++corner)
                output.put(static_cast<uint32_t>(mesh.mFaces[i].mIndices[corner]));
}

/// As the file names it, without the name that the library gives to one of its own.
std::string materialName(const aiScene& scene, unsigned index) {
    const std::string name = index < scene.mNumMaterials ? scene.mMaterials[index]->GetName().C_Str() : "";
    return name.empty() || name == AI_DEFAULT_MATERIAL_NAME ? "surface" : name;
}

} // namespace

void writeFlat(const aiScene& scene) {
    std::vector<const aiMesh*> meshes;
    for (unsigned i = 0; i < scene.mNumMeshes; ++i)
        if (trianglesOf(*scene.mMeshes[i]) > 0)
            meshes.push_back(scene.mMeshes[i]);
    if (meshes.empty())
        throw std::runtime_error("it holds no triangles");
    if (meshes.size() > kMaxFlatParts)
        throw std::runtime_error("it has more than " + std::to_string(kMaxFlatParts) + " parts");
    // The library adds a material of its own, which a mesh need not have.
    std::vector<unsigned> materials;
    for (const aiMesh* mesh : meshes)
        if (std::ranges::find(materials, mesh->mMaterialIndex) == materials.end())
            materials.push_back(mesh->mMaterialIndex);
    FlatOutput output;
    output.put(kFlatMagic);
    output.put(static_cast<uint32_t>(materials.size()));
    output.put(static_cast<uint32_t>(meshes.size()));
    for (const unsigned material : materials)
        output.name(materialName(scene, material));
    for (const aiMesh* mesh : meshes) {
        output.name(mesh->mName.C_Str());
        output.put(
            static_cast<uint32_t>(std::ranges::find(materials, mesh->mMaterialIndex) - materials.begin()));
        output.put(static_cast<uint32_t>(mesh->mNumVertices));
        output.put(trianglesOf(*mesh));
        output.put(arraysOf(*mesh));
    }
    for (const aiMesh* mesh : meshes)
        putArrays(output, *mesh);
    output.flush();
}

} // namespace touchstone
