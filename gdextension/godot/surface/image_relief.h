// A texture of Godot as the relief of a surface (device/contact/relief/relief_map.h). Main thread only.
#pragma once

#include <memory>
#include <string>

#include "device/contact/shapes/cooked_shape.h"

namespace godot {
class Texture2D;
} // namespace godot

namespace spidar {

// The luminance of each pixel as its height. An image of more than 512 pixels along a side is scaled down to that. Null, with
// an empty problem, while the texture has no image yet; problem: why the image cannot be used and what to do.
[[nodiscard]] std::shared_ptr<const CookedShape> relief_of(const godot::Texture2D &texture,
                                                           std::string &problem);

} // namespace spidar
