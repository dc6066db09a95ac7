#pragma once

#include "api/c/touched_scene.h"

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::api {

/// A session's scene with the numbers of its materials that the caller has changed. Geometry, maps and search
/// trees stay the scene's own. One thread at a time.
class ChangedMaterials {
  public:
    explicit ChangedMaterials(std::shared_ptr<TouchedScene> scene);

    /// One of hapticNumbers(); NaN: what the file says. Of all materials of the scene that are the same one
    /// in the file, or none there: a recording knows no others. Throws Refused where there is no such
    /// material or number, or the value is out of its range; nothing changes then.
    void set(uint64_t material, std::string_view name, double value);

    [[nodiscard]] const std::shared_ptr<const HapticScene>& haptic() const { return haptic_; }
    [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }
    /// `felt`: with its hash, for which every vertex is read.
    [[nodiscard]] SceneIdentity identity(bool felt) const;

  private:
    std::shared_ptr<TouchedScene> scene_;
    std::vector<Material> materials_;
    std::map<int, std::map<std::string, float, std::less<>>> changes_; ///< by Material::fileIndex; -1: none
    std::shared_ptr<const HapticScene> haptic_;
};

/// A value that is felt, before maps; NaN: the session's setting or the device's recommendation. Throws
/// Refused.
[[nodiscard]] double feltNumber(const std::vector<Material>& materials, uint64_t material,
                                std::string_view name);

} // namespace touchstone::api
