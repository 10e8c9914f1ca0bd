// A shape that touches the scene: a pad of the grip, or a convex part of a held body. It is a core and a skin: all
// points within skin_m of the core. The skins of two things meet while their cores stay apart, so distances and normals
// stay exact at touch. A tool of several convex parts is several ToolShapes, each asked with its own placement.
#pragma once

#include <memory>
#include <string>

#include "core/base/status.h"
#include "device/contact/shapes/cooked_shape.h"

namespace spidar {

// Used when nothing else is asked for (m): a tenth of a pad, and 40 encoder counts.
inline constexpr double kDefaultSkin_m = 1e-3;

// The numbers are part of recordings: new kinds go to the end.
enum class ToolKind : std::uint8_t {
    pad = 0,    // radius_m, half_thickness_m, skin_m
    sphere = 1, // radius_m
    shape = 2,  // shape, skin_m
};

// What to make a tool of. Only the fields named at its kind are read. A recording keeps this, and making it again gives the
// same tool.
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
    // Radius about the tool's origin that holds the tool, skin included (m).
    [[nodiscard]] double reach_m() const noexcept;
    [[nodiscard]] const Data &data() const noexcept { return *data_; }
    // As it was asked for: making this again gives the same tool, bit for bit, with another number.
    [[nodiscard]] const ToolDescription &description() const noexcept;

    // As CookedShape::number().
    [[nodiscard]] std::uint64_t number() const noexcept { return number_; }

private:
    std::unique_ptr<const Data> data_;
    std::uint64_t number_;
};

struct ToolResult {
    Status status = Status::ok;
    std::string sentence;                  // what was wrong; empty if nothing was
    std::shared_ptr<const ToolShape> tool; // set if usable(status)
};

// A disc with its axis along Y: outer radius radius_m, outer thickness 2 half_thickness_m, edges rounded by skin_m.
// With skin_m = half_thickness_m its core is flat, which is fastest on meshes.
[[nodiscard]] ToolResult make_pad(double radius_m, double half_thickness_m, double skin_m);
[[nodiscard]] ToolResult make_sphere(double radius_m);
// The convex shape itself with its edges rounded by skin_m: its faces stay where they are. A shape thinner than twice
// skin_m gets a thinner skin. Not for meshes, height maps and half spaces: give their hull.
[[nodiscard]] ToolResult make_tool(const CookedShape &shape, double skin_m = kDefaultSkin_m);
// Any of these.
[[nodiscard]] ToolResult make_tool(const ToolDescription &description);

} // namespace spidar
