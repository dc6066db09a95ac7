#pragma once
// The fixture of tests of haptic programs in the real window: a square whose material has one.

#include "tests/support/gltf_maker.h"
#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace touchstone::test {

class ProgramWindow : public WindowTest {
  protected:
    /// `share`: of the stiffness.
    static std::string source(const std::string& colour, const std::string& share) {
        return "parameter float share = 1; // 0.1..1 : of the stiffness\n"
               "void touch(const in Touch before, inout Surface after) {\n"
               "    after.colour = " +
               colour + ";\n    after.stiffness *= share * " + share + ";\n}\n";
    }
    /// A square of this base colour with the program of `shader`; null: without one.
    static void writeSquare(const std::filesystem::path& file, const Json& shader,
                            const Json& baseColor = {1.0, 1.0, 1.0, 1.0}) {
        GltfMaker maker = GltfMaker::square();
        maker.json["extensionsUsed"] = {"TOUCHSTONE_materials_haptic"};
        Json material = {
            {"pbrMetallicRoughness",
             {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}, {"baseColorFactor", baseColor}}},
            {"doubleSided", true}};
        Json& haptic = material["extensions"]["TOUCHSTONE_materials_haptic"];
        haptic["stiffness"] = 600.0;
        if (!shader.is_null())
            haptic["shader"] = shader;
        maker.json["materials"] = {material};
        maker.primitive()["material"] = 0;
        const std::vector<uint8_t> bytes = maker.glb();
        std::ofstream(file, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    /// `shader` whose source is inside the model.
    static Json embedded(const std::string& text, const std::string& name) {
        return {{"source", "data:text/plain;base64," + base64({text.begin(), text.end()})}, {"name", name}};
    }
    void openSquare(const Json& shader, const Json& baseColor = {1.0, 1.0, 1.0, 1.0}) {
        writeSquare(model_, shader, baseColor);
        open(model_.string(), {"--hand", "simulated", "--stroke", "circle"});
        until("the hand to touch", [](const Json& s) { return s["recent"]["in_contact"].get<bool>(); });
    }
    /// Ctrl+S; what `inspect` then says of the file.
    std::string savedAndInspected() {
        display_.key("ctrl+s");
        until("it to be saved",
              [&](const Json& s) { return s["materials"]["notice"] == "saved to " + model_.string(); });
        const ProgramResult inspected = runProgram({TOUCHSTONE_BINARY, "inspect", model_.string()});
        EXPECT_EQ(inspected.status, 0) << inspected.err;
        return inspected.out;
    }
    static const Json& programOf(const Json& s) { return s["programs"].at(0); }
    Json untilProgram(const std::string& what, const std::function<bool(const Json&)>& holds) {
        return until(what, [&](const Json& s) { return holds(programOf(s)); });
    }
    Json untilFeltAndSeen(int loads) {
        return untilProgram("the program to be felt and seen", [&](const Json& p) {
            return p["loads"] >= loads && p["felt_after_s"] >= 0.0 && p["seen_after_s"] >= 0.0 &&
                   !p["compiling"];
        });
    }
    /// The mean force, N, on the way of the circle, on which it is the same: two readings in a row are
    /// nearly equal, where the hand comes, leaves or hovers they are not, or are 0.
    double force() {
        constexpr int kReadings = 30; // a circle three times round takes five of them, with the ways to it
        double before = 0.0, now = 0.0;
        for (int i = 0; i < kReadings; ++i) {
            before = std::exchange(now, measured()["recent"]["mean_force_n"].get<double>());
            if (before > 0.0 && std::abs(now - before) < 0.02 * before)
                return now;
        }
        ADD_FAILURE() << "the force does not settle: " << before << " N, " << now << " N";
        return now;
    }
    /// 0, 1, 2: of red, green and blue what most of the picture is; -1: neither.
    int colour() {
        const ScreenPicture screen = display_.screen();
        const Json rect = status()["widgets"].at("picture");
        std::array<int, 3> count{};
        int all = 0;
        for (double y = 0.05; y < 1.0; y += 0.02)
            for (double x = 0.05; x < 1.0; x += 0.02, ++all) {
                const auto at = inPicture(x, y);
                const auto& p = screen.at(at.x, at.y);
                for (size_t i = 0; i < 3; ++i)
                    if (p[i] > 60 && p[i] > 2 * p[(i + 1) % 3] && p[i] > 2 * p[(i + 2) % 3])
                        ++count[i];
            }
        const auto most = std::ranges::max_element(count);
        return *most > all / 20 ? static_cast<int>(most - count.begin()) : -1;
    }
    void untilColour(int wanted) {
        for (int i = 0; i < 100 && colour() != wanted; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        EXPECT_EQ(colour(), wanted);
    }
    /// At the end of the text, in place of its last `gone` characters.
    void typeAtTheEnd(int gone, const std::string& text) {
        display_.key("ctrl+End");
        for (int i = 0; i < gone; ++i)
            display_.key("BackSpace");
        display_.xdotool({"type", "--delay", "40", text});
    }

    std::filesystem::path model_ = scratch_ / "square.glb", file_ = scratch_ / "p.glsl";
};

} // namespace touchstone::test
