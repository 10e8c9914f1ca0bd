// A shape that touches the scene: a pad of the grip, or a convex part of a held body. It consists
// of a core and a skin: all points within skin_m of the core. Skins meet while the cores are still
// apart, so that distances and normals are accurate at touch. A tool with several convex parts has
// several ToolShapes, each with its own placement.
#pragma once

#include <memory>
#include <string>

#include "core/base/status.h"
#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Default skin (unit: m): 40 encoder counts of the paper's device.
inline constexpr double kDefaultSkin_m = 1e-3;

// The values are stored in recordings: append new kinds.
enum class ToolKind : std::uint8_t {
    pad = 0,    // radius_m, half_thickness_m, skin_m
    sphere = 1, // radius_m
    shape = 2,  // shape, skin_m
};

// Description of a tool. Only the fields that ToolKind names for the kind are read. A recording
// stores it; making the tool again gives the same tool.
struct ToolDescription {
    ToolKind kind = ToolKind::sphere;
    double radius_m = 0.0;
    double half_thickness_m = 0.0;
    double skin_m = kDefaultSkin_m;
    ShapeDescription shape;
};

class ToolShape {
public:
    struct Data;

    explicit ToolShape(std::unique_ptr<const Data> data);
    ~ToolShape();
    ToolShape(const ToolShape &) = delete;
    ToolShape &operator=(const ToolShape &) = delete;

    [[nodiscard]] double skin_m() const noexcept;
    // Radius of the smallest ball about the tool's origin that contains the tool with its skin
    // (unit: m).
    [[nodiscard]] double reach_m() const noexcept;
    [[nodiscard]] const Data &data() const noexcept { return *data_; }
    // The description that the tool was made from. Using it again gives the same tool bit for bit,
    // with another number.
    [[nodiscard]] const ToolDescription &description() const noexcept;

    // See CookedShape::number().
    [[nodiscard]] std::uint64_t number() const noexcept { return number_; }

private:
    std::unique_ptr<const Data> data_;
    std::uint64_t number_;
};

struct ToolResult {
    Status status = Status::ok;
    std::string sentence;                  // the problem; empty when there is none
    std::shared_ptr<const ToolShape> tool; // set if usable(status)
};

// Makes a disc with its axis along Y, outer radius radius_m, outer thickness 2 half_thickness_m and
// edges rounded by skin_m. With skin_m = half_thickness_m its core is flat, which is fastest on
// meshes.
[[nodiscard]] ToolResult make_pad(double radius_m, double half_thickness_m, double skin_m);
[[nodiscard]] ToolResult make_sphere(double radius_m);
// Makes a tool from a convex shape, with edges rounded by skin_m and faces unchanged. A shape
// thinner than 4 skin_m gets a thinner skin; a sphere or capsule ignores skin_m. Refuses meshes,
// height maps and half spaces.
[[nodiscard]] ToolResult make_tool(const CookedShape &shape, double skin_m = kDefaultSkin_m);
// Makes the tool of a description.
[[nodiscard]] ToolResult make_tool(const ToolDescription &description);

} // namespace spidar
