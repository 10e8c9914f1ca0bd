// The finger pads: two discs with rounded edges whose flat faces look at each other along the grip's x axis.
#pragma once

#include <memory>

#include "device/contact/proxy/tool.h"
#include "device/contact/shapes/tool_shape.h"

namespace spidar {

// In proportion to the open jaws: those of 80 mm have pads of 24 mm across and 6 mm thick.
[[nodiscard]] inline double pad_radius_m(const Jaws &jaws) noexcept {
    return 0.15 * jaws.open_m;
}
[[nodiscard]] inline double pad_thickness_m(const Jaws &jaws) noexcept {
    return 0.075 * jaws.open_m;
}

class Pads {
public:
    Pads() { fit(Jaws()); }

    // Makes their shape anew when the jaws are others.
    void fit(const Jaws &jaws);
    [[nodiscard]] const std::shared_ptr<const ToolShape> &shape() const noexcept { return shape_; }

    // The tool of the bare pads.
    [[nodiscard]] Tool tool(const Jaws &jaws) const noexcept;

    // x outward from the middle of the inner face; side 0 at -x of the grip.
    [[nodiscard]] static Placement face(int side, const Jaws &jaws, const ToolPose &pose) noexcept;

private:
    std::shared_ptr<const ToolShape> shape_;
    double open_m_ = 0.0; // of the jaws that they fit
};

} // namespace spidar
