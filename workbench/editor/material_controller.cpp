#include "workbench/editor/material_controller.h"

#include "engine/save/replace_file.h"

#include <chrono>
#include <exception>
#include <utility>

namespace touchstone {

void MaterialController::watch(const Model& shown, const PersistentTextures* textures) {
    textures_.look(textures);
    shown_ = shown;
    shownTextures_ = textures;
}

void MaterialController::open(const Model& model, bool replaceable) {
    live_.discard();
    tell("", false);
    if (saving_.valid())
        finishSaving(); // keeps the notice of a failure
    wanted_.clear();
    textures_ = {};
    shown_ = {};
    shownTextures_ = nullptr;
    edits_ = MaterialEdits(*model.scene);
    programs_.open(*model.scene);
    materials_ = model.scene->materials;
    touched_ = seen_ = edits_.revision();
    path_ = model.scene->path;
    stamp_ = model.scene->file;
    replaceable_ = replaceable;
    saved_.reset();
}

void MaterialController::tell(std::string notice, bool failed) {
    notice_ = std::move(notice);
    failed_ = failed;
}

void MaterialController::startWork(const Model& model) {
    MaterialJob job;
    job.model = model;
    job.compiledFrom = materials_;
    job.statements = edits_.all();
    job.edits = textOf(programs_.withSources(edits_.patches(), edits_));
    job.path = path_;
    job.stamp = stamp_;
    job.revision = edits_.revision();
    job.forTheEye = !edits_.inGesture();
    live_.start(std::move(job));
}

std::optional<MadeMaterials> MaterialController::update(const Model& model) {
    if (saving_.valid() && saving_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
        finishSaving();
    programs_.update(edits_);
    std::optional<MadeMaterials> made;
    try {
        made = live_.take();
    } catch (const std::exception& error) {
        tell(error.what(), true);
        touched_ = seen_ = edits_.revision(); // not again until the next change
    }
    if (made) {
        materials_ = made->materials;
        touched_ = made->revision;
        if (made->scene != nullptr)
            seen_ = made->revision;
        seconds_ = made->seconds;
        return made; // the next job starts from the caller's model
    }
    const bool behind = touched_ != edits_.revision() || (!edits_.inGesture() && seen_ != edits_.revision());
    if (live_.busy() || saving_.valid())
        return std::nullopt;
    if (behind)
        startWork(model);
    else if (!wanted_.empty() && !programs_.pending())
        startSaving(std::exchange(wanted_, {}));
    return std::nullopt;
}

void MaterialController::saveAs(const std::filesystem::path& target) {
    edits_.endGesture();
    wanted_ = target;
}

/// Only once the last change is in effect: the worker may be reading the file, and a recording is informed
/// that the file holds what is touched.
void MaterialController::startSaving(const std::filesystem::path& target) {
    if (std::string problem = programs_.saveProblem(); !problem.empty())
        return tell(std::move(problem), true);
    savingStatements_ = edits_.all();
    savingTexts_ = programs_.texts();
    target_ = target;
    tell("", false);
    TexturesToSave textures;
    if (shownTextures_ != nullptr)
        textures = texturesToSave(*shown_.scene, *shown_.haptic, shownTextures_);
    savingTextures_ = textures_.revision();
    const bool elsewhere = !inOneFolder(path_, target);
    saving_ = std::async(std::launch::async, [source = path_, stamp = stamp_, patches = edits_.patches(),
                                              target, programs = programs_.unsavedFiles(),
                                              textures = std::move(textures), elsewhere] {
        if (!elsewhere)
            for (const ProgramFile& program : programs)
                replaceFile(program.file,
                            {reinterpret_cast<const uint8_t*>(program.text.data()), program.text.size()});
        return saveMaterials(source, stamp, withTextures(patches, textures), target, programs);
    });
}

void MaterialController::finishSaving() {
    try {
        stamp_ = saving_.get();
        if (!inOneFolder(path_, target_))
            programs_.moved(path_.parent_path(), target_.parent_path());
        path_ = target_;
        textures_.saved(savingTextures_);
        replaceable_ = true;
        edits_.saved(std::move(savingStatements_));
        programs_.saved(savingTexts_);
        saved_ = stamp_;
        tell("saved to " + path_.string(), false);
    } catch (const std::exception& error) {
        tell(error.what(), true);
    }
}

} // namespace touchstone
