// Kinematics as existing SPIDAR software does it (research on Springhead: HISpidarG, CalcPose), for comparison only:
// from the last pose, a fixed number of Gauss-Newton steps on a dense 8 x n Jacobian with one damping constant,
// normal equations by Cholesky; no residual test. Here in doubles, on the seven unknowns of the paper's grip.
#pragma once

#include "core/geometry/frame_geometry.h"
#include "core/geometry/grip_geometry.h"

namespace spidar::bench {

struct DenseGaussNewton {
    FrameGeometry frame;
    GripGeometry grip;
    GripPose pose;
    double damping = 1e-3; // added to the diagonal; 1e-3 is what that software ships
    int steps = 2;

    void update(const StringArray &lengths_m);
};

} // namespace spidar::bench
