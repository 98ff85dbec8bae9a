// SPDX-License-Identifier: Apache-2.0
/// Result of an evaluation: description of the protocol, named numbers, and their breakdown by joint or camera.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/scene/track.h"

namespace bodyloom {

/// One number. The name ends in its unit (`pa_mpjpe_mm`, `heldout_median_px`) and is the key in JSON; NaN if there was
/// nothing to measure.
struct EvaluationValue {
  std::string name;
  double value = 0;
  std::string meaning;  ///< one line
};

/// One number per joint or camera.
struct EvaluationBreakdown {
  std::string name;  ///< with its unit
  std::vector<std::string> labels;
  std::vector<double> values;  ///< as many as labels
};

struct Evaluation {
  std::string protocol;                                      ///< short name, "aist-held-out"
  std::string description;                                   ///< quantities compared, alignment and frames
  std::vector<std::pair<std::string, std::string>> subject;  ///< sequence, view, …
  int frames = 0;                                            ///< frames compared
  int frames_without_result = 0;                             ///< of these, scored with the nearest frame that has one
  std::vector<EvaluationValue> values;
  std::vector<EvaluationBreakdown> breakdowns;

  void Add(std::string name, double value, std::string meaning) {
    values.push_back({std::move(name), value, std::move(meaning)});
  }
  /// The value called `name`; throws std::invalid_argument if there is none.
  [[nodiscard]] double Value(const std::string& name) const;
};

/// An aligned table for a terminal: protocol, subject, one line a value with its meaning, then the breakdowns.
std::string EvaluationTable(const Evaluation& evaluation);

/// One JSON object: protocol, description, subject, frames, frames_without_result, values {name: number or null},
/// meanings {name: text}, breakdowns {name: {label: number or null}}. Ends with a newline.
std::string EvaluationJson(const Evaluation& evaluation);

/// Median of the knees' flexion over the frames with a pose and both knees, degrees. Flexion is the x component of a
/// knee's axis-angle (SMPL's joints 4 and 5; tracking/terms/joint_limits.h has the frame): 0 where thigh and shin are
/// in line as in the rest pose. NaN without such frames, and for poses of fewer than six joints.
double MedianKneeFlexionDeg(const Motion& motion);

/// Adds `knee_flexion_deg`, and with a truth `gt_knee_flexion_deg`.
void AddKneeFlexion(const Motion& estimate, const Motion* truth, Evaluation* evaluation);

/// Protocol "track-alone", without a reference: the knees' flexion.
Evaluation EvaluateAlone(const Track& track);

}  // namespace bodyloom
