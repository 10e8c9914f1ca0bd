// A scene of shapes as a row of words of always the same length; shapes are named by their numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "device/contact/touch/touch_scene.h"
#include "device/recording/codec/recorded_shapes.h"

namespace spidar {

[[nodiscard]] std::size_t count_touch_words() noexcept;

// Null: no scene. Words of parts that are not there are left as they are: they cost nothing where only changes are kept. A
// scene that is not valid (validate) is kept too, as far as it has parts.
void store_touch(const TouchScene *touch, std::span<std::uint64_t> words) noexcept;

// False: there is no scene. What no servo loop would render comes back as that: validate() refuses it as it did then. The
// scene does not own its shapes. words: count_touch_words() of them, of any value.
[[nodiscard]] bool load_touch(std::span<const std::uint64_t> words, const RecordedShapes &shapes,
                              TouchScene &touch) noexcept;

} // namespace spidar
