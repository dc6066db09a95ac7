#include "engine/import/materials/gltf_looks.h"

#include "engine/import/materials/gltf_materials.h"

#include <cmath>
#include <limits>

namespace touchstone {
namespace {

using nlohmann::json;

constexpr double kAny = std::numeric_limits<float>::max();

/// The fields of one extension of one material. None of their errors refuses the file.
class LookFields {
  public:
    LookFields(ImportContext& context, const GltfDocument& document, const json& stated, const char* name,
               const std::string& materialPlace)
        : context_(context), document_(document), place_(materialPlace + ".extensions." + name) {
        const auto extensions = stated.find("extensions");
        if (extensions == stated.end() || !extensions->is_object())
            return;
        const auto found = extensions->find(name);
        if (found == extensions->end())
            return;
        if (found->is_object())
            fields_ = &*found;
        else
            context_.warn(place_, "should be an object; drawn without it");
    }

    [[nodiscard]] explicit operator bool() const { return fields_ != nullptr; }
    [[nodiscard]] bool has(const char* name) const { return fields_->contains(name); }

    void number(const char* name, double low, double high, float& value) const {
        if (const json* stated = find(name))
            value = ranged(*stated, name, low, high, value);
    }

    /// A vector with as many numbers as `value` has.
    template <class Vector>
    void color(const char* name, double high, Vector& value) const {
        const json* stated = find(name);
        if (stated == nullptr)
            return;
        if (!stated->is_array() || stated->size() != static_cast<size_t>(Vector::length())) {
            context_.warn(place_ + "." + name, "should be " + std::to_string(Vector::length()) +
                                                   " numbers; drawn with the default");
            return;
        }
        for (int c = 0; c < Vector::length(); ++c)
            value[c] = ranged((*stated)[static_cast<size_t>(c)], name, 0.0, high, value[c]);
    }

    void texture(const char* name, TextureRef& reference) const {
        const json* stated = find(name);
        if (stated == nullptr)
            return;
        try {
            reference = readTexture(context_, document_, *stated, place_ + "." + name);
        } catch (const Error& error) {
            context_.warn(error.place(), error.problem() + "; drawn without it");
        }
    }

    void leftOut(const char* name) const {
        if (has(name))
            context_.warn(place_ + "." + name, "is not supported; drawn without it");
    }

  private:
    [[nodiscard]] const json* find(const char* name) const {
        const auto found = fields_->find(name);
        return found == fields_->end() ? nullptr : &*found;
    }

    float ranged(const json& stated, const char* name, double low, double high, float fallback) const {
        if (!stated.is_number()) {
            context_.warn(place_ + "." + name, "should be a number; drawn with the default");
            return fallback;
        }
        const double value = stated.get<double>();
        if (value >= low && value <= high)
            return static_cast<float>(value);
        context_.warn(place_ + "." + name, "is out of range and was clamped");
        return static_cast<float>(value > high ? high : low);
    }

    ImportContext& context_;
    const GltfDocument& document_;
    std::string place_;
    const json* fields_ = nullptr;
};

void readSpecularGlossiness(const LookFields& fields, Material& material) {
    SpecularGlossiness& look = material.specularGlossiness;
    look.used = true;
    // The extension has a diffuse colour and map of its own; the core ones are a fallback for other programs.
    material.baseColor = glm::vec4(1.0f);
    material.baseColorTexture = {};
    fields.color("diffuseFactor", 1.0, material.baseColor);
    fields.texture("diffuseTexture", material.baseColorTexture);
    fields.color("specularFactor", 1.0, look.specular);
    fields.number("glossinessFactor", 0.0, 1.0, look.glossiness);
    fields.texture("specularGlossinessTexture", look.texture);
}

void readSpecular(const LookFields& ior, const LookFields& specular, DielectricSpecular& look) {
    if (ior) {
        ior.number("ior", 0.0, 1e3, look.ior);
        if (look.ior > 0.0f && look.ior < 1.0f)
            look.ior = 1.0f;
    }
    if (specular) {
        specular.number("specularFactor", 0.0, 1.0, look.factor);
        specular.texture("specularTexture", look.texture);
        specular.color("specularColorFactor", kAny, look.color);
        specular.texture("specularColorTexture", look.colorTexture);
    }
}

void readClearcoat(const LookFields& fields, Clearcoat& look) {
    fields.number("clearcoatFactor", 0.0, 1.0, look.factor);
    fields.texture("clearcoatTexture", look.texture);
    fields.number("clearcoatRoughnessFactor", 0.0, 1.0, look.roughness);
    fields.texture("clearcoatRoughnessTexture", look.roughnessTexture);
    fields.leftOut("clearcoatNormalTexture");
}

void readSheen(const LookFields& fields, Sheen& look) {
    fields.color("sheenColorFactor", 1.0, look.color);
    fields.texture("sheenColorTexture", look.colorTexture);
    fields.number("sheenRoughnessFactor", 0.0, 1.0, look.roughness);
    fields.texture("sheenRoughnessTexture", look.roughnessTexture);
}

void readTransmission(const LookFields& fields, Transmission& look) {
    fields.number("transmissionFactor", 0.0, 1.0, look.factor);
    fields.texture("transmissionTexture", look.texture);
}

void readVolume(const LookFields& fields, Transmission& look) {
    fields.number("thicknessFactor", 0.0, kAny, look.thickness);
    fields.texture("thicknessTexture", look.thicknessTexture);
    fields.color("attenuationColor", 1.0, look.attenuationColor);
    fields.number("attenuationDistance", 0.0, kAny, look.attenuationDistance);
}

/// An unlit material ignores all other appearance extensions (KHR_materials_unlit, "Conflicts").
void readUnlit(ImportContext& context, const json& stated, const std::string& place, Material& material) {
    material.unlit = true;
    for (const auto& [name, extension] : stated["extensions"].items())
        if (name.starts_with("KHR_materials_") && name != "KHR_materials_unlit")
            context.warn(place + ".extensions.KHR_materials_unlit",
                         "is drawn, and " + name.substr(0, 60) + " is not: they exclude each other");
}

} // namespace

void readLookExtensions(ImportContext& context, const GltfDocument& document, const json& stated,
                        const std::string& place, Material& material) {
    const auto fields = [&](const char* name) { return LookFields(context, document, stated, name, place); };
    if (fields("KHR_materials_unlit"))
        readUnlit(context, stated, place, material);
    if (const LookFields strength = fields("KHR_materials_emissive_strength")) {
        float factor = 1.0f;
        strength.number("emissiveStrength", 0.0, 1e9, factor);
        material.emissive *= factor;
    }
    if (const LookFields glossy = fields("KHR_materials_pbrSpecularGlossiness"))
        readSpecularGlossiness(glossy, material);
    readSpecular(fields("KHR_materials_ior"), fields("KHR_materials_specular"), material.specular);
    if (const LookFields coat = fields("KHR_materials_clearcoat"))
        readClearcoat(coat, material.clearcoat);
    if (const LookFields sheen = fields("KHR_materials_sheen"))
        readSheen(sheen, material.sheen);
    if (const LookFields transmission = fields("KHR_materials_transmission"))
        readTransmission(transmission, material.transmission);
    if (const LookFields volume = fields("KHR_materials_volume"))
        readVolume(volume, material.transmission);
}

} // namespace touchstone
