// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/people/motion_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/pipelines/people/motion_errors_json.h"

namespace bodyloom {

void MotionErrors::Add(int frame, double image_l1) {
  errors_.push_back(
      {frame, image_l1, similarity_.empty() ? std::numeric_limits<float>::quiet_NaN() : similarity_.at(frame)});
}

void MotionErrors::WriteCsv(const std::string& path) const {
  std::ostringstream text;
  text << "frame,image_l1,similarity\n";
  for (const Error& error : errors_) {
    text << error.frame << ',' << error.image_l1 << ',';
    if (!std::isnan(error.similarity)) text << error.similarity;
    text << '\n';
  }
  WriteFileAtomically(path, text.str());
}

std::vector<MotionErrors::Quarter> MotionErrors::Quarters() const {
  std::vector<Error> sorted;
  std::copy_if(errors_.begin(), errors_.end(), std::back_inserter(sorted),
               [](const Error& e) { return std::isfinite(e.similarity) && std::isfinite(e.image_l1); });
  if (sorted.size() < 4) return {};
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Error& a, const Error& b) { return a.similarity < b.similarity; });
  std::vector<Quarter> quarters(4);
  for (size_t q = 0; q < 4; ++q) {
    const size_t begin = q * sorted.size() / 4, end = (q + 1) * sorted.size() / 4;
    quarters[q].least_similarity = sorted[begin].similarity;
    quarters[q].frames = static_cast<int>(end - begin);
    for (size_t i = begin; i < end; ++i) quarters[q].image_l1 += sorted[i].image_l1 / static_cast<double>(end - begin);
  }
  return quarters;
}

nlohmann::ordered_json ToJson(const std::vector<MotionErrors::Quarter>& quarters) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const MotionErrors::Quarter& quarter : quarters) {
    json.push_back(
        {{"least_similarity", quarter.least_similarity}, {"image_l1", quarter.image_l1}, {"frames", quarter.frames}});
  }
  return json;
}

}  // namespace bodyloom
