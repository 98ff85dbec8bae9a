// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/descriptors/descriptor_options.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

bool DescriptorOptions::IsValid(std::string* why) const {
  if (!texels.IsValid(why) || !SurfaceMotion::IsValid(why)) return false;
  const auto no = [why](const std::string& text) {
    *why = text;
    return false;
  };
  if (past < 0 || past > 1000) return no(Concatenate("past is ", past, ", expected 0..1000"));
  if (past == 0 && !normals) return no("neither normals nor velocities requested");
  if (num_threads < 1 || num_threads > 1024)
    return no(Concatenate("num_threads is ", num_threads, ", expected 1..1024"));
  return true;
}

}  // namespace bodyloom
