#pragma once

#include "engine/import/materials/gltf_document.h"
#include "engine/scene/scene.h"

#include <optional>
#include <vector>

namespace touchstone {

/// Reads all images of the file: decodes those that `use` selects and a material of the scene's instances
/// needs, and reads only the headers of the others. `scene` is complete except for its images. A missing or
/// broken image has a `problem` and a warning. A URI that is malformed or leaves the folder throws.
[[nodiscard]] std::vector<Image> readImages(ImportContext& context, const GltfFile& file,
                                            const GltfDocument& document, const Scene& scene,
                                            const ImageUse& use);

/// Prepares the materials for drawing without the images that could not be read: references are dropped, a
/// lost base colour becomes grey. (For touch: settledHaptics.)
void dropBrokenImages(const std::vector<Image>& images, std::vector<Material>& materials);

/// The file's roughness of a material: factor times the mean of the texture's green channel, if the file
/// states either and (for the texture) it was decoded.
[[nodiscard]] std::optional<float> statedRoughness(const Material& material,
                                                   const std::vector<Image>& images);

} // namespace touchstone
