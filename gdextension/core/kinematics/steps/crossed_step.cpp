#include "core/kinematics/steps/crossed_step.h"

namespace spidar {

bool make_layout(const FrameGeometry &frame, const GripGeometry &grip,
                 CrossedLayout &layout) noexcept {
    if (grip.kind != GripKind::crossed) {
        return false;
    }
    CrossedLayout made;
    std::array<std::array<std::size_t, 2>, 2> filled{}; // [end][pole]
    for (std::size_t i = 0; i < kStringCount; ++i) {
        const auto pole = static_cast<std::size_t>(grip.attachments[i].pole);
        const std::size_t end = grip.attachments[i].sign > 0.0 ? 0 : 1;
        std::size_t &count = filled[end][pole];
        if (count == 2) {
            return false; // a third string at one end: another end has too few
        }
        const std::size_t slot = 2 * end + count++;
        made.strings[slot][pole] = static_cast<std::uint8_t>(i);
    }
    for (std::size_t slot = 0; slot < kSlotCount; ++slot) {
        made.motors_m[slot] =
            lanes_of(frame.motors_m[made.strings[slot][0]], frame.motors_m[made.strings[slot][1]]);
    }
    made.pole_half_length_m = grip.pole_half_length_m;
    layout = made;
    return true;
}

} // namespace spidar
