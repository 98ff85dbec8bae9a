// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/geometry/motion_check.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

void CheckMotion(const Motion& motion, const char* caller) {
  BODYLOOM_CHECK(motion.poses.rows() > 0 && motion.poses.cols() % 3 == 0 && motion.poses.cols() > 0, caller, ": poses ",
                 motion.poses.rows(), "x", motion.poses.cols(), ", expected frames x 3 joints");
  BODYLOOM_CHECK(motion.trans.rows() == motion.poses.rows() &&
                     motion.timestamps.size() == static_cast<size_t>(motion.poses.rows()),
                 caller, ": ", motion.poses.rows(), " poses, ", motion.trans.rows(), " translations, ",
                 motion.timestamps.size(), " timestamps");
  BODYLOOM_CHECK(motion.poses.allFinite() && motion.trans.allFinite(), caller,
                 ": poses or translations are not finite");
}

}  // namespace bodyloom
