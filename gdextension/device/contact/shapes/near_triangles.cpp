#include "device/contact/shapes/near_triangles.h"

#include <algorithm>

namespace spidar {

namespace {

// Distance beyond the margin within which triangles are gathered (unit: m). At 0.4 m/s a hand
// gathers every tenth cycle; a larger distance would bring more triangles to check in each cycle.
constexpr double kSlack_m = 4e-3;
// Movement after which a tool gathers again on a mesh too fine for the list (unit: m), since the
// list is never complete there.
constexpr double kLeastSlack_m = 1e-3;

// Rounding of a triangle's ball to single precision, relative to its size and position.
constexpr double kFloat = 2e-7;

// Returns a bound of the movement of the tool's points between two placements.
double moved_at_most(const Placement &from, const Placement &to, double reach_m) noexcept {
    double turn2 = 0.0;
    for (int column = 0; column < 3; ++column) {
        const Vec3 change = to.rotation[column] - from.rotation[column];
        turn2 += glm::dot(change, change);
    }
    // The Frobenius norm of the change is sqrt(8) sin(angle / 2).
    return glm::length(to.origin_m - from.origin_m) + reach_m * std::sqrt(0.5 * turn2);
}

struct NearerLast {
    const std::array<double, kMaxNearTriangles> &distances;
    bool operator()(std::size_t a, std::size_t b) const noexcept {
        return distances[a] < distances[b];
    }
};

class Gatherer {
public:
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): large, and filled before it is read
    Gatherer(const TriangleSource &source, const ToolShape::Data &tool, const Placement &tool_at,
             double reach_m, PairMemory &memory) noexcept
        : source_(source), memory_(memory), reach_m_(reach_m), core_(view_of(tool.core)),
          back_(glm::transpose(tool_at.rotation)), origin_m_(tool_at.origin_m) {
        bounds_of(core_, tool_at.rotation, lower_m_, upper_m_);
        lower_m_ += tool_at.origin_m;
        upper_m_ += tool_at.origin_m;
    }

    void run() noexcept {
        const Vec3 reach(reach_m_);
        source_.visit_box(lower_m_ - reach, upper_m_ + reach,
                          [this](std::uint32_t triangle) { add(triangle); });
    }

    // Distance from the core within which the list holds all triangles.
    [[nodiscard]] double complete_to_m() const noexcept { return reach_m_; }

private:
    void add(std::uint32_t number) noexcept {
        const Corners triangle = source_.corners(number);
        const Vec3 lower = glm::min(glm::min(triangle[0], triangle[1]), triangle[2]);
        const Vec3 upper = glm::max(glm::max(triangle[0], triangle[1]), triangle[2]);
        const Vec3 apart = glm::max(glm::max(lower - upper_m_, lower_m_ - upper), Vec3(0.0));
        NearTriangle near;
        near.index = number;
        const Vec3 middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
        double radius2 = 0.0;
        for (const Vec3 &corner : triangle) {
            radius2 = std::max(radius2, glm::dot(corner - middle, corner - middle));
        }
        const double radius = std::sqrt(radius2);
        near.middle_m = {static_cast<float>(middle.x), static_cast<float>(middle.y),
                         static_cast<float>(middle.z)};
        near.radius_m = static_cast<float>(radius + kFloat * (radius + glm::length(middle)));
        // A lower bound of the distance: between both boxes, and from the core to the triangle's
        // ball.
        const Vec3 inside = back_ * (middle - origin_m_);
        insert(near, std::max(glm::length(apart), distance_to_core(core_, inside) - radius));
    }

    void insert(const NearTriangle &near, double distance) noexcept {
        if (distance >= reach_m_) {
            return;
        }
        if (memory_.count == kMaxNearTriangles) {
            // The farthest triangle is replaced, and the complete distance shrinks accordingly.
            std::pop_heap(heap_.begin(), heap_.end(), NearerLast{distances_});
            const std::size_t farthest = heap_.back();
            reach_m_ = std::max(distances_[farthest], distance);
            if (distance < distances_[farthest]) {
                memory_.triangles[farthest] = near;
                distances_[farthest] = distance;
            }
            std::push_heap(heap_.begin(), heap_.end(), NearerLast{distances_});
            return;
        }
        const auto place = static_cast<std::size_t>(memory_.count++);
        memory_.triangles[place] = near;
        distances_[place] = distance;
        heap_[place] = static_cast<std::uint16_t>(place);
        if (memory_.count == kMaxNearTriangles) {
            std::make_heap(heap_.begin(), heap_.end(), NearerLast{distances_});
        }
    }

    const TriangleSource &source_;
    PairMemory &memory_;
    double reach_m_;
    const CoreView core_;
    const Mat3 back_;
    const Vec3 origin_m_;
    Vec3 lower_m_{0.0};
    Vec3 upper_m_{0.0};
    std::array<double, kMaxNearTriangles> distances_;
    std::array<std::uint16_t, kMaxNearTriangles> heap_;
};

// Maps triangle numbers to list places: a hash table that is at most half full.
class Places {
public:
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
    explicit Places(const PairMemory &memory) noexcept : memory_(memory) {
        table_.fill(kNoTriangle);
        for (int place = 0; place < memory.count; ++place) {
            std::size_t slot = slot_of(memory.triangles[static_cast<std::size_t>(place)].index);
            while (table_[slot] != kNoTriangle) {
                slot = (slot + 1) % kSlots;
            }
            table_[slot] = static_cast<std::uint16_t>(place);
        }
    }

    [[nodiscard]] std::uint16_t of(std::uint32_t triangle) const noexcept {
        std::size_t slot = slot_of(triangle);
        while (table_[slot] != kNoTriangle && memory_.triangles[table_[slot]].index != triangle) {
            slot = (slot + 1) % kSlots;
        }
        return table_[slot];
    }

private:
    static constexpr std::size_t kSlots = 4096;

    static std::size_t slot_of(std::uint32_t triangle) noexcept {
        return (triangle * 0x9e3779b1U) >> 20U; // Knuth's multiplicative hash, upper 12 bits
    }
    static_assert(kSlots == 1U << 12U && kSlots / 2 > kMaxNearTriangles);

    const PairMemory &memory_;
    std::array<std::uint16_t, kSlots> table_;
};

void link(const TriangleSource &source, PairMemory &memory) noexcept {
    const Places places(memory);
    for (int place = 0; place < memory.count; ++place) {
        NearTriangle &near = memory.triangles[static_cast<std::size_t>(place)];
        near.sharp_edges = source.sharp_edges(near.index);
        for (std::size_t edge = 0; edge < 3; ++edge) {
            const std::uint32_t neighbour = source.neighbour(near.index, edge);
            near.neighbour[edge] = neighbour == kNone ? kNoTriangle : places.of(neighbour);
        }
    }
}

} // namespace

bool still_near(const PairMemory &memory, const ToolShape::Data &tool, const Placement &tool_at,
                double margin_m) noexcept {
    // A full list reaches as far as it can: gathering again at the same place would not help.
    const double slack = memory.slack_m - (margin_m - memory.margin_m);
    return memory.slack_m >= 0.0 &&
           moved_at_most(memory.gathered_at, tool_at, tool.reach_m) <= slack;
}

void gather_triangles(const TriangleSource &source, const ToolShape::Data &tool,
                      const Placement &tool_at, double margin_m, PairMemory &memory) noexcept {
    memory.count = 0;
    Gatherer gatherer(source, tool, tool_at, tool.skin_m + margin_m + kSlack_m, memory);
    gatherer.run();
    link(source, memory);
    memory.gathered_at = tool_at;
    memory.margin_m = margin_m;
    // Too many triangles lie within the margin itself: the list is used for a while as it is.
    const double slack_m = gatherer.complete_to_m() - tool.skin_m - margin_m;
    memory.full = slack_m < kLeastSlack_m;
    memory.slack_m = std::max(slack_m, kLeastSlack_m);
}

} // namespace spidar
