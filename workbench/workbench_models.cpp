#include "engine/import/mesh_file/mesh_format.h"
#include "workbench/workbench_window.h"

namespace touchstone {

void WorkbenchWindow::open(const std::filesystem::path& path, const SceneChoice& choice) {
    ++opened_;
    problem_.clear();
    state_.gallery = false;
    if (isRecording(path))
        return timeline_.open(path);
    longestFrame_ = 0.0;
    if (hasModel()) { // the first one plays as the command line states
        const HapticSettings usual;
        state_.settings.animationSpeed = usual.animationSpeed;
        state_.settings.animationOffset = usual.animationOffset;
    }
    opening_.start(path, screen_.renderer(), choice);
}

void WorkbenchWindow::takeAnotherDevice(const DeviceLost& lost) {
    problem_ = "The graphics device was lost (" + lost.problem() +
               "). What is felt went on; the picture is made anew.";
    drawn_.takeDevice();
    picture_.takeDevice();
    environment_.takeDevice();
    for (std::optional<DeviceLost> why = lost; why;)
        try {
            screen_.renew(*std::exchange(why, std::nullopt), secondsNow());
            quality_ = qualityOn(screen_.gpu());
            keptQuality_ = keptQuality();
            opening_.takeDevice(screen_.renderer());
        } catch (const DeviceLost& again) {
            why = again;
        }
}

void WorkbenchWindow::takeModel() {
    // Edits made while it was loading prompt, too.
    if (opening_.arriving() && hasModel() &&
        (materials_.saving() || !unsavedChanges_.mayLeave(opening_.path(), materials_, state_)))
        return;
    try {
        if (std::optional<LoadedModel> loaded = opening_.update(screen_.renderer()))
            show(*std::move(loaded));
    } catch (const DeviceLost&) {
        throw;
    } catch (const Error& error) {
        stayWithout(error.what());
    } catch (const std::bad_alloc&) {
        stayWithout(opening_.path().filename().string() + ": there is not enough memory for it");
    }
}

void WorkbenchWindow::stayWithout(const std::string& problem) {
    if (!hasModel() && (opened_ <= 1 || opening_.path() == defaultScene()))
        throw;
    unsavedChanges_.begin(); // what was to be discarded is still there
    problem_ = problem;
    if (!hasModel()) // it was chosen while the first one was on its way
        opening_.start(defaultScene(), screen_.renderer(), {});
}

void WorkbenchWindow::show(LoadedModel loaded) {
    const ScenePtr scene = loaded.model.scene;
    // Another surface of the volume that is shown: it is looked at from the same side, and what is hidden or
    // cut stays so.
    const bool sameVolume =
        hasModel() && scene->volume != nullptr && scene->volume == touch_.shown().model.scene->volume;
    notice_.clear();     // of the previous model
    if (dialog_.saves()) // what it asks about was that model's
        dialog_.close();
    touch_.show(std::move(loaded), scene->path == defaultScene().string());
    drawn_.shown(scene);
    unsavedChanges_.begin();
    materials_.open(touch_.shown().model,
                    !isSample(scene->path) && !meshFormatNamed(scene->path) && scene->volume == nullptr);
    nameAfter(scene->path);
    if (sameVolume)
        return;
    view_.lookAt(workspaceBounds(touch_.shown().model), aspect());
    state_.view.part = {};
    try {
        state_.view.part = partNamed(*scene, std::exchange(firstPart_, {}));
    } catch (const Error& error) {
        problem_ = error.what();
    }
}

void WorkbenchWindow::nameAfter(const std::filesystem::path& file) {
    memory_.opened(std::filesystem::absolute(file));
    remember();
    window_.setTitle(file.string() + " – Touchstone");
}

void WorkbenchWindow::takeMaterials() {
    if (!hasModel())
        return;
    materials_.watch(touch_.shown().model, touch_.recording().recorder().textures());
    if (const std::optional<FileStamp> saved = materials_.takeSaved()) {
        touch_.saved(materials_.path(), *saved, textOf(materials_.edits().patches()));
        nameAfter(materials_.path());
    }
    if (const std::optional<MadeMaterials> made = materials_.update(touch_.whole())) {
        if (made->read)
            drawn_.renew(); // it has other images
        touch_.change(*made);
    }
}

void WorkbenchWindow::leaveFor(const std::filesystem::path& path) {
    if (isRecording(path) || unsavedChanges_.mayLeave(path, materials_, state_))
        open(path);
}

void WorkbenchWindow::leave() {
    const std::optional<UnsavedChangesPrompt::Answer> answer =
        unsavedChanges_.update(materials_, state_, problem_);
    if (!answer)
        return;
    // What is on its way is not opened again: a volume would come with another iso value than the one chosen.
    const bool onItsWay = opening_.busy() && answer->target == opening_.path();
    if (onItsWay && !answer->go)
        opening_.cancel(screen_.renderer());
    if (onItsWay || !answer->go)
        return;
    if (!answer->target.empty())
        return open(answer->target);
    left_ = true;
    window_.close();
}

void WorkbenchWindow::askForFile(FilePurpose purpose) {
    const auto isOwn = [this](const std::filesystem::path& file) {
        return std::ranges::find(samples_, file) != samples_.end();
    };
    const auto last = std::ranges::find_if_not(memory_.recent, isOwn);
    FileRequest request{.purpose = purpose,
                        .folder = last == memory_.recent.end() ? typedPath("~", {}) : last->parent_path(),
                        .name = {},
                        .ending = ".glb",
                        .places = usualPlaces(samples_, memory_.recent)};
    if (purpose == FilePurpose::SaveMaterials) {
        const std::filesystem::path file = std::filesystem::absolute(materials_.path());
        if (!isOwn(file))
            request.folder = file.parent_path();
        // A file with a suggested name of its own, so that Enter alone replaces nothing.
        const bool mesh = meshFormatNamed(file).has_value();
        request.ending = mesh ? ".glb" : file.extension().string();
        request.name = file.stem().string() + (mesh ? "" : "-felt") + request.ending;
    }
    if (purpose == FilePurpose::SaveSculpture)
        request.name = materials_.path().stem().string() + "-sculpted.glb";
    state_.gallery = state_.help = false; // nothing covers it
    dialog_.ask(std::move(request));
}

void WorkbenchWindow::takeFile(double now) {
    if (std::exchange(state_.openPressed, false))
        askForFile(FilePurpose::Open);
    if (std::exchange(materialState_.saveAsPressed, false) && hasModel())
        askForFile(FilePurpose::SaveMaterials);
    if (std::exchange(state_.sculpt.saveAs, false) && hasModel())
        askForFile(FilePurpose::SaveSculpture);
    if ((state_.gallery || state_.leaving) && dialog_.covers())
        dialog_.close(); // one thing at a time has the keyboard
    const std::optional<FileChoice> choice = dialog_.update(now);
    if (!choice)
        return;
    if (choice->purpose == FilePurpose::Open)
        leaveFor(choice->path);
    else if (choice->purpose == FilePurpose::SaveSculpture)
        touch_.sculpt().saveAs(choice->path);
    else
        materials_.saveAs(choice->path);
}

void WorkbenchWindow::lookBack(double now) {
    const ServoRecorder& recorder = touch_.recording().recorder();
    timeline_.update({.now = now,
                      .model = hasModel() ? &touch_.shown().model : nullptr,
                      .open = hasModel() ? &touch_.shown().identity : nullptr,
                      .live = &touch_.forces(),
                      .servoTime = touch_.tick().time,
                      .settings = &state_.settings,
                      .listed = state_.timeline.shown,
                      .recorded = recorder.recording() ? recorder.file() : std::filesystem::path()});
    // Switching off and on clears a latch, which must not happen unintentionally: the force then stays off.
    if (timeline_.looking() && has(touch_.tick().output.flags, TickFlag::SafetyLatched))
        state_.settings.forceEnabled = false;
    if (const std::optional<Error> problem = timeline_.takeProblem()) {
        if (!hasModel() && !opening_.busy())
            throw *problem;
        problem_ = problem->what();
    }
    if (const auto model = timeline_.takeModelWanted())
        leaveFor(*model);
}

void WorkbenchWindow::showMaterials() {
    if (opening_.uploading())
        return drawn_.interrupt();
    try {
        const Model& model = touch_.shown().model;
        drawn_.update(screen_.renderer(), model.scene, showsHaptics(state_.view.mode, model.part));
        drawn_.showPrograms(screen_.renderer(), materials_.materials(), materials_.touched());
    } catch (const DeviceLost&) {
        throw;
    } catch (const std::exception& error) {
        problem_ = std::string("the view could not be made anew: ") + error.what();
    }
}

} // namespace touchstone
