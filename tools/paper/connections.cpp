// Section III.1: which corner should each pole end's two strings come from? All 8! / 2!^4 = 2520 ways, by
// det(A A^T). (The paper prints det(A^T A), which is zero for every one: docs/why/paper_notes.md.)
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "paper/closure.h"
#include "paper/paper_device.h"
#include "paper/sections.h"

namespace spidar::paper {

namespace {

constexpr int kEnds = 4;                          // +r1, -r1, +r2, -r2
using Assignment = std::array<int, kStringCount>; // pole end of each string

struct Connection {
    Assignment ends{};
    Closure centre;
    double near_log_determinant = 0.0; // mean of the natural logarithm over poses near the centre
    double near_closed_percent = 0.0;
};

// "12/34/57/68": the paper's numbers of the strings at +r1, -r1, +r2, -r2.
std::string name_of(const Assignment &ends) {
    std::string name;
    for (int end = 0; end < kEnds; ++end) {
        name += end == 0 ? "" : "/";
        for (std::size_t string = 0; string < ends.size(); ++string) {
            name += ends[string] == end ? std::to_string(string + 1) : "";
        }
    }
    return name;
}

GripGeometry grip_with(const Assignment &ends) {
    GripGeometry grip;
    for (std::size_t string = 0; string < ends.size(); ++string) {
        grip.attachments[string] = {ends[string] / 2, ends[string] % 2 == 0 ? 1.0 : -1.0};
    }
    return grip;
}

// The grasp row counts pole 1 against pole 2; in wrench_matrix() this follows the attachments.
Closure closure_at(const FrameGeometry &frame, const GripGeometry &grip, const GripPose &pose) {
    return closure_of(wrench_matrix(frame, grip, pose), grip.pole_half_length_m);
}

Connection judge(const PaperDevice &device, const Assignment &ends,
                 const std::vector<GripPose> &near) {
    const GripGeometry grip = grip_with(ends);
    Connection result;
    result.ends = ends;
    result.centre = closure_at(device.frame, grip, rest_pose(grip));
    int closed = 0;
    for (const GripPose &pose : near) {
        const Closure closure = closure_at(device.frame, grip, pose);
        // A singular pose would make the mean minus infinity; this is as good as that.
        result.near_log_determinant += std::log(std::max(closure.determinant, 1e-30));
        closed += closure.closed ? 1 : 0;
    }
    result.near_log_determinant /= static_cast<double>(near.size());
    result.near_closed_percent = 100.0 * closed / static_cast<double>(near.size());
    return result;
}

} // namespace

void string_connections(Outputs &outputs) {
    const PaperDevice device;
    Random random(1);
    std::vector<GripPose> near(64); // within 5 cm and 10 degrees of the centre
    for (GripPose &pose : near) {
        pose = random.pose(device.grip, 0.05, 10.0 * kDegree_rad, 10.0 * kDegree_rad);
    }

    std::vector<Connection> all;
    Assignment ends{0, 0, 1, 1, 2, 2, 3, 3}; // sorted: next_permutation goes through all
    do {
        all.push_back(judge(device, ends, near));
    } while (std::next_permutation(ends.begin(), ends.end()));
    std::stable_sort(all.begin(), all.end(), [](const Connection &a, const Connection &b) {
        return a.centre.determinant > b.centre.determinant;
    });

    const std::string of_paper = name_of({0, 0, 1, 1, 2, 3, 2, 3});
    CsvFile table =
        outputs.table("connections", "place,strings,determinant,margin,closed,near_log_determinant,"
                                     "near_closed_percent,of_paper");
    const auto at = std::find_if(all.begin(), all.end(), [&](const Connection &connection) {
        return name_of(connection.ends) == of_paper;
    });
    const Connection &paper = *at;
    // Equal but for rounding: mirror images and renamed ends.
    const double tie = 1e-9 * std::max(paper.centre.determinant, all.front().centre.determinant);
    int place = 0;
    int better = 0;
    int better_closed = 0;
    int equal = 0;
    int closed = 0;
    int full_rank = 0;
    int better_near_closed = 0;
    const Connection *best_closed = nullptr;
    for (const Connection &connection : all) {
        const double lead = connection.centre.determinant - paper.centre.determinant;
        better += lead > tie ? 1 : 0;
        better_closed += lead > tie && connection.centre.closed ? 1 : 0;
        equal += std::abs(lead) <= tie ? 1 : 0;
        closed += connection.centre.closed ? 1 : 0;
        full_rank += connection.centre.determinant > tie ? 1 : 0;
        better_near_closed += connection.centre.closed && connection.near_log_determinant >
                                                              paper.near_log_determinant + 1e-9
                                  ? 1
                                  : 0;
        if (connection.centre.closed && best_closed == nullptr) {
            best_closed = &connection;
        }
        table.row({++place, name_of(connection.ends), connection.centre.determinant,
                   connection.centre.margin, connection.centre.closed,
                   connection.near_log_determinant, connection.near_closed_percent,
                   &connection == &paper});
    }
    outputs.figure("connections/all", place);
    outputs.figure("connections/full_rank", full_rank);
    outputs.figure("connections/closed", closed);
    outputs.figure("connections/paper_determinant", paper.centre.determinant);
    outputs.figure("connections/best_determinant", all.front().centre.determinant);
    outputs.figure("connections/best_strings", name_of(all.front().ends));
    outputs.figure("connections/better_than_paper", better);
    outputs.figure("connections/better_and_closed", better_closed);
    outputs.figure("connections/equal_to_paper", equal);
    outputs.figure("connections/better_near_and_closed", better_near_closed);
    outputs.figure("connections/best_closed_strings",
                   best_closed == nullptr ? std::string("none") : name_of(best_closed->ends));
    outputs.figure("connections/best_closed_determinant",
                   best_closed == nullptr ? 0.0 : best_closed->centre.determinant);
    outputs.figure("connections/paper_near_closed_percent", paper.near_closed_percent);
}

} // namespace spidar::paper
