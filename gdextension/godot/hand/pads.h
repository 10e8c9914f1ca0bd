// Finger pads: two discs with rounded edges, flat faces opposed along the grip's x axis.
#pragma once

#include <memory>

#include "device/contact/proxy/tool.h"
#include "device/contact/shapes/tool_shape.h"

namespace spidar {

// Radius in proportion to the open jaws: jaws of 80 mm have pads 24 mm across.
[[nodiscard]] inline double pad_radius_m(const Jaws &jaws) noexcept {
    return 0.15 * jaws.open_m;
}
// Thickness in proportion to the open jaws: 6 mm for jaws of 80 mm.
[[nodiscard]] inline double pad_thickness_m(const Jaws &jaws) noexcept {
    return 0.075 * jaws.open_m;
}

class Pads {
public:
    Pads() { fit(Jaws()); }

    // Makes the pads' shape again when the jaws have changed.
    void fit(const Jaws &jaws);
    [[nodiscard]] const std::shared_ptr<const ToolShape> &shape() const noexcept { return shape_; }

    // Returns the tool that consists of the pads only.
    [[nodiscard]] Tool tool(const Jaws &jaws) const noexcept;

    // Frame of a pad's inner face, x outward from its center. Side 0 lies at -x of the grip.
    [[nodiscard]] static Placement face(int side, const Jaws &jaws, const ToolPose &pose) noexcept;

private:
    std::shared_ptr<const ToolShape> shape_;
    double open_m_ = 0.0; // opening of the jaws that the pads fit
};

} // namespace spidar
