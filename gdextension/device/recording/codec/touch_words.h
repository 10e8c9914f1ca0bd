// Converts a scene of shapes to a fixed number of words. A shape is stored as its number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "device/contact/touch/touch_scene.h"
#include "device/recording/codec/recorded_shapes.h"

namespace spidar {

[[nodiscard]] std::size_t count_touch_words() noexcept;

// Stores a scene; null: no scene. Words of parts that the scene does not have stay unchanged, which
// costs nothing because only changes are recorded. An invalid scene is stored too; counts of parts
// beyond the arrays are clamped.
void store_touch(const TouchScene *touch, std::span<std::uint64_t> words) noexcept;

// Loads a scene from count_touch_words() words of any value. Returns false when there is no scene.
// A scene that was invalid when recorded is invalid again: validate() refuses it. The scene does
// not own its shapes, and a shape that is not in `shapes` is null.
[[nodiscard]] bool load_touch(std::span<const std::uint64_t> words, const RecordedShapes &shapes,
                              TouchScene &touch) noexcept;

} // namespace spidar
