// Turns a texture of Godot into the relief of a surface (device/contact/relief/relief_map.h). Main
// thread only.
#pragma once

#include <memory>
#include <string>

#include "device/contact/shapes/cooked_shape.h"

namespace godot {
class Texture2D;
} // namespace godot

namespace spidar {

// Returns a shape whose heights are the luminances of the pixels, 0 to 1. An image with more than
// 512 pixels along a side is scaled down to 512. Returns null while the texture has no image yet.
// Returns null with a sentence in `problem` if the image cannot be used.
[[nodiscard]] std::shared_ptr<const CookedShape> relief_of(const godot::Texture2D &texture,
                                                           std::string &problem);

} // namespace spidar
