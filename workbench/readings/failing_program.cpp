#include "workbench/readings/failing_program.h"

#include <utility>

namespace touchstone {

void FailingProgram::take(const TickRecord& record, const HapticSettings& settings) {
    (void)settings;
    time_ = record.time;
    // A scene that is offered has other programs than the ticks before it.
    if (record.root != scene_.number || !has(record.output.flags, TickFlag::ProgramFailed))
        return;
    end_ = record.output.programEnd;
    failedAt_ = record.time;
}

void FailingProgram::flush(double now) {
    (void)now;
    const auto object = static_cast<size_t>(end_.object);
    std::shared_ptr<const program::FeltProgram> program;
    if (time_ - failedAt_ < kShown && end_.object >= 0 && scene_.haptic != nullptr &&
        object < scene_.haptic->objects.size())
        program =
            scene_.haptic->materials[static_cast<size_t>(scene_.haptic->objects[object]->material)].program;
    if (program == program_ && end_ == explained_)
        return;
    program_ = std::move(program);
    explained_ = end_;
    fault_ = program_ != nullptr ? program::faultOf(*program_, end_) : program::ProgramFault();
}

} // namespace touchstone
