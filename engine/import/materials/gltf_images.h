#pragma once

#include "engine/import/materials/gltf_document.h"
#include "engine/scene/scene.h"

#include <optional>
#include <vector>

namespace touchstone {

/// Reads all images of the file: decodes those that `use` asks for and a material of the scene's instances
/// needs, looks at the header of the others. `scene` is complete but for its images. What is missing or
/// broken leaves `problem` and a warning. A URI that is malformed or leaves the folder throws.
[[nodiscard]] std::vector<Image> readImages(ImportContext& context, const GltfFile& file,
                                            const GltfDocument& document, const Scene& scene,
                                            const ImageUse& use);

/// Lets the materials be seen without the images that could not be read: references are dropped, a lost base
/// colour becomes grey. (What is felt: settledHaptics.)
void dropBrokenImages(const std::vector<Image>& images, std::vector<Material>& materials);

/// The file's roughness of a material: factor times the mean of the texture's green channel, if the file
/// states either and (for the texture) it was decoded.
[[nodiscard]] std::optional<float> statedRoughness(const Material& material,
                                                   const std::vector<Image>& images);

} // namespace touchstone
