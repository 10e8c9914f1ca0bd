// Finger pads: two discs with rounded edges, flat faces opposed along the grip's x axis.
#pragma once

#include <memory>

#include "device/contact/proxy/tool.h"
#include "device/contact/shapes/tool_shape.h"

namespace spidar {

// The radius is proportional to the opening of the jaws: an opening of 80 mm has pads 24 mm across.
[[nodiscard]] inline double pad_radius_m(const Jaws &jaws) noexcept {
    return 0.15 * jaws.open_m;
}
// The thickness is proportional to the opening of the jaws: 6 mm for an opening of 80 mm.
[[nodiscard]] inline double pad_thickness_m(const Jaws &jaws) noexcept {
    return 0.075 * jaws.open_m;
}

class Pads {
public:
    Pads() { fit(Jaws()); }

    // Makes the pads' shape again if jaws.open_m has changed.
    void fit(const Jaws &jaws);
    [[nodiscard]] const std::shared_ptr<const ToolShape> &shape() const noexcept { return shape_; }

    // Returns the tool that consists of the pads only.
    [[nodiscard]] Tool tool(const Jaws &jaws) const noexcept;

    // Returns the frame at the center of a pad's inner face; x points into the pad. Side 0 is the
    // pad at -x of the grip.
    [[nodiscard]] static Placement face(int side, const Jaws &jaws, const ToolPose &pose) noexcept;

private:
    std::shared_ptr<const ToolShape> shape_;
    double open_m_ = 0.0; // opening of the jaws that the pads fit
};

} // namespace spidar
