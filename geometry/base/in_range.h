// SPDX-License-Identifier: Apache-2.0
/// Ranges of options, for IsValid() of option structs.
#pragma once

#include <string>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

/// in_range("steps", steps, 1, 1e8): whether low ≤ value ≤ high. Otherwise, NaN included, `why` (which may be nullptr)
/// becomes "steps is 0, expected 1 to 1e+08".
class InRange {
 public:
  explicit InRange(std::string* why) : why_(why) {}
  bool operator()(const char* name, double value, double low, double high) const {
    if (value >= low && value <= high) return true;
    if (why_ != nullptr) *why_ = Concatenate(name, " is ", value, ", expected ", low, " to ", high);
    return false;
  }

 private:
  std::string* why_;
};

}  // namespace bodyloom
