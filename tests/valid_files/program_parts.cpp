#include "tests/valid_files/program_parts.h"

#include "engine/import/materials/texture_values.h"

#include <string>
#include <vector>

namespace touchstone::test {
namespace {

using nlohmann::json;

/// A displacement, noise, friction of the place.
const std::string kBumps =
    "parameter float height = 0.0002; // 0..0.01 m: of the bumps\n"
    "parameter vec2 friction = vec2(0.1, 0.5); // 0..2\n"
    "void touch(const in Touch before, inout Surface after) {\n"
    "    after.position += height * noise(before.position * 300.0) * before.normal;\n"
    "    after.staticFriction = mix(friction.x, friction.y, fract(before.uv.x * 7.0));\n"
    "    after.stiffness *= 0.5 + float(hash(uint(abs(before.position.x) * 1000.0)) & 255u) / 510.0;\n"
    "}\n";
/// What is worn off, and what it feels like.
const std::string kWear = "parameter float rate = 1e-4; // -1..1 m^2/(N s)\n"
                          "parameter float radius = 0.004; // 0..1 m\n"
                          "void touch(const in Touch before, inout Surface after) {\n"
                          "    after.staticFriction = abs(before.persistent);\n"
                          "    after.colour = vec3(before.persistent);\n"
                          "    after.persistentChange = -rate * length(before.force);\n"
                          "    after.brush = radius;\n"
                          "}\n";

/// Does not compile: the file is valid, and its surface plain.
const std::string kBroken =
    "void touch(const in Touch before, inout Surface after) {\n    after.colour = 1;\n}\n";

/// A source inside the file, as a data URI or in a buffer view.
void put(FileDraft& draft, json& shader, const std::string& text) {
    if (draft.draw.chance(0.5))
        shader["source"] = "data:text/plain;base64," + base64({text.begin(), text.end()});
    else
        shader["bufferView"] = draft.maker.addView(text.data(), text.size());
}

json texture(FileDraft& draft) {
    Draw& draw = draft.draw;
    PersistentTextureSize size;
    size.width = static_cast<uint32_t>(draw.pick(std::vector{1, 2, 33, 64, 200}));
    size.height = static_cast<uint32_t>(draw.pick(std::vector{1, 3, 32, 65, 128}));
    json stated = {{"width", size.width}, {"height", size.height}};
    if (draw.chance(0.4))
        stated["initial"] = size.initial = draw.pick(std::vector{0.0f, 0.5f, 1.0f});
    if (draw.chance(0.3)) {
        stated["minimum"] = size.minimum = -2.0f;
        stated["maximum"] = size.maximum = draw.pick(std::vector{1.0f, 1e6f});
    }
    if (draw.chance(0.5)) {
        // Of a node that may not be there, or place no such surface: the values are then of nobody.
        std::vector<float> values;
        for (size_t i = 0; i < size_t{size.width} * size.height; ++i)
            values.push_back(static_cast<float>(draw.real(-2.0, 2.0)));
        const TextureValues all[] = {{draw.between(0, 3), draw.between(0, 1), std::move(values)}};
        stated["values"] = jsonOf(all);
    }
    return stated;
}

} // namespace

void addProgram(FileDraft& draft, json& ours) {
    Draw& draw = draft.draw;
    const bool wears = draft.has(Feature::PersistentTextures) && draw.chance(0.8);
    if (!wears && !(draft.has(Feature::Programs) && draw.chance(0.7)))
        return;
    json shader = {{"name", wears ? "wear.glsl" : "bumps.glsl"}};
    const bool broken = !wears && draw.chance(0.1);
    put(draft, shader, wears ? kWear : broken ? kBroken : kBumps);
    if (!broken && draw.chance(0.5)) {
        if (wears)
            shader["parameters"] = {{"rate", draw.pick(std::vector{-1.0, 0.0, 1e-4, 1.0})},
                                    {"radius", draw.pick(std::vector{0.0, 1e-5, 0.01, 1.0})}};
        else
            shader["parameters"] = {{"height", draw.pick(std::vector{0.0, 1e-3, 0.01})},
                                    {"friction", {0.0, 2.0}}};
    }
    if (wears)
        shader["persistentTexture"] = texture(draft);
    ours["shader"] = shader;
}

} // namespace touchstone::test
