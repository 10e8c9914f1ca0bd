#pragma once

#include <godot_cpp/core/defs.hpp>

namespace godot {

struct Color {
    float r = 0;
    float g = 0;
    float b = 0;
    float a = 1;

    Color() {}
    Color(float p_r, float p_g, float p_b, float p_a = 1) : r(p_r), g(p_g), b(p_b), a(p_a) {}

    bool operator==(const Color &o) const { return r == o.r && g == o.g && b == o.b && a == o.a; }
    bool operator!=(const Color &o) const { return !(*this == o); }
};

} // namespace godot
