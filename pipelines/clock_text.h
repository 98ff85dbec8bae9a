// SPDX-License-Identifier: Apache-2.0
/// Times as text for people.
#pragma once

#include <string>

namespace bodyloom {

/// "0:07", "12:34", "1:02:03"; rounded to seconds, 0 for negative ones.
std::string ClockText(double seconds);

}  // namespace bodyloom
