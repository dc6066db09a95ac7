#pragma once

#include "workbench/dialog/file_dialog.h"
#include "workbench/panels/widgets.h"

namespace touchstone {

/// The browser over everything but the bar, the question before a file is replaced, or a card while the
/// desktop's dialog is open. Keys: arrows and Enter, Escape closes, Alt + Up goes to the folder above. Widget
/// names: "openPath" (the text), "open", "fileUp", "fileKind", "place:NAME", "file:NAME", "fileClose",
/// "fileReplace", "fileKeep", "browseHere", "dialogCancel". `covered`: by another card, which has the keys.
/// Main thread, within an ImGui frame.
void drawFileDialog(FileDialog& dialog, const WidgetRect& place, const WidgetRect& picture, bool covered,
                    Widgets& widgets);

} // namespace touchstone
