// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body_making/makehuman_population.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace bodyloom {
namespace {

using Words = std::vector<std::pair<std::string, double>>;

/// min – average – max with the middle at 0.5.
Words ThreeSteps(double value, const std::string& what) {
  if (value < 0.5) return {{"min" + what, 1 - 2 * value}, {"average" + what, 2 * value}};
  return {{"average" + what, 2 - 2 * value}, {"max" + what, 2 * value - 1}};
}

/// Words for both directions with nothing in the middle.
Words OffCentre(double value, double low_end, double high_begin, const std::string& low, const std::string& high) {
  if (value < low_end) return {{low, (low_end - value) / 0.5}};
  if (value > high_begin) return {{high, (value - high_begin) / 0.5}};
  return {};
}

/// Every combination of one word each: name "a-b-c", weight the product.
Words Combine(const std::vector<Words>& axes) {
  Words names = {{"", 1}};
  for (const Words& axis : axes) {
    Words longer;
    for (const auto& [name, weight] : names) {
      for (const auto& [word, word_weight] : axis) {
        longer.emplace_back(name.empty() ? word : name + "-" + word, weight * word_weight);
      }
    }
    names = longer;
  }
  return names;
}

}  // namespace

MakeHumanPerson RandomAdult(std::mt19937* random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::exponential_distribution<double> exponential;
  const auto near = [&](double mean, double sd, double low, double high) {
    return std::clamp(mean + sd * normal(*random), low, high);
  };
  MakeHumanPerson person;
  person.male = uniform(*random) < 0.5 ? near(0.08, 0.08, 0, 1) : near(0.92, 0.08, 0, 1);
  person.age = 0.5 + 0.45 * uniform(*random);
  const double spread = normal(*random), heavy = exponential(*random);
  person.weight = std::clamp(0.48 + 0.27 * spread + 0.16 * heavy, -0.1, 1.8);
  person.muscle = near(0.48, 0.2, 0, 1);
  person.height = near(0.489, 0.06, 0, 1);
  person.proportions = near(0.55, 0.2, 0, 1);
  for (int i = 0; i < 3; ++i) person.ancestry[i] = exponential(*random);
  person.ancestry /= person.ancestry.sum();
  return person;
}

std::map<std::string, double> MakeHumanTargetWeights(const MakeHumanPerson& person) {
  const Words sex = {{"female", 1 - person.male}, {"male", person.male}};
  const double old = (person.age - 0.5) / 0.5;
  const Words age = {{"young", 1 - old}, {"old", old}};
  const Words ancestry = {
      {"african", person.ancestry[0]}, {"asian", person.ancestry[1]}, {"caucasian", person.ancestry[2]}};
  const Words muscle = ThreeSteps(person.muscle, "muscle"), weight = ThreeSteps(person.weight, "weight");
  const Words height = OffCentre(person.height, 0.49, 0.51, "minheight", "maxheight");
  const Words proportions = OffCentre(person.proportions, 0.5, 0.5, "uncommonproportions", "idealproportions");
  std::map<std::string, double> weights;
  for (const std::vector<Words>& axes : {std::vector<Words>{ancestry, sex, age},
                                         {{{"universal", 1}}, sex, age, muscle, weight},
                                         {sex, age, muscle, weight, height},
                                         {sex, age, muscle, weight, proportions}}) {
    for (const auto& [name, value] : Combine(axes)) {
      if (value != 0) weights[name] += value;
    }
  }
  return weights;
}

MatrixX3d BlendMakeHuman(const MakeHumanFiles& files, const MakeHumanPerson& person) {
  MatrixX3d vertices = files.vertices_dm;
  for (const auto& [name, weight] : MakeHumanTargetWeights(person)) {
    const auto target = files.targets.find(name);
    if (target == files.targets.end()) continue;
    for (size_t i = 0; i < target->second.vertices.size(); ++i) {
      vertices.row(target->second.vertices[i]) +=
          weight * target->second.offsets_dm.row(static_cast<Eigen::Index>(i)).cast<double>();
    }
  }
  return vertices;
}

}  // namespace bodyloom
