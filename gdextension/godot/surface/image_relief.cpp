#include "godot/surface/image_relief.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <godot_cpp/classes/image.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/texture2d.hpp>
#include <godot_cpp/variant/packed_byte_array.hpp>

namespace spidar {

namespace {

// A hand does not feel finer: at 5 cm a tile, 512 heights are 0.1 mm apart.
constexpr int kMostPixels = 512;
constexpr int kChannels = 4;

} // namespace

std::shared_ptr<const CookedShape> relief_of(const godot::Texture2D &texture,
                                             std::string &problem) {
    const godot::Ref<godot::Image> given = texture.get_image();
    if (given.is_null() || given->is_empty()) {
        return nullptr;
    }
    const godot::Ref<godot::Image> image = given->duplicate();
    if (image->is_compressed() && image->decompress() != godot::OK) {
        problem = "has a compression that cannot be read: import it as Lossless. The surface has "
                  "grooves or pits instead.";
        return nullptr;
    }
    image->convert(godot::Image::FORMAT_RGBAF);
    const int largest = std::max(image->get_width(), image->get_height());
    if (largest > kMostPixels) {
        const double scale = static_cast<double>(kMostPixels) / largest;
        const auto scaled = [scale](int pixels) {
            return std::max(1, static_cast<int>(std::lround(scale * pixels)));
        };
        image->resize(scaled(image->get_width()), scaled(image->get_height()));
    }
    const godot::PackedByteArray bytes = image->get_data();
    ShapeDescription description;
    description.kind = ShapeKind::relief;
    description.columns = image->get_width();
    description.rows = image->get_height();
    const auto count =
        static_cast<std::size_t>(description.columns) * static_cast<std::size_t>(description.rows);
    if (static_cast<std::size_t>(bytes.size()) < count * kChannels * sizeof(float)) {
        problem = "has fewer bytes than pixels: give another image. The surface has grooves or "
                  "pits instead.";
        return nullptr;
    }
    description.heights_m.resize(count);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        float channels[kChannels];
        std::memcpy(channels, bytes.ptr() + pixel * sizeof channels, sizeof channels);
        // Luminance as Color.get_luminance() has it.
        const float luminance =
            0.2126F * channels[0] + 0.7152F * channels[1] + 0.0722F * channels[2];
        description.heights_m[pixel] =
            std::isfinite(luminance) ? std::clamp(luminance, 0.0F, 1.0F) : 0.0F;
    }
    CookResult cooked = cook(std::move(description));
    if (cooked.shape == nullptr) {
        problem =
            "cannot be a relief: " + cooked.sentence + " The surface has grooves or pits instead.";
    }
    return cooked.shape;
}

} // namespace spidar
