// Every state of the window at every size: no text is cut, covered or too small, no two controls overlap, and
// every control has a tooltip. Dear ImGui without a screen: its draw lists tell.

#include "tests/screenshot/panel_figures.h"
#include "tests/screenshot/text_audit.h"
#include "tests/support/program.h"
#include "workbench/panels/material_window.h"
#include "workbench/screen/style.h"

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <regex>
#include <set>

namespace touchstone::test {
namespace {

/// A line of a file.
struct Line : std::string {
    friend std::istream& operator>>(std::istream& stream, Line& line) { return std::getline(stream, line); }
};

constexpr float kSmallestType = 11.0f; // at scale 1
constexpr float kFrame = 1.0f / 30.0f; // s

struct Size {
    int width, height;
    float scale;
};

class PanelLayout : public ::testing::Test, protected PanelFigures {
  protected:
    void SetUp() override {
        input_.gpuName = "llvmpipe (LLVM 15.0.6, 256 bits)";
        for (const char* name : {"doughnut", "ribs", "a_model_with_a_long_name"}) {
            samples_.emplace_back(std::string("/samples/") + name + ".glb");
            notes_.emplace_back("relief: ribs across the stroke");
            entries_.push_back({.file = samples_.back(), .note = notes_.back(), .sample = true});
        }
        entries_.push_back({.file = samples_.front(), .note = "", .state = GalleryState::Missing});
        input_.samples = input_.recent = samples_;
        input_.sampleNotes = notes_;
        input_.gallery = entries_;
        input_.devices = {{.choice = "/dev/hidraw0", .name = "WoodenHaptics", .remedy = ""}};
        material_.scene = model_.scene.get();
        material_.probed = 0;
        lookAt(scratch_ / "recording.tsrec");
        timeline_.leave();
        listRecordings();
        input_.tick = &servo_.last;
    }
    void TearDown() override { end(); }

    void begin(const Size& size) {
        end();
        context_ = ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = ImVec2(static_cast<float>(size.width), static_cast<float>(size.height));
        io.DeltaTime = kFrame;
        io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset; // as the window's Vulkan backend
        input_.scale = size.scale;
        applyStyle(size.scale);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    }
    void end() {
        if (context_ != nullptr)
            ImGui::DestroyContext(std::exchange(context_, nullptr));
    }
    void frames(int count) {
        for (int i = 0; i < count; ++i) {
            ImGui::NewFrame();
            rects_ = drawPanels(input_, state_);
            Widgets widgets(input_.scale, &state_.hovered);
            drawMaterialWindow(material_, rects_.at("picture"), state_.editMaterials, controller_,
                               materialState_, widgets);
            rects_.merge(widgets.take());
            ImGui::Render();
        }
    }
    void point(const std::string& widget) {
        const WidgetRect& rect = rects_.at(widget);
        ImGui::GetIO().MousePos = ImVec2(rect.x + 0.5f * rect.width, rect.y + 0.5f * rect.height);
    }
    void click(const std::string& widget) {
        point(widget);
        frames(2);
        ImGui::GetIO().MouseDown[0] = true;
        frames(2);
        ImGui::GetIO().MouseDown[0] = false;
        frames(2);
        ImGui::GetIO().MousePos = ImVec2(-1e6f, -1e6f);
    }

    /// The editor is open on a material with a haptic program.
    void showProgram() {
        state_.editMaterials = true;
        material_.scene = program_.scene.get();
        controller_.open(program_, false);
    }

    /// Calls `check` with the name of each state, after it has come to rest.
    void inEveryState(const Size& size, const std::function<void(const std::string&)>& check);

    ImGuiContext* context_ = nullptr;
    ScratchFolder scratch_;
    std::vector<std::filesystem::path> samples_;
    std::vector<std::string> notes_;
    std::vector<GalleryEntry> entries_;
    MaterialPanelInput material_;
    MaterialPanelState materialState_;
    Model program_ = loadModel(TOUCHSTONE_ASSETS "/wood.glb", Fit::Workspace);
};

constexpr Size kSizes[]{{640, 400, 1.0f},  {900, 600, 1.0f},   {1280, 800, 1.0f},
                        {1280, 800, 2.0f}, {2560, 1440, 1.0f}, {2560, 1440, 2.0f}};

/// Long since it is a list: a state a paragraph.
void PanelLayout::inEveryState(const Size& size, const std::function<void(const std::string&)>& check) {
    const PanelState before = state_;
    const PanelInput input = input_;
    const auto in = [&](const std::string& name, const std::function<void()>& enter,
                        const std::function<void()>& then = {}) {
        state_ = before;
        input_ = input;
        begin(size);
        enter();
        frames(4);
        if (then) {
            then();
            frames(4);
        }
        check(name);
    };
    in("the mouse", [] {});
    in("the first run", [&] { state_.introduced = false; });
    in("the first run with another hand", [&] {
        state_.introduced = false;
        state_.simulatedHand = true;
    });
    in("the simulated hand", [&] {
        state_.simulatedHand = true;
        input_.strokeNotice = "The stroke is being laid onto the model.";
    });
    in("a device", [&] {
        state_.device = "/dev/hidraw0";
        input_.deviceStatus = "WoodenHaptics: 1000 reports a second, 0.25 ms old";
        state_.workspace.zoom = 2.5;
        servo_.last.sample.mapping.workspaceFromDevice.scale = 2.5;
    });
    in("other methods", [&] {
        state_.settings.contact = ContactMethod::Rays;
        state_.settings.stiffness = 2000.0;
    });
    in("the left panel alone", [&] { state_.folds.right = true; });
    in("a fault, a recording, sound and warnings", [&] {
        servo_.last.output.flags = static_cast<uint32_t>(TickFlag::SafetyLatched);
        input_.recording = true;
        input_.recordedSeconds = 1234.0;
        state_.sound.on = true;
        input_.sound.problem = "no sound card: /dev/snd has none";
        input_.notice = "kept /home/user/.local/state/touchstone/flight/2026-11-23_06.14.18_fault.tsrec";
        input_.warnings = {"mesh 'glaze': two triangles have no area: left out",
                           "0.25 mm is less than 0.5 mm"};
        state_.folds.right = true;
    });
    servo_.last.output.flags = {};
    in("loading", [&] {
        input_.loading = true;
        input_.loadName = "a_model_with_a_name_that_is_rather_long_for_a_card.glb";
        input_.loadActivity = "decoding images";
    });
    in("a problem", [&] {
        input_.problem =
            "/home/user/models/a_model_with_a_long_name.glb: accessor 3 reaches beyond its buffer of "
            "1,234.5 bytes\n  remedy: export the model again";
    });
    in("unsaved materials", [&] { state_.leaving.emplace(); });
    in("the help", [&] { state_.help = true; });
    in("the gallery", [&] { state_.gallery = true; });
    in(
        "the file menu", [] {}, [&] { click("file"); });
    in(
        "the view menu", [&] { input_.scaleFits = false; }, [&] { click("viewMenu"); });
    in(
        "the view menu of a clipped model",
        [&] {
            state_.view.part.clip = ClipPlane{{0.0, 0.6, 0.8}, -0.0213};
            state_.view.part.hidden = {0};
        },
        [&] { click("viewMenu"); });
    in("the editor", [&] { state_.editMaterials = true; });
    in(
        "the presets", [&] { state_.editMaterials = true; }, [&] { click("edit.preset"); });
    in(
        "the strokes",
        [&] {
            state_.simulatedHand = true;
            state_.folds.right = true;
        },
        [&] { click("stroke"); });
    in("the editor of a program", [&] { showProgram(); });
    in("the editor of a program and its text", [&] {
        state_.editMaterials = true;
        materialState_.program.open = true;
    });
    in("the editor of a program and its wrong text", [&] {
        state_.editMaterials = true;
        controller_.programs().type(
            0, "void touch(const in Touch before, inout Surface after) {\n    after.force = "
               "vec3(an_input_that_nobody_has_declared_anywhere);\n}\n");
        while (controller_.programs().pending())
            (void)controller_.update(program_);
    });
    materialState_ = {};
    material_.scene = model_.scene.get();
    controller_.open(model_, false);
    in("the panels worked by keys", [&] { state_.walking = true; });
    in("the list of recordings", [&] { state_.timeline.shown = true; });
    in("a recording is to be deleted", [&] {
        state_.timeline.shown = true;
        state_.timeline.deleting = timeline_.list().recordings().front().file;
    });
    in("a recording", [&] {
        lookAt(scratch_ / "recording.tsrec");
        state_.folds.left = state_.folds.right = true;
    });
    in("a recording beside a panel", [] {});
    timeline_.leave();
    input_.tick = &servo_.last;
    state_ = before;
    input_ = input;
}

/// True where there is no such card, too.
bool liesOver(const char* card, const WidgetRect& picture) {
    const ImGuiWindow* const window = ImGui::FindWindowByName(card);
    return window == nullptr || !window->WasActive ||
           (window->Pos.x >= picture.x && window->Pos.x + window->Size.x <= picture.x + picture.width &&
            window->Pos.y >= picture.y && window->Pos.y + window->Size.y <= picture.y + picture.height);
}

TEST_F(PanelLayout, NoTextIsCutCoveredOrTooSmallInAnyStateAtAnySize) {
    int states = 0;
    for (const Size& size : kSizes)
        inEveryState(size, [&](const std::string& state) {
            ++states;
            std::vector<std::string> complaints = auditText(kSmallestType * size.scale);
            for (const char* card : {"loading", "problem", "unsaved", "looking"})
                if (!liesOver(card, rects_.at("picture")))
                    complaints.push_back(std::string(card) + ": it reaches out of the picture");
            for (const std::string& complaint : complaints)
                ADD_FAILURE() << size.width << 'x' << size.height << " at scale " << size.scale << ", "
                              << state << ": " << complaint;
        });
    EXPECT_EQ(states, 162);
}

/// Containers of others, and what floats over them.
bool isContainer(const std::string& name) {
    static const std::set<std::string> kContainers{"picture", "focused", "budget", "charts", "error"};
    return kContainers.contains(name);
}

TEST_F(PanelLayout, NoTwoControlsOverlap) {
    size_t pairs = 0;
    for (const Size& size : kSizes)
        inEveryState(size, [&](const std::string& state) {
            if (state.find("menu") != std::string::npos || state.starts_with("the help") ||
                state.starts_with("the gallery") || state.starts_with("the editor") ||
                state.starts_with("the presets") || state.starts_with("the strokes"))
                return; // they lie over panels, or scroll beneath their buttons
            for (auto a = rects_.begin(); a != rects_.end(); ++a)
                for (auto b = std::next(a); b != rects_.end(); ++b) {
                    if (isContainer(a->first) || isContainer(b->first))
                        continue;
                    ++pairs;
                    const WidgetRect &p = a->second, &q = b->second;
                    const float wide = std::min(p.x + p.width, q.x + q.width) - std::max(p.x, q.x);
                    const float high = std::min(p.y + p.height, q.y + q.height) - std::max(p.y, q.y);
                    EXPECT_FALSE(wide > 1.0f && high > 1.0f)
                        << size.width << 'x' << size.height << " at scale " << size.scale << ", " << state
                        << ": " << a->first << " and " << b->first;
                }
        });
    EXPECT_GT(pairs, 10000u);
}

TEST_F(PanelLayout, EveryMarkedControlOfEveryStateHasATooltip) {
    std::map<std::string, std::string> notes;
    inEveryState({2560, 1440, 1.0f}, [&](const std::string&) {
        for (const auto& [name, rect] : rects_)
            if (name != "picture" && name != "focused")
                notes[name] = rect.note;
    });
    for (const auto& [name, note] : notes)
        EXPECT_FALSE(note.empty()) << name;
    std::cout << notes.size() << " controls have a tooltip\n";
    EXPECT_GT(notes.size(), 120u);
}

/// A control of ImGui's in the code of the panels is followed by its name, or lies in Widgets, which marks
/// it.
TEST_F(PanelLayout, EveryControlInTheCodeIsMarked) {
    const std::regex control(R"(ImGui::(Button|SmallButton|ArrowButton|InvisibleButton|Checkbox|RadioButton|)"
                             R"(MenuItem|BeginCombo|Combo|TreeNodeEx|InputText|SliderFloat)\()");
    const std::filesystem::path workbench = std::filesystem::path(TOUCHSTONE_SOURCE) / "workbench";
    size_t controls = 0;
    for (const char* folder : {"panels", "screen", "window"})
        for (const auto& entry : std::filesystem::directory_iterator(workbench / folder)) {
            std::ifstream file(entry.path());
            const std::vector<std::string> lines((std::istream_iterator<Line>(file)),
                                                 std::istream_iterator<Line>());
            for (size_t i = 0; i < lines.size(); ++i) {
                if (!std::regex_search(lines[i], control))
                    continue;
                ++controls;
                constexpr size_t kWithin = 24; // lines: the options of a list lie between
                bool marked = false;
                for (size_t j = i; j < std::min(lines.size(), i + kWithin); ++j)
                    marked |= lines[j].find("mark(") != std::string::npos;
                EXPECT_TRUE(marked) << entry.path() << ':' << i + 1 << ": " << lines[i];
            }
        }
    EXPECT_GT(controls, 20u);
}

TEST_F(PanelLayout, ATooltipAppearsWhenThePointerHasRestedAndGoesWithAClick) {
    begin({1280, 800, 1.0f});
    frames(4);
    point("friction");
    frames(8); // 0.27 s
    EXPECT_EQ(state_.hovered.shown, "");
    frames(12);
    EXPECT_NE(state_.hovered.shown.find("--set friction="), std::string::npos) << state_.hovered.shown;
    EXPECT_NE(state_.hovered.shown.find("stiction point"), std::string::npos) << "the text of --help";
    ImGui::GetIO().MouseDown[0] = true;
    frames(2);
    EXPECT_EQ(state_.hovered.shown, "");
    ImGui::GetIO().MouseDown[0] = false;
    point("texture");
    frames(3);
    EXPECT_EQ(state_.hovered.shown, "") << "it rests on another control first";
}

/// The audit itself: a window with mistakes in it.
TEST_F(PanelLayout, TheAuditSeesWhatIsCutCoveredOrTooSmall) {
    begin({400, 300, 1.0f});
    const auto complaintsOf = [](const std::function<void()>& draw, ImGuiWindowFlags flags = 0) {
        for (int i = 0; i < 3; ++i) {
            ImGui::NewFrame();
            ImGui::SetNextWindowPos(ImVec2(10.0f, 10.0f));
            ImGui::SetNextWindowSize(ImVec2(200.0f, 100.0f));
            ImGui::Begin("w", nullptr, flags | ImGuiWindowFlags_NoTitleBar);
            draw();
            ImGui::End();
            ImGui::Render();
        }
        std::string all;
        for (const std::string& complaint : auditText(kSmallestType))
            all += complaint + "\n";
        return all;
    };
    EXPECT_EQ(complaintsOf([] { ImGui::TextUnformatted("all is well"); }), "");
    EXPECT_NE(complaintsOf([] {
                  ImGui::TextUnformatted("a text that is wider than its window");
              }).find("cut at the side"),
              std::string::npos);
    EXPECT_NE(complaintsOf([] { ImGui::Button("cut", ImVec2(12.0f, 0.0f)); }).find("cut by its widget"),
              std::string::npos);
    EXPECT_NE(complaintsOf([] { ImGui::Button("##wide", ImVec2(300.0f, 0.0f)); }).find("wider"),
              std::string::npos);
    EXPECT_NE(complaintsOf([] { ImGui::Dummy(ImVec2(10.0f, 300.0f)); }, ImGuiWindowFlags_NoScrollbar)
                  .find("higher"),
              std::string::npos);
    EXPECT_NE(complaintsOf([] {
                  ImGui::GetWindowDrawList()->AddText(ImVec2(30.0f, 50.0f), ~0u, "one");
                  ImGui::GetWindowDrawList()->AddText(ImVec2(34.0f, 52.0f), ~0u, "two");
              }).find("overlap"),
              std::string::npos);
    EXPECT_NE(complaintsOf([] {
                  ImGui::GetWindowDrawList()->AddText(ImGui::GetFont(), 9.0f, ImVec2(30.0f, 50.0f), ~0u,
                                                      "tiny");
              }).find("high"),
              std::string::npos);
}

/// ImGui alone breaks 0.25 behind its point.
TEST_F(PanelLayout, LinesBreakBetweenWordsOnly) {
    begin({400, 300, 1.0f});
    ImGui::NewFrame();
    const float width = ImGui::CalcTextSize("less than 0.").x;
    EXPECT_EQ(brokenLines("less than 0.25 mm", width), "less than\n0.25 mm");
    EXPECT_EQ(brokenLines("a\nb", width), "a\nb");
    EXPECT_EQ(brokenLines("", width), "");
    const std::string path = brokenLines("in /home/user/models/cup.glb", width);
    for (size_t begin = 0; begin < path.size();) {
        const size_t end = std::min(path.find('\n', begin), path.size());
        EXPECT_LE(ImGui::CalcTextSize(path.substr(begin, end - begin).c_str()).x, width) << path;
        begin = end + 1;
    }
    EXPECT_EQ(brokenLines("µµµµ", 1.0f), "µ\nµ\nµ\nµ") << "whole characters";
    ImGui::EndFrame();
}

} // namespace
} // namespace touchstone::test
