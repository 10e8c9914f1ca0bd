#include "core/geometry/frame_geometry.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/describe_value.h"

namespace spidar {

namespace {

constexpr StringVectors kCornerSigns{Vec3(1, 1, 1),   Vec3(-1, 1, 1),  Vec3(1, -1, 1),
                                     Vec3(-1, -1, 1), Vec3(1, 1, -1),  Vec3(-1, 1, -1),
                                     Vec3(1, -1, -1), Vec3(-1, -1, -1)};

// Tolerance of a motor at the corner of a box: a hundredth of an encoder count. A frame typed with
// rounded numbers still gets the closed form, without measurable error.
constexpr double kBoxTolerance_m = 2.5e-7;
// Smallest thickness of the frame relative to its largest extent. Motors in one plane or line leave
// a direction in which no string pulls.
constexpr double kMinRelativeThickness = 1e-3;
// Largest pulley radius: a larger one is millimeters typed as meters.
constexpr double kMaxPulleyRadius_m = 0.05;
constexpr double kUnitTolerance = 1e-9;

double largest_extent(const FrameGeometry &frame) {
    double extent = 0.0;
    for (const Vec3 &a : frame.motors_m) {
        for (const Vec3 &b : frame.motors_m) {
            extent = std::fmax(extent, glm::distance(a, b));
        }
    }
    return extent;
}

bool is_unit(const Vec3 &v) noexcept {
    return std::fabs(glm::dot(v, v) - 1.0) <= kUnitTolerance;
}

// Returns the thickness of the thinnest slab around all motors, over the slabs parallel to three
// motors.
double thickness(const FrameGeometry &frame) {
    double thinnest = HUGE_VAL;
    const StringVectors &q = frame.motors_m;
    const double extent = largest_extent(frame);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        for (std::size_t j = i + 1; j < kStringCount; ++j) {
            for (std::size_t k = j + 1; k < kStringCount; ++k) {
                const Vec3 normal = glm::cross(q[j] - q[i], q[k] - q[i]);
                const double area = glm::length(normal);
                if (!(area > kMinRelativeThickness * extent * extent)) {
                    continue; // three motors almost in line define no plane
                }
                double low = 0.0;
                double high = 0.0;
                for (const Vec3 &motor : q) {
                    const double height = glm::dot(normal, motor - q[i]) / area;
                    low = std::fmin(low, height);
                    high = std::fmax(high, height);
                }
                thinnest = std::fmin(thinnest, high - low);
            }
        }
    }
    return std::isfinite(thinnest) ? thinnest : 0.0;
}

} // namespace

FrameGeometry make_box_frame(const Vec3 &half_extents_m) noexcept {
    FrameGeometry frame;
    for (std::size_t i = 0; i < kStringCount; ++i) {
        frame.motors_m[i] = kCornerSigns[i] * half_extents_m;
    }
    return frame;
}

MotorBox box_around_motors(const FrameGeometry &frame) noexcept {
    MotorBox box{frame.motors_m[0], frame.motors_m[0]};
    for (const Vec3 &motor : frame.motors_m) {
        box.low_m = glm::min(box.low_m, motor);
        box.high_m = glm::max(box.high_m, motor);
    }
    return box;
}

std::optional<Vec3> box_half_extents(const FrameGeometry &frame) noexcept {
    Vec3 mean{0.0};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        mean += kCornerSigns[i] * frame.motors_m[i] * (1.0 / kStringCount);
    }
    if (!(mean.x > kBoxTolerance_m) || !(mean.y > kBoxTolerance_m) || !(mean.z > kBoxTolerance_m)) {
        return std::nullopt;
    }
    const FrameGeometry box = make_box_frame(mean);
    for (std::size_t i = 0; i < kStringCount; ++i) {
        if (!(glm::distance(box.motors_m[i], frame.motors_m[i]) <= kBoxTolerance_m)) {
            return std::nullopt;
        }
    }
    return mean;
}

bool is_usable(const FrameGeometry &frame) noexcept {
    for (const Vec3 &motor : frame.motors_m) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!(std::fabs(motor[axis]) <= kMaxFrameExtent_m)) {
                return false;
            }
        }
    }
    const double extent = largest_extent(frame);
    return extent > 0.0 && thickness(frame) >= kMinRelativeThickness * extent &&
           frame.pulley_radius_m >= 0.0 && frame.pulley_radius_m <= kMaxPulleyRadius_m &&
           is_unit(frame.pulley_axis);
}

std::string validate(const FrameGeometry &frame) {
    constexpr std::array<const char *, 3> kAxes{"x", "y", "z"};
    for (std::size_t i = 0; i < kStringCount; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const double value = frame.motors_m[i][axis];
            if (!(std::fabs(value) <= kMaxFrameExtent_m)) {
                return range_sentence(
                    element_name("motors_m", i) + "." + kAxes[static_cast<std::size_t>(axis)],
                    value, "m",
                    "give a finite position within " + with_unit(kMaxFrameExtent_m, "m") +
                        " of the frame's center (meters, not millimeters).");
            }
        }
    }
    const double extent = largest_extent(frame);
    if (!(extent > 0.0)) {
        return "motors_m spans " + with_unit(extent, "m") +
               "; give eight different motor positions, for instance the corners of the frame.";
    }
    const double thin = thickness(frame);
    if (!(thin >= kMinRelativeThickness * extent)) {
        return "motors_m lie in a slab " + with_unit(thin, "m") +
               " thick; spread the motors over three dimensions, at least " +
               with_unit(kMinRelativeThickness * extent, "m") + " in each.";
    }
    if (!(frame.pulley_radius_m >= 0.0 && frame.pulley_radius_m <= kMaxPulleyRadius_m)) {
        return range_sentence("pulley_radius_m", frame.pulley_radius_m, "m",
                              "give the radius of the exit pulleys in meters, up to " +
                                  with_unit(kMaxPulleyRadius_m, "m") + ", or 0 for eyelets.");
    }
    if (!is_unit(frame.pulley_axis)) {
        return "pulley_axis has the length " +
               with_unit(glm::length(frame.pulley_axis), "(unit vector)") +
               "; give a vector of length 1.";
    }
    return {};
}

} // namespace spidar
