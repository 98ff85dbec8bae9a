// SPDX-License-Identifier: Apache-2.0
/// Random adults from MakeHuman's macro targets.
///
/// A person is a point on MakeHuman's macro sliders; every target's weight is the product of the weights of the words
/// in its name, each a piecewise linear function of one slider:
///   {african|asian|caucasian}-{female|male}-{young|old}
///   universal-{sex}-{age}-{min|average|max}muscle-{min|average|max}weight
///   {sex}-{age}-{…}muscle-{…}weight-{min|max}height      no height word between .49 and .51
///   {sex}-{age}-{…}muscle-{…}weight-{uncommon|ideal}proportions
/// Targets that are not in the folder count as zero. Source: targets/macrodetails/macro.json of the assets.
#pragma once

#include <map>
#include <random>
#include <string>

#include "bodyloom/data_tools/body_making/makehuman_files.h"

namespace bodyloom {

struct MakeHumanPerson {
  double male = 0.5;                                              ///< 0 female .. 1 male
  double age = 0.5;                                               ///< 0.5 young (25) .. 1 old (90)
  double muscle = 0.5;                                            ///< 0 .. 1
  double weight = 0.5;                                            ///< 0 .. 1; beyond 1 the last piece is extended
  double height = 0.5;                                            ///< 0 .. 1
  double proportions = 0.5;                                       ///< 0 uncommon .. 1 ideal
  Eigen::Vector3d ancestry = Eigen::Vector3d::Constant(1.0 / 3);  ///< african, asian, caucasian; sums to 1
};

/// Sex bimodal, age even from 0.5 to 0.95, weight skewed towards heavy (N(.48,.27) + Exp(.16) within [−.1,1.8]), muscle
/// N(.48,.2), height N(.489,.06), proportions N(.55,.2), ancestry even on the simplex.
MakeHumanPerson RandomAdult(std::mt19937* random);

/// Weight by target name; zero weights left out.
std::map<std::string, double> MakeHumanTargetWeights(const MakeHumanPerson& person);

/// All vertices (helpers included) of a person in MakeHuman's rest pose, decimetres.
MatrixX3d BlendMakeHuman(const MakeHumanFiles& files, const MakeHumanPerson& person);

}  // namespace bodyloom
