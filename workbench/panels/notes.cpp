#include "workbench/panels/notes.h"

#include "haptics/settings/haptic_settings.h"
#include "workbench/editor/haptic_fields.h"
#include "workbench/editor/presets.h"

#include <algorithm>
#include <array>

namespace touchstone {

namespace {

struct Note {
    std::string_view name; ///< of the widget; with ':' or '.' at its end: of all whose names begin so
    std::string_view text;
    std::string_view setting = ""; ///< its meaning follows the text
};

constexpr std::array kNotes{
    // The bar.
    Note{"file", "Open a model or a recording, save the picture, quit"},
    Note{"menu:open", "Open a model (glTF, OBJ, STL, PLY), a volume or a recording (Ctrl+O)"},
    Note{"menu:recordings", "List the recordings in the panel below"},
    Note{"histogram", "Voxels by value, on a logarithmic scale; the line is the surface"},
    Note{"iso", "The value at the surface that is seen and felt; inside are the higher ones"},
    Note{"animation", "The model's animation that is seen and felt; choosing another begins touch again"},
    Note{"playAnimation", "Lets the animation stand still or go on"},
    Note{"animationTime", "Where the animation is"},
    Note{"animationSpeed", "Seconds of the animation in one second; below 0 it goes backwards"},
    Note{"gallery", "Our scenes and recent files as pictures"},
    Note{"sculpt",
         "The hand sculpts what is felt as a field, while the left button, D or the first button of a "
         "device is held"},
    Note{"sculpt:tool:carve", "Takes the ball at the tip away; Ctrl adds"},
    Note{"sculpt:tool:add", "Lays the ball on the surface, where it is touched; Ctrl carves"},
    Note{"sculpt:tool:smooth", "Evens out what is smaller than the ball; Shift, with any tool"},
    Note{"sculpt:tool:stamp", "Joins the shape of an object where the button goes down; Ctrl takes it out"},
    Note{"sculpt:tool:imprint", "Takes the shape of an object out where the button goes down; Ctrl joins it"},
    Note{"sculpt:tool:drag", "Moves the surface along with the tip"},
    Note{"sculpt:tool:paint",
         "Colours the surface within the ball, where it is touched (I); Ctrl takes colour off"},
    Note{"sculpt:color", "Of the paint; the material's colour is multiplied by it"},
    Note{"sculpt:stamp", "The object whose shape is stamped or imprinted, as large as the radius says"},
    Note{"sculpt:radius", "Of the tool, in the workspace; hold F and move the pointer"},
    Note{"sculpt:strength",
         "The fraction of the whole change that one dab makes; hold Shift+F and move the pointer"},
    Note{"sculpt:falloff", "The outer part of the radius in which the strength falls to zero"},
    Note{"sculpt:undo", "Take the last stroke back (Ctrl+Z)"},
    Note{"sculpt:redo", "Make it again (Ctrl+Shift+Z, Ctrl+Y)"},
    Note{"sculpt:saveAs", "Save the sculpted object: .glb (mesh) or .vdb (level set)"},
    Note{"sample:", "Open this scene of ours"},
    Note{"menu:recent:", "Open this file again"},
    Note{"menu:savePicture", "Save what the window shows of the model, as PNG"},
    Note{"menu:quit", "Close the window; asks first where materials are not saved"},
    Note{"viewMenu", "What the picture shows, which panels are open, the size of type"},
    Note{"view", "What the colours of the model show; V is the next one"},
    Note{"showProbe", "Hand (red) and proxy (blue)"},
    Note{"showShadow", "Shadow of the proxy on what is below it"},
    Note{"showForce", "The force as an arrow, 40 mm for a newton"},
    Note{"showPlanes", "The constraint planes that hold the proxy"},
    Note{"showFriction", "Stiction point and friction cone"},
    Note{"showNormal", "The normal that is felt"},
    Note{"wireframe", "Edges of the triangles over the surface"},
    Note{"grid", "Grid on the ground beneath the model; its spacing stands in the picture"},
    Note{"axes", "Axes in the picture's corner: a click looks along one"},
    Note{"axis:", "Look from this side"},
    Note{"orthographic", "Parallel lines of sight: lengths compare wherever they are"},
    Note{"slice", "What is felt as a field, in a slice: isolines of the distance (the surface white, inside "
                  "blue, outside orange) and arrows along the gradient (X)"},
    Note{"slice:place", "Where the slice lies, from one end of the field to the other"},
    Note{"clip", "Cut the model: what lies beyond the plane is neither seen nor felt"},
    Note{"clip:x", "Cut across x, through the middle"},
    Note{"clip:y", "Cut across y, through the middle"},
    Note{"clip:z", "Cut across z, through the middle"},
    Note{"clip:view", "Cut across the view, through the middle"},
    Note{"clip:flip", "Keep the other side"},
    Note{"clip:place", "Where the plane stands, in the model's own metres"},
    Note{"magnifier", "A second view of the 12 mm around the probe"},
    Note{"turntable", "The camera circles the model once in 12.6 s"},
    Note{"camera:all", "Show the whole model (Home)"},
    Note{"camera:front", "Look from the front (1)"},
    Note{"camera:right", "Look from the right (3)"},
    Note{"camera:top", "Look from above (7)"},
    Note{"camera:near", "Go near the probe (.)"},
    Note{"savePicture", "F12: save what the window shows of the model, drawn anew as PNG"},
    Note{"pictureSize", "Size of the saved pictures"},
    Note{"panel:", "Show or fold this panel"},
    Note{"uiScale", "Size of type and widgets beside what the monitor asks for; kept for the next run"},
    Note{"smaller", "Smaller type and widgets (Ctrl+Shift+-)"},
    Note{"larger", "Larger type and widgets (Ctrl+Shift++)"},
    Note{"forceShading", "Force shading off and on (F5); the panel on the right has its model",
         "forceShading"},
    Note{"texture", "Texture off and on (F6); the panel on the right has its law", "texture"},
    Note{"friction", "Friction off and on (F7); the panel on the right has its law", "friction"},
    Note{"forceEnabled", "Force off and on (Space)", "forceEnabled"},
    Note{"record", "Record every tick, for `touchstone replay` (F9)"},
    Note{"servo", "Rate of the servo and 99th percentile of the time of its step; green: the rate is kept"},
    Note{"help", "All keys (F1)"},
    Note{"helpClose", "Back to the window (Escape)"},
    Note{"fold:", "Fold or unfold this panel (F2, F3, F4)"},
    // The hand.
    Note{"mouse", "The mouse is the hand: left button presses on the model, wheel sets how hard (F8)"},
    Note{"simulatedHand", "A simulated hand strokes the model (F8)"},
    Note{"freeHand", "The mouse moves its hand free in space: drag in the view's plane, wheel in depth (G)"},
    Note{"device", "A plugged-in device is the hand"},
    Note{"device:", "Touch with this device"},
    Note{"stroke", "How the simulated hand strokes (N, Shift+N)"},
    Note{"strokeSpeed", "Speed of the hand on the surface at its fastest"},
    Note{"strokeDepth", "How far the hand presses in"},
    Note{"zoom", "Way of the hand in the model over way of the device (Page Up, Page Down)"},
    Note{"clutch", "While held, the device moves and the hand stays (C)"},
    Note{"centre", "The device's place now is the middle of the model (Shift+C)"},
    // The scene.
    Note{"model", "The open file"},
    Note{"node:", "A node of the file; green while it is touched"},
    Note{"eye:", "Hide this object and what is below it, or show it; a hidden one is not felt"},
    Note{"hideObject", "Neither see nor feel this object and what is below it; or both again"},
    Note{"isolateObject", "See and feel this object alone"},
    Note{"showAllObjects", "See and feel all objects"},
    Note{"dismissNotice", "Remove this note"},
    Note{"editMaterials", "Change what the materials feel like, and save it (E)"},
    Note{"material", "Material under the probe"},
    // What is felt.
    Note{"lamp", "State of the touch"},
    Note{"force", "Force on the hand now, before the safety stage"},
    Note{"sent", "What the safety stage sends to the device"},
    Note{"passivity", "Damp what the device gives the hand beyond what it took", "passivity"},
    Note{"sound", "Make the force audible; texture sounds as it is stroked (S)"},
    Note{"volume", "Volume of the sound"},
    Note{"soundStatus", "The sound card, and how long after the force it sounds"},
    Note{"budget", "Time of a step by stage over the last 4000 ticks in contact: the median, the 99th "
                   "percentile, and its part of the servo's period"},
    Note{"budgetLegend", "Median and 99th percentile of each stage over the last 4000 ticks in contact"},
    Note{"error",
         "Difference from the most exact methods over the last 2 s, run beside the servo on the same "
         "hand; noticed: from what on people feel it (docs/accuracy.md)"},
    Note{"shadingModel", "Model of force shading", "forceShading"},
    Note{"textureLaw", "Force law of texture", "texture"},
    Note{"frictionLaw", "Law of friction", "friction"},
    Note{"servoRate", "Ticks of the last second, and the rate asked for"},
    Note{"servoMissed", "Ticks whose step ended after the next deadline, of all ticks"},
    Note{"servoStolen", "Time that the host took away from this machine, all processors"},
    Note{"servoPicture", "Pictures drawn in a second"},
    // Charts and recordings.
    Note{"live", "Charts of the last 10 s"},
    Note{"recorded", "Recordings, and the timeline of the open one"},
    Note{"pause", "Hold the charts; the servo goes on (P)"},
    Note{"strips", "Which quantities are charted; drag the panel's upper edge to make the strips taller"},
    Note{"strip:", "Chart this quantity"},
    Note{"saveCsv", "Every tick of the charts with all quantities, in SI units"},
    Note{"savePng", "The strips as they are on the screen"},
    Note{"saveSvg", "The charted quantities as a figure with axes and legend, by gnuplot"},
    Note{"chartOutcome", "The recording, or what became of the last file"},
    Note{"charts", "The pointer reads the values of a tick"},
    Note{"chartsEdge", "Drag: taller or lower charts"},
    Note{"sceneEdge", "Drag: a wider panel; a double click: as wide as it was"},
    Note{"feltEdge", "Drag: a wider panel; a double click: as wide as it was"},
    Note{"recordings", "The list of recordings"},
    Note{"recordingName", "The new name; Enter renames, Escape keeps the old one"},
    Note{"rename:", "Rename this recording"},
    Note{"delete:", "Delete this recording; asks first"},
    Note{"deleteNo", "Keep the recording"},
    Note{"deleteYes", "Delete the recording for good"},
    Note{"recording:", "Open this recording"},
    Note{"timeline", "The whole recording; drag moves the cursor"},
    Note{"near", "The part near the cursor; drag, wheel: more or less of it"},
    Note{"recordingNews", "The open recording, and what became of a replay"},
    Note{"toBegin", "First tick (Home)"},
    Note{"toEnd", "Last tick (End)"},
    Note{"stepBack", "A tick back (Left); 100 ms with Shift"},
    Note{"stepOn", "A tick on (Right); 100 ms with Shift"},
    Note{"play", "Play and pause (K)"},
    Note{"speed", "Speed of playing, as a multiple of real time"},
    Note{"speed:", "Play this fast"},
    Note{"markBegin", "The loop begins at the cursor (A)"},
    Note{"markEnd", "The loop ends at the cursor (B)"},
    Note{"clearMarks", "No loop (Shift+A)"},
    Note{"verify", "Replay all ticks as fast as possible and compare every bit"},
    Note{"compare", "Touch the whole recording again with the settings of now, without a hand: the green "
                    "curve beside the recorded one"},
    Note{"touchAgain", "The recorded hand touches again, with the settings and materials of now"},
    Note{"openModel", "Open the model of the recording"},
    Note{"backToLive", "Leave the recording (Escape)"},
    // Cards and gallery.
    Note{"savedPicture", "Where the last picture is"},
    Note{"gotIt", "Put this strip away for good"},
    Note{"otherModels", "Our scenes and recent files as pictures"},
    Note{"cancel", "Keep the model that is open"},
    Note{"dismiss", "Put this message away (Escape)"},
    Note{"leaveSave", "Save the materials into the file, then go on"},
    Note{"leaveDiscard", "Lose the changes of the materials, and go on"},
    Note{"leaveStay", "Keep the model that is open"},
    Note{"galleryClose", "Back to the model (Escape)"},
    Note{"gallery:", "Open this scene of ours"},
    Note{"recent:", "Open this file again"},
    // Files.
    Note{"openPath", "Narrows the list, or is a path (~ works); Enter opens it"},
    Note{"open", "Open, or save under, what is chosen or typed"},
    Note{"fileClose", "Close the browser (Escape)"},
    Note{"fileUp", "The folder above (Alt+Up)"},
    Note{"fileKind", "Which files are listed"},
    Note{"file:", "A folder or a file; a double click opens it"},
    Note{"place:", "Go to this folder"},
    Note{"fileReplace", "Replace the file that is there"},
    Note{"fileKeep", "Keep the file, choose another name"},
    Note{"browseHere", "Choose in the window instead of the desktop's dialog"},
    Note{"dialogCancel", "Open nothing"},
    // The material editor.
    Note{"edit.material", "The material that is edited"},
    Note{"edit.preset", "Numbers of a known material to begin with"},
    Note{"followProbe", "Edit the material that is touched"},
    Note{"program.edit", "The program's source; what compiles is felt and seen at once"},
    Note{"program.text",
         "GLSL (docs/programs.md); compiled when nothing has been typed for 0.15 s; Space also "
         "switches the force off"},
    Note{"program.revert", "Back to the source that the file has"},
    Note{"reset.", "Back to what holds when the file states nothing"},
    Note{"undo", "Take the last change back (Ctrl+Z)"},
    Note{"redo", "Make it again (Ctrl+Shift+Z)"},
    Note{"resetMaterial", "Take back all changes of this material"},
    Note{"save", "Save into the file (Ctrl+S)"},
    Note{"saveAs", "Save under another name"},
};

std::string settingNote(std::string_view name) {
    const auto* field = findField(settingFields(), name);
    if (field == nullptr)
        return {};
    return std::string(field->meaning) + "\n--set " + std::string(name) + "=" + allowedValues(*field) +
           (field->unit.empty() ? "" : " " + std::string(field->unit));
}

template <class Fields>
std::string meaningIn(const Fields& fields, std::string_view name) {
    const auto found = std::ranges::find(fields, name, [](const auto& field) { return field.name; });
    return found != fields.end() ? std::string(found->meaning) : std::string();
}

/// Of a field of the material editor.
std::string fieldNote(std::string_view name) {
    for (std::string meaning :
         {meaningIn(numberFields(), name), meaningIn(mapFields(), name), meaningIn(choiceFields(), name)})
        if (!meaning.empty())
            return meaning + "\n`touchstone edit --field " + std::string(name) + "=VALUE`";
    return {};
}

bool names(const Note& note, std::string_view name) {
    const bool group = note.name.ends_with(':') || note.name.ends_with('.');
    return group ? name.starts_with(note.name) : name == note.name;
}

} // namespace

std::string noteOf(std::string_view name) {
    if (const auto note = std::ranges::find_if(kNotes, [&](const Note& n) { return names(n, name); });
        note != kNotes.end()) {
        const std::string setting = settingNote(note->setting);
        return std::string(note->text) + (setting.empty() ? "" : "\n" + setting);
    }
    constexpr std::string_view kField = "edit.", kPreset = "preset.";
    if (name.starts_with(kField))
        return fieldNote(name.substr(kField.size()));
    if (name.starts_with(kPreset))
        if (const MaterialPreset* preset = findPreset(name.substr(kPreset.size())))
            return std::string(preset->reason);
    return settingNote(name);
}

bool isArea(std::string_view name) {
    constexpr std::array kAreas{"picture", "charts", "timeline", "near", "recordingNews", "program.text"};
    return std::ranges::find(kAreas, name) != kAreas.end();
}

} // namespace touchstone
