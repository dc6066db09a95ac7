#include "haptics/texture/texture_copy.h"

namespace touchstone {

void TextureCopy::follow(const std::shared_ptr<PersistentTextures>& servo) {
    if (servo == servo_)
        return;
    servo_ = servo;
    copy_ = servo != nullptr ? servo->fresh() : nullptr;
    strokes_.clear();
    waiting_.reset();
    lost_ = false;
}

std::span<const BrushStroke> TextureCopy::next(uint64_t tick) {
    if (servo_ == nullptr)
        return {};
    if (!strokes_.empty())
        copy_->takeTiles(*servo_, strokes_.front().tick);
    copy_->apply(strokes_);
    strokes_.clear();
    BrushStroke stroke;
    while (waiting_ || servo_->popStroke(stroke)) {
        if (waiting_) {
            stroke = *waiting_;
            waiting_.reset();
        }
        if (stroke.tick > tick) {
            waiting_ = stroke;
            break;
        }
        copy_->takeTiles(*servo_, stroke.tick);
        if (stroke.tick == tick)
            strokes_.push_back(stroke);
        else
            copy_->apply({&stroke, 1});
    }
    copy_->takeTiles(*servo_, tick);
    lost_ = copy_->lacks(*servo_);
    return strokes_;
}

} // namespace touchstone
