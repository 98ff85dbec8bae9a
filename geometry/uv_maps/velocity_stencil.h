// SPDX-License-Identifier: Apache-2.0
/// Velocity stencils: the rate of change of a quantity known at frames, for each frame by a few neighbours and weights,
///   d x/dt (t_i) ≈ Σ_k weights[k] · x(first_frame + k),     Σ weights = 0, unit 1/s.
/// Weights are those of a polynomial through (or, Savitzky–Golay, fitted by least squares to) the neighbours at their
/// actual times, differentiated at t_i; so they are exact for polynomials of that degree at any spacing.
///
///   scheme       neighbours                                        degree   at the ends of a segment
///   backward     i−1, i (the papers')                              1        the first frame looks forward
///   central      i−1, i, i+1                                       2        three frames on one side
///   savgol       within ±window_s/2, at least ±⌈(order+1)/2⌉ frames  order    the same number of frames, one-sided
/// A segment too short for a degree takes the degree it can; one frame alone has no neighbours: velocity zero, counted.
///
/// Nothing is differenced across a gap: a segment ends where a frame is not usable and where the step to the next is
/// longer than longest_step_s.
///
/// Noise: independent errors of standard deviation σ in x become σ · NoiseGain in the rate. Backward lags half a frame.
/// Source: Savitzky and Golay, "Smoothing and differentiation of data", 1964, for uneven spacing by least squares.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace bodyloom {

enum class VelocityScheme { kBackward, kCentral, kSavitzkyGolay };

struct VelocityStencilOptions {
  VelocityScheme scheme = VelocityScheme::kSavitzkyGolay;
  double window_s = 0.22;     ///< Savitzky–Golay: first to last frame, about; 7 frames at 30 a second
  int order = 3;              ///< Savitzky–Golay: degree, 1 to 5
  double longest_step_s = 0;  ///< a longer step between frames is a gap; 0: one and a half times the median step
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct VelocityStencil {
  int first_frame = 0;
  std::vector<double> weights;  ///< empty: no velocity (frame not usable, or alone in its segment)
  int segment = -1;             ///< number of the gap-free run of frames it lies in; −1: the frame is not usable
  /// sqrt(Σ w²): standard deviation of the rate for one of x of 1.
  [[nodiscard]] double NoiseGain() const;
};

/// One a frame. `usable` has an entry a frame, 0: the frame has no values. Throws std::invalid_argument when sizes
/// differ, options are not valid, or a timestamp is not finite or not later than the one before (naming the frame).
std::vector<VelocityStencil> VelocityStencils(std::span<const double> timestamps, std::span<const char> usable,
                                              const VelocityStencilOptions& options = {});

/// Weights of d/dt at `at` of the polynomial of `degree` fitted to values at `times` (at least degree + 1 of them,
/// ascending).
std::vector<double> DerivativeWeights(std::span<const double> times, double at, int degree);

}  // namespace bodyloom
