#include "workbench/editor/program_editor.h"

#include "engine/core/error.h"
#include "engine/import/file/gltf_uri.h"
#include "engine/import/materials/gltf_shaders.h"
#include "engine/time/seconds_now.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace touchstone {

namespace {

using nlohmann::json;

constexpr double kSilence = 0.15; ///< s without a key before a text is compiled
constexpr const char* kValues = "parameters";

bool declares(const std::shared_ptr<const SurfaceProgram>& program, const std::string& name,
              const json& value) {
    try {
        (void)materialProgram(program, {{kValues, {{name, value}}}});
        return true;
    } catch (const Error&) {
        return false;
    }
}

/// A text that an input field can hold.
bool canBeShown(const std::string& text) {
    return text.size() <= kMaxProgramBytes && text.find('\0') == std::string::npos;
}

json plain(const KeptJson& kept) {
    return static_cast<const json&>(kept);
}

json statedValues(const json& shader) {
    const auto stated = shader.find(kValues);
    return stated != shader.end() && stated->is_object() ? *stated : json::object();
}

} // namespace

std::string dataUriOf(std::string_view text) {
    return dataUriOf("text/plain", {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

HapticStatement withProgram(HapticStatement statement, const std::shared_ptr<const SurfaceProgram>& program,
                            const json* sourceFrom) {
    json shader = plain(statement.shader);
    json values = json::object();
    const json stated = statedValues(shader);
    for (const auto& [name, value] : stated.items())
        if (declares(program, name, value))
            values[name] = value;
    shader.erase(kValues);
    if (!values.empty())
        shader[kValues] = std::move(values);
    shader.erase("bufferView");
    shader.erase("source");
    if (sourceFrom == nullptr)
        shader["source"] = dataUriOf(program->text);
    else
        for (const char* member : {"source", "bufferView"})
            if (sourceFrom->contains(member))
                shader[member] = (*sourceFrom)[member];
    statement.shader = KeptJson(std::move(shader));
    statement.program = program;
    return statement;
}

void ProgramEditor::open(const Scene& scene) {
    sources_.clear();
    timings_.clear();
    sourceOf_.clear();
    unused_.clear();
    for (const Material& material : scene.materials)
        if (material.fileIndex >= 0)
            add(static_cast<size_t>(material.fileIndex), material.says.ours, scene.path);
    std::vector<ProgramWorker::Source> known;
    for (const EditedProgram& each : sources_)
        known.push_back({each.name, each.file, each.saved});
    worker_.begin(std::move(known));
    for (size_t s = 0; s < sources_.size(); ++s)
        if (sources_[s].compiling)
            worker_.compile(s, sources_[s].text, secondsNow());
}

void ProgramEditor::add(size_t material, const HapticStatement& says, const std::filesystem::path& model) {
    sourceOf_.resize(std::max(sourceOf_.size(), material + 1), -1);
    if (says.shader.is_null() || sourceOf_[material] >= 0)
        return;
    EditedProgram source;
    if (says.program != nullptr) {
        source = {.name = says.program->source.name,
                  .file = says.program->file,
                  .program = says.program,
                  .text = says.program->text,
                  .saved = says.program->text};
    } else {
        // It does not compile, which the import has reported; here it can be corrected.
        try {
            ShaderText stated = readShaderText(model, says.shader);
            source = {.name = std::move(stated.name),
                      .file = std::move(stated.file),
                      .text = std::move(stated.text)};
        } catch (const Error&) {
        }
        if (source.name.empty() || !canBeShown(source.text))
            return;
        source.saved = source.text;
        source.compiling = true;
    }
    const auto same = std::ranges::find_if(sources_, [&](const EditedProgram& each) {
        return source.program != nullptr ? each.program == source.program
                                         : each.program == nullptr && each.name == source.name &&
                                               each.file == source.file && each.text == source.text;
    });
    sourceOf_[material] = static_cast<int>(same - sources_.begin());
    if (same != sources_.end())
        return;
    sources_.push_back(std::move(source));
    timings_.emplace_back();
}

const EditedProgram* ProgramEditor::of(size_t material) const {
    return material < sourceOf_.size() && sourceOf_[material] >= 0 ? &sources_[indexOf(material)] : nullptr;
}

void ProgramEditor::type(size_t source, std::string text) {
    ++revision_;
    sources_[source].text = std::move(text);
    sources_[source].compiling = true;
    worker_.forget(source);
    timings_[source].due = secondsNow() + kSilence;
}

void ProgramEditor::revert(size_t source) {
    type(source, sources_[source].saved);
    sources_[source].overtaken = false;
    timings_[source].due = secondsNow();
}

HapticStatement ProgramEditor::reverted(size_t material, const MaterialEdits& edits) {
    HapticStatement statement = edits.inFile(material);
    const EditedProgram* const source = of(material);
    if (source == nullptr || !source->edited())
        return statement;
    const std::shared_ptr<const SurfaceProgram>& now = edits.now(material).program;
    if (now != nullptr && !statement.shader.is_null()) {
        const json own = plain(statement.shader);
        statement = withProgram(std::move(statement), now, source->file.empty() ? nullptr : &own);
    }
    revert(indexOf(material));
    return statement;
}

void ProgramEditor::measure(size_t source) {
    // Not before it is felt: that must not wait for it.
    if (timings_[source].revision > 0 && sources_[source].felt < 0.0)
        return;
    const std::shared_ptr<const SurfaceProgram>& program = sources_[source].program;
    if (program != nullptr && std::exchange(timings_[source].measured, program) != program)
        worker_.measure(source, program);
}

bool ProgramEditor::edited() const {
    return std::ranges::any_of(sources_, [](const EditedProgram& each) { return each.edited(); });
}

bool ProgramEditor::pending() const {
    return std::ranges::any_of(sources_, [](const EditedProgram& each) { return each.compiling; });
}

std::string ProgramEditor::saveProblem() const {
    for (const EditedProgram& each : sources_)
        if (each.edited() && !each.problem.empty())
            return each.name + ": " + (each.line > 0 ? "line " + std::to_string(each.line) + ": " : "") +
                   each.problem + "; correct the program before it is saved, or revert it";
    return {};
}

std::vector<ProgramFile> ProgramEditor::unsavedFiles() const {
    std::vector<ProgramFile> files;
    for (const EditedProgram& each : sources_)
        if (each.edited() && !each.file.empty())
            files.push_back({each.file, each.text});
    return files;
}

std::vector<std::string> ProgramEditor::texts() const {
    std::vector<std::string> all;
    for (const EditedProgram& each : sources_)
        all.push_back(each.text);
    return all;
}

void ProgramEditor::saved(const std::vector<std::string>& texts) {
    for (size_t s = 0; s < std::min(texts.size(), sources_.size()); ++s) {
        sources_[s].saved = texts[s];
        sources_[s].overtaken = false;
    }
}

void ProgramEditor::moved(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::vector<ProgramWorker::Source> known;
    for (EditedProgram& each : sources_) {
        if (!each.file.empty())
            each.file = to / each.file.lexically_relative(from);
        known.push_back({each.name, each.file, each.saved});
    }
    worker_.begin(std::move(known));
    for (size_t s = 0; s < sources_.size(); ++s)
        if (sources_[s].compiling)
            worker_.compile(s, sources_[s].text, secondsNow());
}

MaterialPatches ProgramEditor::withSources(MaterialPatches patches, const MaterialEdits& edits) const {
    for (size_t m = 0; m < edits.size(); ++m)
        if (const EditedProgram* const source = of(m); source != nullptr && source->loads > 0 &&
                                                       !source->file.empty() &&
                                                       edits.now(m).program != nullptr) {
            patches[m]["shader"]["source"] = dataUriOf(edits.now(m).program->text);
            patches[m]["shader"]["name"] = source->name;
        }
    return patches;
}

void ProgramEditor::feltAt(uint64_t revision, double now) {
    for (size_t s = 0; s < sources_.size(); ++s)
        if (sources_[s].felt < 0.0 && timings_[s].revision > 0 && revision >= timings_[s].revision)
            sources_[s].felt = now - timings_[s].changed;
}

void ProgramEditor::seenAt(uint64_t revision, double now) {
    for (size_t s = 0; s < sources_.size(); ++s)
        if (sources_[s].seen < 0.0 && timings_[s].revision > 0 && revision >= timings_[s].revision)
            sources_[s].seen = now - timings_[s].changed;
}

void ProgramEditor::showFault(const program::FeltProgram* failing, const program::ProgramFault& fault) {
    for (EditedProgram& each : sources_) {
        const bool fails = failing != nullptr && each.program != nullptr && failing->compiled == each.program;
        if (fails || !each.fault.problem.empty())
            each.fault = fails ? fault : program::ProgramFault();
    }
}

/// Values that are not declared for the moment come back when they are again.
HapticStatement ProgramEditor::withKeptValues(size_t material, HapticStatement statement, json stated) {
    json& unused = unused_[material];
    if (unused.is_object())
        stated.update(unused);
    unused = stated;
    json shader = plain(statement.shader), values = json::object();
    for (const auto& [name, value] : stated.items())
        if (declares(statement.program, name, value)) {
            values[name] = value;
            unused.erase(name);
        }
    if (!values.empty())
        shader[kValues] = std::move(values);
    statement.shader = KeptJson(std::move(shader));
    return statement;
}

void ProgramEditor::takeUp(size_t source, const std::shared_ptr<const SurfaceProgram>& program, bool inFile,
                           MaterialEdits& edits) {
    EditedProgram& taken = sources_[source];
    for (size_t m = 0; m < edits.size(); ++m) {
        if (of(m) != &taken)
            continue;
        const json file = plain(edits.inFile(m).shader), stated = statedValues(edits.now(m).shader);
        const auto with = [&](HapticStatement statement) {
            if (statement.shader.is_null())
                return statement;
            const json own = plain(statement.shader);
            const json* const sourceFrom = !taken.file.empty()                            ? &own
                                           : taken.text == taken.saved && !file.is_null() ? &file
                                                                                          : nullptr;
            return withProgram(std::move(statement), program, sourceFrom);
        };
        edits.replace(m, with);
        if (!edits.now(m).shader.is_null())
            edits.replaceNow(m, withKeptValues(m, edits.now(m), stated));
        if (inFile)
            edits.replaceInFile(m, program);
    }
    taken.program = program;
    taken.cost = {};
    taken.felt = taken.seen = -1.0;
    ++taken.loads;
    timings_[source].revision = edits.revision();
}

void ProgramEditor::apply(const ProgramReport& report, MaterialEdits& edits) {
    EditedProgram& source = sources_[report.source];
    if (report.cost) {
        if (report.program == source.program)
            source.cost = *report.cost;
        return;
    }
    if (report.fromFile && source.edited() && report.text != source.text) {
        if (canBeShown(report.text))
            source.saved = report.text; // what "revert" goes back to
        source.overtaken = true;
        return;
    }
    if (!report.fromFile && report.text != source.text)
        return; // something else has been typed meanwhile
    if (report.fromFile && canBeShown(report.text)) {
        source.text = source.saved = report.text;
        source.overtaken = false;
    }
    source.compiling = timings_[report.source].due > 0.0;
    source.problem = report.problem;
    source.line = report.line;
    if (report.program == nullptr || report.program == source.program)
        return;
    timings_[report.source].changed = report.changed;
    takeUp(report.source, report.program, report.fromFile || source.text == source.saved, edits);
}

void ProgramEditor::update(MaterialEdits& edits) {
    const double now = secondsNow();
    for (size_t s = 0; s < sources_.size(); ++s)
        if (timings_[s].due > 0.0 && now >= timings_[s].due) {
            worker_.compile(s, sources_[s].text, timings_[s].due - kSilence);
            timings_[s].due = 0.0;
        }
    for (const ProgramReport& report : worker_.take())
        apply(report, edits);
}

} // namespace touchstone
