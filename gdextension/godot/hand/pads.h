// The finger pads: two discs with rounded edges whose flat faces look at each other along the grip's x axis.
#pragma once

#include <memory>

#include "device/contact/proxy/tool.h"
#include "device/contact/shapes/tool_shape.h"

namespace spidar {

inline constexpr double kPadRadius_m = 0.012;
inline constexpr double kPadThickness_m = 0.006;

class Pads {
public:
    Pads() : shape_(make_pad(kPadRadius_m, 0.5 * kPadThickness_m, 0.5 * kPadThickness_m).tool) {}

    [[nodiscard]] const std::shared_ptr<const ToolShape> &shape() const noexcept { return shape_; }

    // The tool of the bare pads.
    [[nodiscard]] Tool tool(const Jaws &jaws) const noexcept;

    // x outward from the middle of the inner face; side 0 at -x of the grip.
    [[nodiscard]] static Placement face(int side, const Jaws &jaws, const ToolPose &pose) noexcept;

private:
    std::shared_ptr<const ToolShape> shape_;
};

} // namespace spidar
