// Tolerances of the core, each with its reason. Physical defaults live beside the type they belong to.
#pragma once

namespace spidar {

// A motor this close to the corner of a box counts as on it: a hundredth of an encoder count, so that
// a frame typed in with rounded numbers still gets the closed form, and no measurable error follows.
inline constexpr double kBoxTolerance_m = 2.5e-7;

// Poles nearer to parallel than this have no grip plane: their ends are 4 um apart, a sixth of an
// encoder count, so the rotation about them is noise. The rotation is held there.
inline constexpr double kParallelAngle_rad = 1e-4;

// Largest frame and pole that validate() accepts; catches millimetres typed as metres.
inline constexpr double kMaxFrameExtent_m = 10.0;
inline constexpr double kMinPoleHalfLength_m = 1e-3;

// No string is longer: the diagonal of the largest frame is 35 m.
inline constexpr double kLongestString_m = 40.0;

// Lengths no pose explains. The paper's strings err by up to 3 mm; seven times that is a fault.
inline constexpr double kImpossibleResidual_m = 0.020;

// After the steps of a warm tick a residual above this asks for a cold start. Calibrated strings
// err by less, and the redundant eighth length shows only a third of the error of one string.
inline constexpr double kWarmResidualGate_m = 1e-3;

// A search ends at the remembered pose where the lengths fit it to this, less than an encoder count. Else the others are
// looked at too, and must fit kBeyondChance times better: next to it a wrong branch may fit to a millimetre.
inline constexpr double kContentResidual_m = 2e-5;

// Motion within one tick above which Gauss-Newton alone is not trusted: 5 m/s at 1 kHz.
inline constexpr double kMaxWarmStep_m = 5e-3;
// Up to this the last pose is still trusted to lead to the right answer of several, if that fits: strings that err by
// millimetres move the pole ends so far in a tick. Beyond, it competes with the closed form.
inline constexpr double kTrustedStep_m = 0.02;
// The second step of a warm tick is quadratically smaller than the first; above this it did not settle.
inline constexpr double kMaxSecondStep_m = 5e-4;
// Above this it leaves more than 10 nm, and a third is taken: movements of more than a millimetre within a tick that were
// not foreseen, or samples lost.
inline constexpr double kThirdStep_m = 2e-5;
// Motion within one tick after which the last pose says nothing (device restarted, samples lost).
inline constexpr double kForgetStep_m = 0.05;

// Residual at which a pose explains the lengths to double precision (eight lengths near 0.5 m).
inline constexpr double kResidualFloor_m = 1e-14;
// Only one length is redundant, so noise alone often makes one pose fit many times better than another. A pose that
// fits worse than the best by less than these factors may be the truth: it makes the answer ambiguous, and it is no
// reason to leave the remembered pose. The plain factor counts where the fit is worse than calibrated strings err.
inline constexpr double kSuspiciousResidual_m = 2e-3;
inline constexpr double kClearlyBetter = 0.5;
inline constexpr double kBeyondChance = 0.02;
// Without memory: how much better another root pair must fit than the upright one, which is right in 98 % of all
// poses. Of 1 to 0.02 the factor with the fewest wrong choices on the 60/45 set, counts and noise of 0.1 mm.
inline constexpr double kUprightPrior = 0.3;
// A root pair that starts this close to the remembered pose leads to it.
inline constexpr double kSamePose_m = 1e-3;
// Warm ticks from one look for other answers to the next: 8 ms at 1 kHz, in which a hand moves a few millimetres.
inline constexpr int kRivalPeriod = 8;

// Two poses further apart than this (grip centre or pole end) are different answers, not rounding.
inline constexpr double kDistinctPose_m = 1e-5;

// Smallest scaled pivot of the normal equations, about sigma7 squared. Below the first the lengths
// leave a direction open to 1 % (flag); below the second, to the square root of rounding (refuse).
inline constexpr double kNearSingularPivot = 1e-4;
inline constexpr double kRankDeficientPivot = 1e-12;

// Error that a step of size s leaves behind: about this times s^2, in metres. The poles are the most curved
// part of the map, 1 / d = 25 for the paper's grip. Divided by the root of the pivot where that is small.
inline constexpr double kLengthCurvature = 25.0;
// The largest seen, where a search must not stop early.
inline constexpr double kWorstCurvature = 4.0 * kLengthCurvature;
// A residual bends the steps as a step of this many times its size does.
inline constexpr double kResidualCurvature = 4.0;
// A warm tick is done when the error it leaves is below the first of these, or below the second part of what
// the lengths themselves err by: their residual. Errors add by squares, so that the pose is then worse by 0.2 %.
inline constexpr double kTrackingFloor_m = 1e-12;
inline constexpr double kTrackingShare = 0.05;
// A higher order of extrapolation is used when its squared miss was this much smaller.
inline constexpr double kForeseenShare = 0.25;

// Search: fast steps before the damped method takes over. Good lengths need 1-5 of them.
inline constexpr int kMaxRefineSteps = 10;
// Steps that shrink by less than this are left to the Newton method.
inline constexpr double kSlowestRate = 0.3;
// A factorisation made this near serves the next step as well.
inline constexpr double kRefactorStep_m = 1e-5;
// A step by it that shrinks by less than this asks for a new one: near a singular pose they may shrink by half only.
inline constexpr double kOutwornRate = 0.1;
// How much more than its distance such a factorisation bends the next step: strings near a corner are short.
inline constexpr double kNearbyBend = 8.0;
// A residual settles when a step lowers the sum of squares by less than this part: what is above all that
// matters then stays there.
inline constexpr double kSettledDecrease = 0.2;
// Largest misfit of a root pair per residual of the lengths, over (1 + c / distance to the z face): 2.6 was the
// worst of 120,000 poses of the 60/45 set with noise of 0.01 to 1 mm, 1.1 the median.
inline constexpr double kMisfitGain = 3.0;
// How far above that limit the forecast of a misfit may be and the pair is still looked at: of the pairs that mattered on
// that set 1 in 1000 was above.
inline constexpr double kForecastSlack = 3.0;

// Newton to convergence: bound, and the step at which double precision ends. Quadratic convergence
// takes 3-8 steps from the closed form; the bound leaves room for damped starts far away.
inline constexpr int kMaxPolishSteps = 50;
inline constexpr double kConvergedStep_m = 1e-15;
// Below this a step that no longer shrinks is rounding, not progress.
inline constexpr double kStagnantStep_m = 1e-9;
// The residual after a last step below this is the one it foretells: to the root of rounding of the step.
inline constexpr double kForetoldStep_m = 1e-12;
// By a factorisation from elsewhere only where the step is this small against the lengths' errors (squared).
inline constexpr double kForetoldShare = 1e-6;
// No trial step may exceed this: the linear model holds over about one pole length.
inline constexpr double kMaxTrialStep_m = 0.04;

} // namespace spidar
